// The text of a Zemax tabular BSDF: keywords, lists of angles, and the values on their grid.
//
//   Source          Measured
//   Symmetry        PlaneSymmetrical | Asymmetrical | Asymmetrical4D
//   SpectralContent Monochrome | XYZ
//   ScatterType     BRDF
//   SampleRotation  count, and behind it so many angles in degrees; likewise AngleOfIncidence,
//   ScatterAzimuth, ScatterRadial
//
//   Monochrome      (XYZ: three such blocks, TristimulusX, TristimulusY, TristimulusZ)
//   DataBegin
//   TIS value       for each rotation and, within it, for each incidence; then a line for each
//   values ..       azimuth with a value for each radial angle
//   DataEnd
//
// `#` begins a comment. Source: Zemax, "Zemax Tabular BSDF data file format" (R. Rykowski).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::table {

struct ZemaxText {
  std::string name;  // of a comment "# Sample: NAME"; may be empty
  /// Only one side of the plane of incidence is listed, azimuths 0 to 180 deg: the other is alike.
  bool is_one_sided = false;
  std::vector<std::string> channels;
  /// In degrees, strictly ascending, none empty.
  std::vector<double> rotations, incidences, azimuths, radials;
  /// As written, finite, [channel][rotation][incidence][azimuth][radial] with the last one fastest.
  std::vector<std::vector<double>> values;

  std::size_t block_size() const { return azimuths.size() * radials.size(); }
  std::size_t block_count() const { return rotations.size() * incidences.size(); }
};

/// Parses the whole text. `path` is for messages. Throws FileError.
ZemaxText parse_zemax(std::string_view content, const std::string& path);

}  // namespace gonio::table
