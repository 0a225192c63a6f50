#include "table/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "table/file_error.h"
#include "table/formats/astm.h"
#include "table/formats/curet.h"
#include "table/formats/exr_table.h"
#include "table/formats/foreign_csv.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/klems.h"
#include "table/formats/merl.h"
#include "table/formats/openmaterial.h"
#include "table/formats/rgl.h"
#include "table/formats/zemax.h"
#include "table/input_file.h"

namespace gonio::table {

namespace {

/// A format that files are in, told by their content.
struct Format {
  std::string_view name;
  bool (*is)(std::string_view content);
  SampleTable (*read)(std::string_view content, const std::string& path,
                      const ReadOptions& options);
  /// For one whose samples stand on a grid; else null.
  GriddedTable (*read_grid)(std::string_view content, const std::string& path) = nullptr;
  bool holds_materials = false;
};

/// In the order in which they are tried: those with a signature first.
constexpr std::array formats{
    Format{"gonio-table CSV (first line '# gonio-table 1')", is_gonio_csv, read_gonio_csv},
    Format{"gonio-table EXR", is_exr_table, read_exr_table},
    Format{"RGL tensor file", is_rgl, read_rgl, read_rgl_grid},
    Format{"OpenMATERIAL 3D", is_openmaterial, read_openmaterial, read_openmaterial_grid},
    Format{"Klems BSDF XML", is_klems, read_klems, read_klems_grid},
    Format{"Zemax tabular BSDF", is_zemax, read_zemax, read_zemax_grid},
    Format{"ASTM E1392 text (keyword lines up to VARS)", is_astm, read_astm},
    Format{"MERL", is_merl, read_merl, read_merl_grid},
    Format{"CUReT", is_curet, read_curet_file, nullptr, true},
};

/// As much of a file as its kind is judged by.
constexpr std::size_t sample_size = 4096;

std::string known_formats() {
  std::string names;
  for (const Format& format : formats) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
  }
  return names;
}

bool is_binary(std::string_view content) {
  const std::string_view sample = content.substr(0, sample_size);
  return std::any_of(sample.begin(), sample.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

[[noreturn]] void fail_for_unknown(std::string_view content, const std::string& path) {
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF")) {
    throw FileError(fmt::format("{}: the text is UTF-16: save it as UTF-8", path));
  }
  if (is_binary(content)) {
    throw FileError(
        fmt::format("{}: binary data, which is no known table: name a file of a known format: {}",
                    path, known_formats()));
  }
  if (is_foreign_csv(content)) {
    throw FileError(fmt::format(
        "{}:1: numbers without the line '# gonio-table 1', so their quantity and angle unit are "
        "unknown: say them with --quantity brdf (or brdf_cos, reflectance_factor) and --angles deg "
        "(or rad), and the columns, unless a line names them, with --columns "
        "theta_i,phi_i,theta_o,phi_o,R,G,B; or put the lines '# gonio-table 1', '# quantity: brdf' "
        "and '# angles: deg' first",
        path));
  }
  throw FileError(
      fmt::format("{}:1: no line '# gonio-table 1' and no table that is known: name a file of a "
                  "known format: {}",
                  path, known_formats()));
}

bool describes_columns(const ReadOptions& options) {
  return !options.columns.empty() || options.quantity || options.angles;
}

const Format* format_of(std::string_view content) {
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const Format& format) { return format.is(content); });
  return found == formats.end() ? nullptr : &*found;
}

/// Throws for options that the format has no use for: what the user believes of the file is wrong.
void check_options(const Format& format, const std::string& path, const ReadOptions& options) {
  if (describes_columns(options)) {
    throw FileError(
        fmt::format("{}: the format is {}, which says itself what it holds: leave out --columns, "
                    "--quantity and --angles",
                    path, format.name));
  }
  if (options.material && !format.holds_materials) {
    throw FileError(fmt::format(
        "{}: the format is {}, which holds one material: leave out --material", path, format.name));
  }
}

/// CUReT's rows are numbers without a name, too: options that describe columns say otherwise.
bool is_for_foreign_csv(const Format* format, std::string_view content,
                        const ReadOptions& options) {
  const bool has_no_signature = format == nullptr || format->holds_materials;
  return has_no_signature && describes_columns(options) && !is_binary(content);
}

}  // namespace

SampleTable read(const std::string& path, const ReadOptions& options) {
  const InputFile file(path);
  const std::string_view content = file.bytes();
  const Format* format = format_of(content);
  if (is_for_foreign_csv(format, content, options)) {
    return read_foreign_csv(content, path, options);
  }
  if (format == nullptr) fail_for_unknown(content, path);
  check_options(*format, path, options);
  return format->read(content, path, options);
}

GriddedTable read_gridded(const std::string& path, const ReadOptions& options) {
  const InputFile file(path);
  const Format* format = format_of(file.bytes());
  if (format == nullptr) fail_for_unknown(file.bytes(), path);
  check_options(*format, path, options);
  if (format->read_grid == nullptr) {
    throw FileError(fmt::format(
        "{}: the format is {}, whose samples stand on no grid, so that nothing is defined "
        "between them: fit a model (gonio fit) and evaluate that (gonio eval)",
        path, format->name));
  }
  return format->read_grid(file.bytes(), path);
}

}  // namespace gonio::table
