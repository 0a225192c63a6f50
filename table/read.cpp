#include "table/read.h"

#include <fmt/core.h>

#include <algorithm>

#include "table/file_error.h"
#include "table/formats/astm.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"
#include "table/input_file.h"

namespace gonio::table {

namespace {

constexpr std::string_view known_formats =
    "gonio-table CSV (first line '# gonio-table 1') and ASTM E1392 text (keyword lines up to VARS)";
/// As much of a file as its kind is judged by.
constexpr std::size_t sample_size = 4096;

bool is_binary(std::string_view content) {
  const std::string_view sample = content.substr(0, sample_size);
  return std::any_of(sample.begin(), sample.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

/// True if the line begins with four numbers, as a row of a table does.
bool is_row_of_numbers(std::string_view line) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int i = 0; i < 4; ++i) {
    at = skip_blanks(at, end);
    double value = 0;
    if (read_number(at, end, value) != NumberText::number) return false;
    at = skip_blanks(at, end);
    if (at != end && (*at == ',' || *at == ';')) ++at;
  }
  return true;
}

bool holds_rows_of_numbers(std::string_view content) {
  LineReader lines(content.substr(0, sample_size));
  for (std::string_view line; lines.next(line);) {
    if (is_row_of_numbers(line)) return true;
  }
  return false;
}

[[noreturn]] void fail_for_unknown(std::string_view content, const std::string& path) {
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF")) {
    throw FileError(fmt::format("{}: the text is UTF-16: save it as UTF-8", path));
  }
  if (is_binary(content)) {
    throw FileError(
        fmt::format("{}: binary data, which is no text table: name a file of a known format: {}",
                    path, known_formats));
  }
  if (holds_rows_of_numbers(content)) {
    throw FileError(fmt::format(
        "{}:1: numbers without the line '# gonio-table 1', so their quantity and angle unit are "
        "unknown: put the three lines '# gonio-table 1', '# quantity: brdf' (or brdf_cos, "
        "reflectance_factor) and '# angles: deg' (or rad) first, then the column names, such as "
        "theta_i,phi_i,theta_o,phi_o,R,G,B",
        path));
  }
  throw FileError(
      fmt::format("{}:1: no line '# gonio-table 1' and no table that is known: name a file of a "
                  "known format: {}",
                  path, known_formats));
}

}  // namespace

SampleTable read(const std::string& path, const ReadOptions& options) {
  const InputFile file(path);
  if (is_gonio_csv(file.bytes())) return read_gonio_csv(file.bytes(), path, options);
  if (is_astm(file.bytes())) return read_astm(file.bytes(), path, options);
  fail_for_unknown(file.bytes(), path);
}

}  // namespace gonio::table
