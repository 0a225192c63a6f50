// What the columns of a text table hold, told by their names.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

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
  /// Per column of the file, whether it is passed over, whatever it holds; empty if none is.
  std::vector<bool> ignored;
  /// The values of columns that the file has not; they count from names.size().
  std::vector<double> constants;
};

/// A column's name without a unit behind it, "theta_i (deg)" or "theta_i_rad", and that unit.
struct NameAndUnit {
  std::string name;
  std::optional<AngleUnit> unit;
};
NameAndUnit without_unit(std::string_view name);

/// The unit that begins a text such as "degrees" or "rad"; nothing if none does.
std::optional<AngleUnit> angle_unit_named(std::string_view text);

/// theta_i, phi_i, theta_o or phi_o for what instruments call them (theta_s, phi_r, thetai ..),
/// in letters of either case; any other name as it is.
std::string canonical_column_name(const std::string& written);

/// Sorts columns by the names theta_i, phi_i, theta_o, phi_o, sigma_<channel> and weight; any
/// other name is a channel. Throws FileError, which begins with `place` ("table.csv:5"), for a
/// missing angle, a duplicate or empty name, no channel (unless none is needed), or sigma of some
/// channels only.
enum class ChannelNeed { some, none };
Columns arrange_columns(const std::vector<std::string>& names, const std::string& place,
                        ChannelNeed need = ChannelNeed::some);

}  // namespace gonio::table
