#include "table/formats/row_fields.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

bool at_line_end(const char* at, const char* end) { return at == end || *at == '\n'; }

/// Of a separator that is a character.
char separating_character(Separator separator) {
  return separator == Separator::semicolon ? ';' : ',';
}

/// Behind the field at `at`, whatever it holds.
const char* behind_field(const char* at, const char* end, Separator separator) {
  return std::find_if(at, end, [&](char c) {
    return c == '\n' ||
           (separator == Separator::blank ? is_blank(c) : c == separating_character(separator));
  });
}

/// Moves over the separator in front of the next field; false if there is none. `behind_blanks`
/// is the first character behind the last field that is no blank.
bool pass_separator(const char*& at, const char* behind_blanks, const char* end,
                    Separator separator) {
  if (separator == Separator::blank) {
    const bool separated = behind_blanks != at;
    at = behind_blanks;
    return separated;
  }
  if (*behind_blanks != separating_character(separator)) return false;
  at = skip_blanks(behind_blanks + 1, end);
  return true;
}

RowFault fault_of(NumberText number) {
  switch (number) {
    case NumberText::text:
      return RowFault::text;
    case NumberText::not_finite:
      return RowFault::not_finite;
    case NumberText::too_large:
      return RowFault::too_large;
    case NumberText::number:
    case NumberText::empty:
      break;
  }
  return RowFault::none;
}

/// What was found and expected and what to do, without the place.
std::string complaint(RowFault fault, const std::string& column, const std::string& found,
                      AngleUnit unit) {
  const auto field = [&](std::string_view expected, std::string_view advice) {
    return fmt::format("column {}: found {}, expected {}: {}", column, found, expected, advice);
  };
  switch (fault) {
    case RowFault::text:
      return field("a number", "correct it, or leave a channel's field empty if not measured");
    case RowFault::not_finite:
      return field("a finite number", "leave a channel's field empty if it was not measured");
    case RowFault::too_large:
      return field("a number whose f_r double precision can hold", "correct it");
    case RowFault::empty_angle:
      return fmt::format("column {}: empty, expected an angle: fill it in or remove the row",
                         column);
    case RowFault::theta_range:
      return field(unit == AngleUnit::degrees ? "0 to 90 deg" : "0 to pi/2 (1.5707963) rad",
                   "correct it, remove the row, or correct the declared angle unit");
    case RowFault::empty_sigma:
      return fmt::format(
          "column {}: empty beside a value, expected its standard deviation: fill "
          "it in, or leave the value empty too",
          column);
    case RowFault::sigma_not_positive:
      return field("a standard deviation above 0", "correct it");
    case RowFault::empty_weight:
      return fmt::format("column {}: empty, expected a weight of at least 0: fill it in", column);
    case RowFault::weight_negative:
      return field("a weight of at least 0", "correct it");
    case RowFault::none:
    case RowFault::too_few_fields:
    case RowFault::too_many_fields:
      break;
  }
  return {};
}

}  // namespace

RowProblem read_fields(const char*& at, const char* end, Separator separator,
                       std::span<double> fields, const std::vector<bool>& ignored) {
  at = skip_blanks(at, end);
  for (std::size_t column = 0; column < fields.size(); ++column) {
    const bool is_ignored = !ignored.empty() && ignored[column];
    if (is_ignored) at = behind_field(at, end, separator);
    const NumberText number = is_ignored ? NumberText::empty : read_number(at, end, fields[column]);
    if (number == NumberText::empty) {
      fields[column] = std::numeric_limits<double>::quiet_NaN();
    } else if (number != NumberText::number) {
      return {fault_of(number), column};
    }
    const char* next = skip_blanks(at, end);
    const bool is_last = column + 1 == fields.size();
    if (at_line_end(next, end)) {
      at = next;
      return {is_last ? RowFault::none : RowFault::too_few_fields, column};
    }
    if (!pass_separator(at, next, end, separator)) return {RowFault::text, column};
  }
  return {at_line_end(at, end) ? RowFault::none : RowFault::too_many_fields, fields.size() - 1};
}

std::vector<std::string_view> split_fields(std::string_view line, Separator separator) {
  std::vector<std::string_view> fields;
  line = trimmed(line);
  while (true) {
    const std::size_t end = separator == Separator::blank
                                ? line.find_first_of(" \t\r")
                                : line.find(separating_character(separator));
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
    if (separator == Separator::blank) line = trimmed(line);
  }
}

std::string explain(const RowProblem& problem, const TextRows& rows, AngleUnit unit,
                    std::size_t line_number, std::string_view line) {
  const std::string place = fmt::format("{}:{}", rows.path, line_number);
  const std::vector<std::string_view> fields = split_fields(line, rows.separator);
  const std::vector<std::string>& names = rows.columns.names;
  if (problem.fault == RowFault::too_few_fields || problem.fault == RowFault::too_many_fields) {
    const bool is_short = problem.fault == RowFault::too_few_fields;
    return fmt::format(
        "{}: found {} fields in {}, expected {}, from {} to {}: {}", place, fields.size(),
        quoted(trimmed(line)), names.size(), quoted(names.front()), quoted(names.back()),
        is_short ? "complete the row or remove it"
                 : "remove what is too much, and write numbers with a decimal point, not a comma");
  }
  const std::string_view found =
      problem.column < fields.size() ? fields[problem.column] : std::string_view();
  return fmt::format("{}: {}", place,
                     complaint(problem.fault, quoted(names[problem.column]), quoted(found), unit));
}

}  // namespace gonio::table
