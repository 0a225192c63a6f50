#include "table/formats/foreign_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/number_text.h"
#include "table/formats/row_fields.h"
#include "table/formats/text_lines.h"
#include "table/formats/text_rows.h"
#include "table/input_file.h"

namespace gonio::table {

namespace {

/// As much of a file as its kind is judged by.
constexpr std::size_t sample_size = 4096;
/// Of a table whose columns nobody named: an angle and more may be missing.
constexpr std::size_t fewest_columns = 3;
constexpr std::size_t longest_header = 1000;

bool is_number(std::string_view field) {
  const char* at = field.data();
  double value = 0;
  return read_number(at, at + field.size(), value) == NumberText::number &&
         at == field.data() + field.size();
}

/// The separator that makes a row of numbers of the line: enough fields, and up to three numbers
/// among the first five, since a column of words or a hole may stand among them.
std::optional<Separator> separator_of_row(std::string_view line, std::size_t fewest) {
  for (const Separator separator : {Separator::comma, Separator::semicolon, Separator::blank}) {
    const std::vector<std::string_view> fields = split_fields(line, separator);
    if (fields.size() < fewest) continue;
    const auto end = fields.begin() + std::min<std::ptrdiff_t>(5, std::ssize(fields));
    const auto needed = static_cast<std::ptrdiff_t>(std::min<std::size_t>(fewest, 3));
    if (std::count_if(fields.begin(), end, is_number) >= needed) return separator;
  }
  return std::nullopt;
}

/// What stands in front of the first row of numbers, and that row.
struct Layout {
  Separator separator = Separator::comma;
  std::string_view header;  // the line that names the columns; empty if none does
  std::size_t header_line = 0;
  std::size_t first_row_line = 0;
  std::size_t field_count = 0;
  bool ends_empty = false;  // the last field may be a hole, or a separator too many
  std::string_view rows;    // the text from the first row on
};

bool is_comment(std::string_view line) {
  return line.empty() || line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// A comment line's text, where it may be the names of the columns: "# theta_i theta_o ..".
std::string_view without_comment_sign(std::string_view line) {
  return trimmed(line.substr(std::min(line.find_first_not_of("#%/"), line.size())));
}

std::optional<Layout> layout_of(std::string_view content, std::size_t fewest) {
  const std::string_view text = without_byte_order_mark(content);
  LineReader lines(text);
  Layout layout;
  const char* begin = text.data();
  for (std::string_view line; lines.number() < longest_header && lines.next(line);) {
    if (const auto separator = is_comment(line) ? std::nullopt : separator_of_row(line, fewest)) {
      layout.separator = *separator;
      layout.first_row_line = lines.number();
      const std::vector<std::string_view> fields = split_fields(line, *separator);
      layout.field_count = fields.size();
      layout.ends_empty = fields.back().empty();
      layout.rows = {begin, static_cast<std::size_t>(text.data() + text.size() - begin)};
      return layout;
    }
    if (!line.empty()) {
      layout.header = is_comment(line) ? without_comment_sign(line) : line;
      layout.header_line = lines.number();
    }
    begin = lines.rest().data();
  }
  return std::nullopt;
}

bool has_columns(const Layout& layout, std::size_t count) {
  return count == layout.field_count || (layout.ends_empty && count + 1 == layout.field_count);
}

bool has_decimal_commas(const Layout& layout) {
  LineReader lines(layout.rows);
  std::string_view line;
  return layout.separator != Separator::comma && lines.next(line) &&
         line.find(',') != std::string_view::npos;
}

/// The names of all columns, the unit that they state, and the constants of the user's list.
struct Names {
  std::vector<std::string> names;
  std::optional<AngleUnit> unit;
  std::vector<std::pair<std::string, double>> constants;
};

constexpr std::string_view ignored_name = "-";

bool is_angle(const std::string& name) {
  return std::find(angle_names.begin(), angle_names.end(), name) != angle_names.end();
}

void add_name(std::string_view written, const std::string& place, Names& names) {
  auto [plain, unit] = without_unit(written);
  const std::string canonical = canonical_column_name(plain);
  if (!is_angle(canonical)) {
    names.names.emplace_back(written);
    return;
  }
  if (unit && names.unit && *unit != *names.unit) {
    throw FileError(fmt::format(
        "{}: column {} has another unit of angles than the columns before it: expected one for "
        "all: convert the file",
        place, quoted(written)));
  }
  if (unit) names.unit = unit;
  names.names.push_back(canonical);
}

[[noreturn]] void refuse_constant(std::string_view written) {
  throw FileError(fmt::format(
      "--columns: found {}, expected ANGLE=NUMBER, an angle that no column holds, such as phi_i=0: "
      "correct it",
      quoted(written)));
}

/// "phi_i=0" as a constant; false if `written` is none.
bool add_constant(std::string_view written, Names& names) {
  const std::size_t equals = written.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string name = canonical_column_name(std::string(trimmed(written.substr(0, equals))));
  const std::string_view number = trimmed(written.substr(equals + 1));
  const char* at = number.data();
  double value = 0;
  if (!is_angle(name) || !is_number(number) ||
      read_number(at, at + number.size(), value) != NumberText::number) {
    refuse_constant(written);
  }
  names.constants.emplace_back(name, value);
  return true;
}

Names names_in_option(const std::string& columns) {
  Names names;
  for (const std::string_view written : split_fields(columns, Separator::comma)) {
    if (!add_constant(written, names)) add_name(written, "--columns", names);
  }
  return names;
}

Names names_in_header(const Layout& layout, const std::string& path) {
  Names names;
  const std::string place = fmt::format("{}:{}", path, layout.header_line);
  std::vector<std::string_view> fields = split_fields(layout.header, layout.separator);
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  for (std::string_view field : fields) {
    const bool is_quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
    add_name(is_quoted ? field.substr(1, field.size() - 2) : field, place, names);
  }
  return names;
}

[[noreturn]] void fail_without_columns(const Layout& layout, const std::string& path,
                                       std::string_view why) {
  throw FileError(fmt::format(
      "{}:{}: {}, so it is unknown what its {} columns hold: name them in order, such as "
      "--columns theta_i,phi_i,theta_o,phi_o,R,G,B (- passes one over, phi_i=0 stands for one that "
      "is not there)",
      path, layout.first_row_line, why, layout.field_count));
}

Names names_of(const Layout& layout, const std::string& path, const ReadOptions& options) {
  if (!options.columns.empty()) {
    Names names = names_in_option(options.columns);
    if (has_columns(layout, names.names.size())) return names;
    throw FileError(
        fmt::format("{}:{}: found {} columns, expected {} as --columns lists them: name all of "
                    "them in order, - for one to pass over",
                    path, layout.first_row_line, layout.field_count, names.names.size()));
  }
  if (layout.header.empty()) {
    fail_without_columns(layout, path, "no line names the columns");
  }
  Names names = names_in_header(layout, path);
  if (!has_columns(layout, names.names.size())) {
    fail_without_columns(
        layout, path, fmt::format("line {} has {} names", layout.header_line, names.names.size()));
  }
  const auto has = [&](const char* angle) {
    return std::find(names.names.begin(), names.names.end(), angle) != names.names.end();
  };
  for (const char* angle : angle_names) {
    if (has(angle)) continue;
    fail_without_columns(layout, path,
                         fmt::format("line {} names no column {}", layout.header_line, angle));
  }
  return names;
}

/// Arranges the columns that are not passed over, by their positions in the file.
Columns arranged(const Names& names, const std::string& place, ChannelNeed need) {
  std::vector<std::string> kept;
  std::vector<std::size_t> position;
  for (std::size_t i = 0; i < names.names.size(); ++i) {
    const bool is_kept =
        need == ChannelNeed::some ? names.names[i] != ignored_name : is_angle(names.names[i]);
    if (!is_kept) continue;
    kept.push_back(names.names[i]);
    position.push_back(i);
  }
  for (std::size_t c = 0; c < names.constants.size(); ++c) {
    kept.push_back(names.constants[c].first);
    position.push_back(names.names.size() + c);
  }
  Columns columns = arrange_columns(kept, place, need);
  const auto move = [&](std::size_t& column) { column = position[column]; };
  std::for_each(columns.angles.begin(), columns.angles.end(), move);
  std::for_each(columns.values.begin(), columns.values.end(), move);
  std::for_each(columns.sigmas.begin(), columns.sigmas.end(), move);
  if (columns.weight) move(*columns.weight);
  columns.names = names.names;
  for (const auto& [name, value] : names.constants) columns.constants.push_back(value);
  if (position.size() - names.constants.size() < names.names.size()) {
    columns.ignored.assign(names.names.size(), true);
    for (const std::size_t p : position) {
      if (p < names.names.size()) columns.ignored[p] = false;
    }
  }
  return columns;
}

void check_constants(const Names& names, AngleUnit unit) {
  const double quarter_turn = unit == AngleUnit::degrees ? 90 : std::numbers::pi / 2;
  for (const auto& [name, value] : names.constants) {
    if (name.starts_with("phi") || (value >= 0 && value < quarter_turn)) continue;
    throw FileError(
        fmt::format("--columns: found {}={}, expected an angle from 0 to below {:.8g}: "
                    "correct it",
                    name, value, quarter_turn));
  }
}

TextRows rows_of(const Layout& layout, const Names& names, const std::string& path,
                 ChannelNeed need) {
  return {.text = layout.rows,
          .first_line = layout.first_row_line,
          .path = path,
          .separator = layout.separator,
          .columns = arranged(names, fmt::format("{}:{}", path, layout.header_line), need)};
}

/// The columns that the user lists, without constants; else those that a table has at least.
std::size_t fewest_of(const ReadOptions& options) {
  if (options.columns.empty()) return fewest_columns;
  return std::max<std::size_t>(names_in_option(options.columns).names.size(), 1);
}

Layout require_layout(std::string_view content, const std::string& path,
                      const ReadOptions& options) {
  const std::size_t fewest = fewest_of(options);
  const auto layout = layout_of(content, fewest);
  if (!layout) {
    throw FileError(fmt::format(
        "{}: found no row of numbers with {} columns or more, expected {}: name a file "
        "that holds a table, or correct --columns",
        path, fewest, options.columns.empty() ? "a table" : "as many as --columns lists"));
  }
  if (has_decimal_commas(*layout)) {
    throw FileError(
        fmt::format("{}:{}: found commas within columns, expected numbers with a decimal point: "
                    "replace the decimal commas",
                    path, layout->first_row_line));
  }
  return *layout;
}

AngleUnit require_unit(const Names& names, const std::string& path, const ReadOptions& options) {
  if (options.angles && names.unit && *options.angles != *names.unit) {
    throw FileError(
        fmt::format("{}: the columns' names say that angles are in {}, --angles says "
                    "{}: leave it out or rename the columns",
                    path, name(*names.unit), name(*options.angles)));
  }
  const std::optional<AngleUnit> unit = options.angles ? options.angles : names.unit;
  if (unit) return *unit;
  throw FileError(
      fmt::format("{}: no line '# angles: deg' (or rad), so the unit of its angles is unknown: say "
                  "it with --angles deg or --angles rad",
                  path));
}

SampleTable read_rows_of(const TextRows& rows, Quantity quantity, AngleUnit unit,
                         const ReadOptions& options) {
  SampleTable table;
  table.provenance = {.path = rows.path,
                      .format = "CSV as the options say",
                      .sha256 = {},
                      .quantity = quantity,
                      .angles = unit};
  read_rows(rows, quantity, unit, options, table);
  return table;
}

}  // namespace

bool is_foreign_csv(std::string_view content) {
  return layout_of(content.substr(0, sample_size), fewest_columns).has_value();
}

SampleTable read_foreign_csv(std::string_view content, const std::string& path,
                             const ReadOptions& options) {
  const Layout layout = require_layout(content, path, options);
  const Names names = names_of(layout, path, options);
  const AngleUnit unit = require_unit(names, path, options);
  if (!options.quantity) {
    throw FileError(fmt::format(
        "{}: no line '# quantity: brdf' (or brdf_cos, reflectance_factor), so it is unknown what "
        "its numbers are: say it with --quantity brdf (f_r in 1/sr), brdf_cos (f_r cos(theta_i)) "
        "or reflectance_factor (pi f_r)",
        path));
  }
  check_constants(names, unit);
  return read_rows_of(rows_of(layout, names, path, ChannelNeed::some), *options.quantity, unit,
                      options);
}

SampleTable read_directions(const std::string& path, const ReadOptions& options) {
  const InputFile file(path);
  ReadOptions with_text = options;
  with_text.keep_angle_text = true;
  if (is_gonio_csv(file.bytes())) return read_gonio_directions(file.bytes(), path, with_text);
  const Layout layout = require_layout(file.bytes(), path, options);
  const Names names = names_of(layout, path, options);
  const AngleUnit unit = require_unit(names, path, options);
  check_constants(names, unit);
  return read_rows_of(rows_of(layout, names, path, ChannelNeed::none), Quantity::brdf, unit,
                      with_text);
}

}  // namespace gonio::table
