#include "material/mtl_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <span>

#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"

namespace gonio::material {
namespace {

constexpr std::string_view blanks = " \t\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Splits at the first blank: the word before it, and what follows.
std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of(blanks), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

/// The number that the word is, or why it is none.
double number_of(std::string_view word, std::string_view keyword, int line) {
  const auto refuse = [&](std::string_view expected) -> MtlProblem {
    return {line,
            fmt::format("found {} after {}, expected {}", table::quoted(word), keyword, expected)};
  };
  if (word.find(',') != std::string_view::npos) {
    throw refuse("numbers with a decimal point, without commas, and blanks between them");
  }
  double value = 0;
  const char* at = word.data();
  const char* const end = at + word.size();
  switch (table::read_number(at, end, value)) {
    case table::NumberText::number:
      if (at == end) return value;
      throw refuse("a number");
    case table::NumberText::not_finite:
      throw refuse("a finite number");
    case table::NumberText::too_large:
      throw refuse("a number that double precision can hold");
    case table::NumberText::empty:
    case table::NumberText::text:
      break;
  }
  throw refuse("a number");
}

}  // namespace

std::string_view MtlStatementReader::next_line() {
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  if (!rest_.empty()) rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
  ++lines_;
  return trimmed(line);
}

bool MtlStatementReader::next(MtlStatement& statement) {
  while (!rest_.empty()) {
    std::string_view line = next_line();
    if (line.empty() || line.front() == '#') continue;
    statement.line = static_cast<int>(std::min<std::size_t>(lines_, INT_MAX));
    std::string joined;
    while (line.ends_with('\\') && !rest_.empty()) {
      joined.append(line.substr(0, line.size() - 1)).append(" ");
      line = next_line();
    }
    joined.append(line);
    std::string_view arguments = trimmed(joined);
    statement.keyword = mtl_lower(take_word(arguments));
    statement.arguments = arguments;
    if (!statement.keyword.empty()) return true;
  }
  return false;
}

std::vector<std::string_view> mtl_words(std::string_view arguments) {
  std::vector<std::string_view> words;
  arguments = trimmed(arguments.substr(0, arguments.find('#')));
  while (!arguments.empty()) words.push_back(take_word(arguments));
  return words;
}

std::string mtl_lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::array<double, 3> mtl_color(const MtlStatement& statement, std::string_view keyword) {
  const std::vector<std::string_view> words = mtl_words(statement.arguments);
  const std::string first = words.empty() ? "" : mtl_lower(words.front());
  if (first == "spectral") {
    throw MtlProblem(statement.line,
                     fmt::format("found a spectral curve ('{0} spectral FILE'), which is not "
                                 "read; write '{0} RED GREEN BLUE'",
                                 keyword));
  }
  if (first == "xyz") {
    throw MtlProblem(
        statement.line,
        fmt::format("found CIE XYZ ('{0} xyz X Y Z'), for which the format states no white point, "
                    "so that its red, green and blue would be a guess; write '{0} RED GREEN BLUE'",
                    keyword));
  }
  if (words.size() != 1 && words.size() != 3) {
    for (const std::string_view word :
         std::span(words).first(std::min<std::size_t>(words.size(), 4))) {
      number_of(word, keyword, statement.line);
    }
    throw MtlProblem(statement.line, fmt::format("found {} numbers after {}, expected 3, or 1 "
                                                 "for a grey",
                                                 words.size(), keyword));
  }
  std::array<double, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = number_of(words[words.size() == 3 ? c : 0], keyword, statement.line);
    if (color[c] < 0) {
      throw MtlProblem(statement.line,
                       fmt::format("found {} after {}, expected a reflectance, 0 to 1",
                                   table::quoted(words[words.size() == 3 ? c : 0]), keyword));
    }
  }
  return color;
}

double mtl_number(const MtlStatement& statement, std::string_view keyword) {
  const std::vector<std::string_view> words = mtl_words(statement.arguments);
  if (words.empty()) {
    throw MtlProblem(statement.line,
                     fmt::format("found nothing after {}, expected one number", keyword));
  }
  const double value = number_of(words.front(), keyword, statement.line);
  if (words.size() > 1) {
    throw MtlProblem(statement.line, fmt::format("found {} values after {}, expected one "
                                                 "number",
                                                 words.size(), keyword));
  }
  return value;
}

}  // namespace gonio::material
