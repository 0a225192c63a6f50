#include "table/formats/zemax_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "table/file_error.h"
#include "table/formats/number_text.h"

namespace gonio::table {

namespace {

/// Where the first word ends; npos if there is no other.
std::size_t end_of_first_word(std::string_view line) { return line.find_first_of(" \t\r"); }

}  // namespace

std::string first_word(std::string_view line) {
  std::string word(line.substr(0, end_of_first_word(line)));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

std::string_view behind_first_word(std::string_view line) {
  const std::size_t end = end_of_first_word(line);
  return end == std::string_view::npos ? std::string_view() : trimmed(line.substr(end));
}

bool is_keyword_line(std::string_view line) {
  if (std::isalpha(static_cast<unsigned char>(line.front())) == 0) return false;
  const std::string word = first_word(line);
  return word != "nan" && word != "inf";  // as some programs write numbers
}

bool take_number(std::string_view& text, double& value) {
  const char* at = text.data();
  const char* const end = at + text.size();
  if (read_number(at, end, value) != NumberText::number) return false;
  if (at != end && !is_blank(*at)) return false;
  text = trimmed({at, end});
  return true;
}

ZemaxLines::ZemaxLines(std::string_view text, const std::string& path)
    : reader_(text), path_(path) {
  pass();
}

void ZemaxLines::pass() {
  while (reader_.next(line_)) {
    if (line_.starts_with('#')) {
      note_sample_name();
    } else if (!line_.empty()) {
      return;
    }
  }
  line_ = {};
  at_end_ = true;
}

void ZemaxLines::note_sample_name() {
  const std::string_view comment = trimmed(line_.substr(1));
  if (comment.empty() || first_word(comment) != "sample:") return;
  sample_name_ = std::string(behind_first_word(comment));
}

void ZemaxLines::fail(const std::string& complaint) const {
  throw FileError(fmt::format("{}:{}: {}", path_, reader_.number(), complaint));
}

void ZemaxLines::fail_to_find(const std::string& expected, const std::string& advice) const {
  fail(fmt::format("found {}, expected {}: {}", at_end_ ? "the end of the file" : quoted(line_),
                   expected, advice));
}

void ZemaxLines::fail_for_number(std::string_view text, std::string_view where) const {
  const std::string_view word = text.substr(0, end_of_first_word(text));
  fail(fmt::format("{}: found {}, expected a finite number: correct it", where, quoted(word)));
}

}  // namespace gonio::table
