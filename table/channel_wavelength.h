// The wavelength that a channel's name stands for.
//
// Source: the dominant wavelengths of the primaries of sRGB (IEC 61966-2-1), where the line from
// the white point D65 through the primary meets the spectral locus of the CIE 1931 observer.
#pragma once

#include <optional>
#include <string_view>

namespace gonio::table {

/// True of R, G and B in either case.
bool is_rgb_channel(std::string_view channel);

/// In metres: of "465nm" or "465 nm" that; of R, G and B 611.4, 549.1 and 464.3 nm. Nothing for
/// other names.
std::optional<double> wavelength_of_channel(std::string_view channel);

}  // namespace gonio::table
