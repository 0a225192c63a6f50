// The lines of a Zemax tabular BSDF and the words and numbers in them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "table/formats/text_lines.h"

namespace gonio::table {

/// The text up to the first blank, in lower case.
std::string first_word(std::string_view line);
std::string_view behind_first_word(std::string_view line);

/// True if the line, which is not empty, begins with a word and not with a number.
bool is_keyword_line(std::string_view line);

/// Takes the number that `text` begins with and the blanks behind it; false if it is none.
bool take_number(std::string_view& text, double& value);

/// The lines that are neither blank nor comments; one is in view until the next is passed to.
class ZemaxLines {
 public:
  /// Both have to outlive the object.
  ZemaxLines(std::string_view text, const std::string& path);

  bool at_end() const { return at_end_; }
  /// The line in view, trimmed; empty at the end.
  std::string_view line() const { return line_; }
  /// Passes to the next line.
  void pass();
  /// NAME of a comment "# Sample: NAME" among the lines so far.
  const std::string& sample_name() const { return sample_name_; }
  /// As much text as is left, the line in view included.
  std::size_t bytes_left() const { return line_.size() + reader_.rest().size(); }

  /// Throws FileError: what is wrong with the line in view, or with the end of the text.
  [[noreturn]] void fail(const std::string& complaint) const;
  [[noreturn]] void fail_to_find(const std::string& expected, const std::string& advice) const;
  /// `text` does not begin with a number.
  [[noreturn]] void fail_for_number(std::string_view text, std::string_view where) const;

 private:
  void note_sample_name();

  LineReader reader_;
  const std::string& path_;
  std::string_view line_;
  std::string sample_name_;
  bool at_end_ = false;
};

}  // namespace gonio::table
