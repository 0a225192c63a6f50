// What the columns of a text table hold, told by their names.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gonio::table {

/// The positions of the angle columns in Columns::angles.
enum Angle : std::size_t { theta_i, phi_i, theta_o, phi_o };
inline constexpr std::array<const char*, 4> angle_names{"theta_i", "phi_i", "theta_o", "phi_o"};

/// Which field of a row holds what; all positions count from 0.
struct Columns {
  /// Of every column, in the order of the file, as messages shall name them.
  std::vector<std::string> names;
  std::array<std::size_t, 4> angles{};
  /// Per channel, in the order of the file.
  std::vector<std::string> channels;
  std::vector<std::size_t> values;
  /// Per channel; empty if the table carries no sigma.
  std::vector<std::size_t> sigmas;
  std::optional<std::size_t> weight;
};

/// Sorts columns by the names theta_i, phi_i, theta_o, phi_o, sigma_<channel> and weight; any
/// other name is a channel. Throws FileError, which begins with `place` ("table.csv:5"), for a
/// missing angle, a duplicate or empty name, no channel, or sigma of some channels only.
Columns arrange_columns(const std::vector<std::string>& names, const std::string& place);

}  // namespace gonio::table
