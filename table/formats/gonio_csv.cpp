#include "table/formats/gonio_csv.h"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/row_fields.h"
#include "table/formats/text_lines.h"
#include "table/formats/text_rows.h"

namespace gonio::table {

namespace {

constexpr std::string_view signature = "gonio-table";
constexpr int newest_version = 1;

/// What stands behind the '#' of a comment line, trimmed; nothing if `line` is none.
std::optional<std::string_view> comment(std::string_view line) {
  if (!line.starts_with('#')) return std::nullopt;
  return trimmed(line.substr(1));
}

/// What stands behind `gonio-table` if `line` is a signature line.
std::optional<std::string_view> version_text(std::string_view line) {
  const auto text = comment(line);
  if (!text || !text->starts_with(signature)) return std::nullopt;
  const std::string_view behind = text->substr(signature.size());
  if (!behind.empty() && !is_blank(behind.front())) return std::nullopt;
  return trimmed(behind);
}

/// The first line that is not blank.
std::string_view first_line(LineReader& lines) {
  std::string_view line;
  while (lines.next(line) && line.empty()) {
  }
  return line;
}

void check_version(std::string_view text, const std::string& place) {
  int version = 0;
  const auto [behind, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  if (error != std::errc() || behind != text.data() + text.size() || version < 1) {
    throw FileError(
        fmt::format("{}: the version of the gonio-table is {}, expected 1: begin the "
                    "file with '# gonio-table 1'",
                    place, quoted(text)));
  }
  if (version > newest_version) {
    throw FileError(
        fmt::format("{}: gonio-table {} is newer than this program, which reads up to "
                    "{}: use a newer gonio",
                    place, version, newest_version));
  }
}

/// What the comment lines in front of the column names declare.
struct Declaration {
  std::optional<Quantity> quantity;
  std::optional<AngleUnit> angles;
  std::string name;
};

/// Sets `target` to the value named by the first word of `text`; a remark in parentheses may
/// follow.
template <class Value, std::size_t N>
void declare(std::string_view key, std::string_view text,
             const std::array<std::pair<std::string_view, Value>, N>& choices,
             const std::string& place, std::optional<Value>& target) {
  const std::string_view word = trimmed(text.substr(0, text.find('(')));
  for (const auto& [written, value] : choices) {
    if (word != written) continue;
    if (target && *target != value) {
      throw FileError(
          fmt::format("{}: a second '# {}:' line says {} where the first says {}: "
                      "remove the wrong one",
                      place, key, quoted(word), quoted(name(*target))));
    }
    target = value;
    return;
  }
  std::string known;
  for (const auto& choice : choices) {
    known += (known.empty() ? "" : ", ") + std::string(choice.first);
  }
  throw FileError(fmt::format("{}: unknown {} {}: expected one of {}: correct the line", place, key,
                              quoted(word), known));
}

void read_declaration(std::string_view text, const std::string& place, Declaration& declaration) {
  using namespace std::string_view_literals;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view key = trimmed(text.substr(0, colon));
  const std::string_view value = trimmed(text.substr(colon + 1));
  if (key == "quantity") {
    constexpr std::array choices{std::pair{"brdf"sv, Quantity::brdf},
                                 std::pair{"brdf_cos"sv, Quantity::brdf_cos},
                                 std::pair{"reflectance_factor"sv, Quantity::reflectance_factor}};
    declare(key, value, choices, place, declaration.quantity);
  } else if (key == "angles") {
    constexpr std::array choices{std::pair{"deg"sv, AngleUnit::degrees},
                                 std::pair{"rad"sv, AngleUnit::radians}};
    declare(key, value, choices, place, declaration.angles);
  } else if (key == "name") {
    declaration.name = value;
  }
}

[[noreturn]] void fail_without_quantity(const std::string& path) {
  throw FileError(fmt::format(
      "{}: no '# quantity:' line in front of the column names, so it is unknown what the numbers "
      "are: add '# quantity: brdf' (f_r in 1/sr), '# quantity: brdf_cos' (f_r cos(theta_i)) or "
      "'# quantity: reflectance_factor' (pi f_r)",
      path));
}

[[noreturn]] void fail_without_angles(const std::string& path) {
  throw FileError(
      fmt::format("{}: no '# angles:' line in front of the column names, so their unit is "
                  "unknown: add '# angles: deg' or '# angles: rad'",
                  path));
}

std::vector<std::string> column_names(std::string_view line) {
  std::vector<std::string_view> fields = split_fields(line, Separator::comma);
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return {fields.begin(), fields.end()};
}

/// What stands in front of the rows.
struct Header {
  Declaration declaration;
  std::vector<std::string> columns;
  std::string place;  // of the column names
  std::size_t first_row_line = 0;
  std::string_view rows;
};

Header read_header(std::string_view content, const std::string& path) {
  LineReader lines(without_byte_order_mark(content));
  const auto place = [&] { return fmt::format("{}:{}", path, lines.number()); };
  const std::string_view signature_line = first_line(lines);
  check_version(version_text(signature_line).value_or(""), place());

  Header header;
  std::string_view line;
  bool has_columns = false;
  while (!has_columns && lines.next(line)) {
    if (const auto text = comment(line)) {
      read_declaration(*text, place(), header.declaration);
    } else {
      has_columns = !line.empty();
    }
  }
  if (!has_columns) {
    if (!header.declaration.quantity) fail_without_quantity(path);
    if (!header.declaration.angles) fail_without_angles(path);
    throw FileError(
        fmt::format("{}: no line of column names behind the header: add one such as "
                    "theta_i,phi_i,theta_o,phi_o,R,G,B, and rows",
                    path));
  }
  header.columns = column_names(line);
  header.place = place();
  header.first_row_line = lines.number() + 1;
  header.rows = lines.rest();
  return header;
}

TextRows rows_of(const Header& header, const std::string& path, Columns columns) {
  return {.text = header.rows,
          .first_line = header.first_row_line,
          .path = path,
          .separator = Separator::comma,
          .columns = std::move(columns)};
}

/// The table without samples.
SampleTable table_of(const Header& header, const std::string& path, Quantity quantity) {
  if (!header.declaration.angles) fail_without_angles(path);
  SampleTable table;
  table.name = header.declaration.name;
  table.provenance = {.path = path,
                      .format = "gonio-table 1",
                      .sha256 = {},
                      .quantity = quantity,
                      .angles = *header.declaration.angles};
  return table;
}

}  // namespace

bool is_gonio_csv(std::string_view content) {
  LineReader lines(without_byte_order_mark(content));
  return version_text(first_line(lines)).has_value();
}

SampleTable read_gonio_csv(std::string_view content, const std::string& path,
                           const ReadOptions& options) {
  const Header header = read_header(content, path);
  if (!header.declaration.quantity) fail_without_quantity(path);
  const Quantity quantity = *header.declaration.quantity;
  SampleTable table = table_of(header, path, quantity);
  const TextRows rows = rows_of(header, path, arrange_columns(header.columns, header.place));
  read_rows(rows, quantity, table.provenance.angles, options, table);
  return table;
}

SampleTable read_gonio_directions(std::string_view content, const std::string& path,
                                  const ReadOptions& options) {
  const Header header = read_header(content, path);
  Columns columns = arrange_columns(header.columns, header.place, ChannelNeed::none);
  columns.ignored.assign(columns.names.size(), true);
  for (const std::size_t angle : columns.angles) columns.ignored[angle] = false;
  columns.channels.clear();
  columns.values.clear();
  columns.sigmas.clear();
  columns.weight.reset();
  SampleTable table = table_of(header, path, Quantity::brdf);
  read_rows(rows_of(header, path, std::move(columns)), Quantity::brdf, table.provenance.angles,
            options, table);
  return table;
}

}  // namespace gonio::table
