// What gonio fit says on stderr while it works: a progress line and notes, which take turns.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/gonio/progress.h"

namespace gonio::app {

class FitMessages {
 public:
  /// What follows is about `table`, the `number`-th of `count`. Among several, every message
  /// names it.
  void begin_table(const std::string& table, std::size_t number, std::size_t count);

  /// What is done now, and the share of it that is done (0..1; negative: unknown). From any
  /// thread, but not while a note is printed.
  void progress(const std::string& what, double share = -1);
  /// Prints a line about the contents of the table, which names it always.
  void note_on_table(const std::string& text);
  /// Prints a line.
  void note(const std::string& text);
  /// Prints the line of a failure, which `problem` says in full.
  void error(const std::string& problem);
  /// Clears the progress line, before something is printed on stdout.
  void clear() { line_.reset(); }

 private:
  void print_line(const std::string& text);

  std::string table_;
  std::string note_place_;      // in front of a note: "paints/red.astm: ", or nothing
  std::string progress_place_;  // "3 of 22, red: ", or nothing
  std::optional<ProgressLine> line_;
};

}  // namespace gonio::app
