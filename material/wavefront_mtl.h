// Wavefront material libraries (.mtl), as they are found: the largest stock of Phong materials.
//
// Source: Alias|Wavefront, Advanced Visualizer 4.2, File Formats, section 5 (1995). Its lighting
// formula is classic: I = Kd (n.l) + Ks (n.h)^Ns for light of unit irradiance, Blinn's highlight
// about the half vector h, without a cosine on it.
//
// What the format leaves open is decided here: a material without Kd has a black diffuse part, one
// without Ks has no highlight, one with neither is unusable. Of a repeated statement the last
// counts. Keywords may be in any case; names reach to the end of the line, blanks and `#` in them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace gonio::material {

/// One material of a library. Of one with a problem only `name` and `line` mean something.
struct MtlMaterial {
  std::string name;
  int line = 0;  // of its newmtl, from 1
  /// Kd and Ks for red, green, blue: finite and at least 0, mostly up to 1. Ks is 0 under the
  /// illumination models 0 and 1, which have no highlight.
  std::array<double, 3> diffuse{};
  std::array<double, 3> specular{};
  /// Ns, above 0 and up to 1e6; 0 where `specular` is 0.
  double exponent = 0;
  /// What was decided or passed over (maps, transparency, ..), a sentence each.
  std::vector<std::string> notes;
  /// Empty if the material is usable; else one line: the file, the line, what is wrong, what to do.
  std::string problem;
};

/// Reads every material of the library `path`, in its order. `default_exponent` (above 0, up to
/// 1e6) stands in for a missing Ns. Throws table::FileError for a file that cannot be read or
/// defines no material, std::invalid_argument for an unsuitable `default_exponent`.
std::vector<MtlMaterial> read_wavefront_mtl(const std::string& path,
                                            std::optional<double> default_exponent = std::nullopt);

}  // namespace gonio::material
