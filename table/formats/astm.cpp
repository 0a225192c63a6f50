#include "table/formats/astm.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/astm_ramp.h"
#include "table/formats/row_fields.h"
#include "table/formats/text_lines.h"
#include "table/formats/text_rows.h"

namespace gonio::table {

namespace {

/// Print-outs round pi/2 and 2 pi up; degrees pass them by far.
constexpr double radian_slack = 1e-6;

/// A keyword line: the word that it begins with, and what stands behind it.
struct KeywordLine {
  std::string_view keyword;
  std::string_view value;
};

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

bool is_word(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; }

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::optional<KeywordLine> keyword_line(std::string_view line) {
  if (line.empty() || !is_letter(line.front())) return std::nullopt;
  const auto end = std::find_if_not(line.begin(), line.end(), is_word);
  const auto length = static_cast<std::size_t>(end - line.begin());
  std::string_view value = line.substr(length);
  if (!value.empty() && !is_blank(value.front()) && value.front() != '=' && value.front() != ':') {
    return std::nullopt;
  }
  value = trimmed(value);
  if (value.starts_with('=') || value.starts_with(':')) value = trimmed(value.substr(1));
  return KeywordLine{line.substr(0, length), value};
}

/// What the keyword lines say.
struct Header {
  std::string sample_name;
  std::optional<std::size_t> point_count;
  std::optional<std::string> measurement;
  std::optional<AngleUnit> unit;
  std::vector<std::string> names;  // of VARS, as written, without a unit
  std::size_t vars_line = 0;
};

void read_vars(std::string_view value, Header& header) {
  const bool has_commas = value.find(',') != std::string_view::npos;
  std::vector<std::string_view> names =
      split_fields(value, has_commas ? Separator::comma : Separator::blank);
  if (names.size() > 1 && names.back().empty()) names.pop_back();
  for (const std::string_view written : names) {
    auto [name, unit] = without_unit(written);
    header.names.push_back(std::move(name));
    if (unit) header.unit = unit;
  }
}

void read_keyword(const KeywordLine& line, const std::string& place, Header& header) {
  const std::string keyword = lower(line.keyword);
  if (keyword == "sample_name") {
    header.sample_name = line.value;
  } else if (keyword == "meas_name") {
    header.measurement = line.value;
    if (lower(line.value) != "brdf") {
      throw FileError(
          fmt::format("{}: MEAS_NAME is {}, expected BRDF, the only quantity read from ASTM text: "
                      "convert the values to a BRDF in 1/sr",
                      place, quoted(line.value)));
    }
  } else if (keyword == "num_points") {
    std::size_t count = 0;
    const char* const end = line.value.data() + line.value.size();
    if (std::from_chars(line.value.data(), end, count).ec == std::errc()) {
      header.point_count = count;
    }
  } else if (keyword.find("unit") != std::string::npos && angle_unit_named(line.value)) {
    header.unit = angle_unit_named(line.value);
  }
}

/// Reads the keyword lines up to VARS, behind which `lines` is left.
Header read_header(LineReader& lines, const std::string& path) {
  Header header;
  std::string_view line;
  while (lines.next(line)) {
    const auto keyword = keyword_line(line);
    if (!keyword) continue;
    const std::string place = fmt::format("{}:{}", path, lines.number());
    if (lower(keyword->keyword) != "vars") {
      read_keyword(*keyword, place, header);
      continue;
    }
    read_vars(keyword->value, header);
    header.vars_line = lines.number();
    break;
  }
  return header;
}

/// The first row behind the header; empty if there is none.
std::string_view first_row(LineReader lines) {
  std::string_view line;
  while (lines.next(line)) {
    if (!line.empty() && !line.starts_with('#')) return line;
  }
  return {};
}

/// Inserts phi_s into names that omit it where the rows have one number more and the other angles
/// stand first, as goniometers of the Mini-Diff series write it. Returns the note for the user.
std::optional<std::string> restore_omitted_azimuth(std::vector<std::string>& names,
                                                   std::size_t field_count) {
  const std::array<std::string_view, 3> leading{"theta_i", "phi_i", "theta_o"};
  if (field_count != names.size() + 1 || names.size() < leading.size()) return std::nullopt;
  for (std::size_t i = 0; i < leading.size(); ++i) {
    if (canonical_column_name(names[i]) != leading[i]) return std::nullopt;
  }
  const auto is_azimuth = [](const std::string& n) { return canonical_column_name(n) == "phi_o"; };
  if (std::any_of(names.begin(), names.end(), is_azimuth)) return std::nullopt;
  names.insert(names.begin() + 3, "phi_s");
  return fmt::format(
      "the VARS line names {} columns but the rows have {}: the fourth, unnamed one was taken as "
      "phi_s",
      names.size() - 1, field_count);
}

Columns arrange(const std::vector<std::string>& names, const std::string& place) {
  std::vector<std::string> canonical(names.size());
  std::transform(names.begin(), names.end(), canonical.begin(), canonical_column_name);
  Columns columns = arrange_columns(canonical, place);
  columns.names = names;
  return columns;
}

/// Sets `unit`, from the header or from the range of the angles; returns the note for the user.
std::string find_unit(const Header& header, const TextRows& rows, AngleUnit& unit) {
  if (header.unit) {
    unit = *header.unit;
    return fmt::format("angles are in {}, as the header says",
                       unit == AngleUnit::degrees ? "degrees" : "radians");
  }
  const AngleExtent extent = angle_extent(rows);
  const bool fits_radians = extent.theta <= std::numbers::pi / 2 + radian_slack &&
                            extent.phi <= 2 * std::numbers::pi + radian_slack;
  unit = fits_radians ? AngleUnit::radians : AngleUnit::degrees;
  return fmt::format(
      "angles were taken as {}: no header line says, the largest theta is {:.6g}, the largest phi "
      "{:.6g}",
      fits_radians ? "radians" : "degrees", extent.theta, extent.phi);
}

}  // namespace

bool is_astm(std::string_view content) {
  constexpr int longest_header = 1000;
  LineReader lines(without_byte_order_mark(content));
  std::string_view line;
  for (int i = 0; i < longest_header && lines.next(line); ++i) {
    if (line.empty() || line.starts_with('#')) continue;
    const auto keyword = keyword_line(line);
    if (!keyword) return false;
    if (lower(keyword->keyword) == "vars") return true;
  }
  return false;
}

SampleTable read_astm(std::string_view content, const std::string& path,
                      const ReadOptions& options) {
  LineReader lines(without_byte_order_mark(content));
  Header header = read_header(lines, path);
  SampleTable table;
  table.name = header.sample_name;
  if (!header.measurement) {
    table.notes.emplace_back("no MEAS_NAME line: the values were taken as BRDF in 1/sr");
  }
  const std::string_view row = first_row(lines);
  const bool has_commas = row.find(',') != std::string_view::npos;
  const Separator separator = has_commas ? Separator::comma : Separator::blank;
  std::vector<std::string_view> fields = split_fields(row, separator);
  if (has_commas && fields.back().empty()) fields.pop_back();
  if (auto note = restore_omitted_azimuth(header.names, fields.size())) {
    table.notes.push_back(*std::move(note));
  }
  const TextRows rows{
      .text = lines.rest(),
      .first_line = header.vars_line + 1,
      .path = path,
      .separator = separator,
      .columns = arrange(header.names, fmt::format("{}:{}: VARS", path, header.vars_line))};
  AngleUnit unit{};
  table.notes.push_back(find_unit(header, rows, unit));
  table.provenance = {.path = path,
                      .format = "ASTM text",
                      .sha256 = {},
                      .quantity = Quantity::brdf,
                      .angles = unit};
  read_rows(rows, Quantity::brdf, unit, options, table);
  if (header.point_count && *header.point_count != table.size()) {
    table.notes.push_back(fmt::format("NUM_POINTS says {} but the file has {} rows: all were read",
                                      *header.point_count, table.size()));
  }
  if (const auto ramp = mask_ramp(table)) {
    table.notes.push_back(fmt::format(
        "nothing beyond theta_o = {:.6g} deg was measured: the instrument's software wrote a ramp "
        "to zero there; its {} samples are masked as extrapolated",
        ramp->last_measured_deg, ramp->samples));
  }
  return table;
}

}  // namespace gonio::table
