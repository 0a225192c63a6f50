// The account that an exported file gives of itself: what it was made from, what stands for what,
// and what was lost.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "export/exported.h"
#include "export/rgb.h"
#include "material/material.h"

namespace gonio::exports {

/// A number to 12 digits, as it stands in exported files; 0 for less than 1e-12.
std::string number_text(double value);

/// The number that number_text() reads as.
double as_written(double value);

/// "peak 1.2 % at incidence 45 deg, viewer 60 deg, channel R; rms 0.8 %; albedo +0.0031".
std::string loss_text(const material::Difference& loss);

/// Where the file comes from, one line each: the program, the material, its model and parameters at
/// full precision. No line holds a control character.
std::vector<std::string> origin_lines(const material::Material& material);

/// origin_lines(), then the channels, what was fitted, the loss, and the warnings.
std::vector<std::string> account(const RgbMaterial& material, const Exported& exported);

/// A name of letters, digits, '_', '-' and '.' only, not empty and with no digit or '-' in front;
/// other characters become '_'.
std::string plain_name(std::string_view name);

/// Adds what a user of red, green and blue has to know: a loss that says that the stand-in is no
/// likeness (over 50 % rms, or 0.2 of albedo), a lobe too stretched to be compared well, a second
/// tangent, wavelengths that nobody sees.
void add_warnings(const RgbMaterial& material, Exported& exported);

/// True if the difference is none but rounding.
bool is_exact(const material::Difference& loss);

}  // namespace gonio::exports
