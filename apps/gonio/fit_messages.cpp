#include "apps/gonio/fit_messages.h"

#include <fmt/format.h>

#include <filesystem>

#include "apps/gonio/command.h"

namespace gonio::app {

void FitMessages::begin_table(const std::string& table, std::size_t number, std::size_t count) {
  table_ = table;
  if (count == 1) return;
  note_place_ = table + ": ";
  progress_place_ =
      fmt::format("{} of {}, {}: ", number, count, std::filesystem::path(table).stem().string());
}

void FitMessages::progress(const std::string& what, double share) {
  if (!line_) line_.emplace(progress_place_ + what);
  line_->set(progress_place_ + what, share);
}

void FitMessages::note_on_table(const std::string& text) { print_line(table_ + ": " + text); }

void FitMessages::note(const std::string& text) { print_line(note_place_ + text); }

void FitMessages::error(const std::string& problem) { print_line("gonio: " + problem); }

void FitMessages::print_line(const std::string& text) {
  clear();
  print_note(text);
}

}  // namespace gonio::app
