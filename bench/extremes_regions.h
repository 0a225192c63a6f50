// The regions in which formulas of reflectance go wrong, each with a way to draw pairs of
// directions there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "bench/random_source.h"
#include "brdf/direction.h"

namespace gonio::bench {

struct DirectionPair {
  brdf::Direction<double> wi, wo;
};

/// f_r of a term with given parameters.
using Reflectance =
    std::function<double(const brdf::Direction<double>&, const brdf::Direction<double>&)>;

struct Region {
  std::string_view name;
  std::string_view meaning;
  /// A pair of unit directions, or none if the draw falls below the horizon. Most regions do not
  /// look at the reflectance; the lobe's does.
  std::optional<DirectionPair> (*draw)(RandomSource&, const Reflectance&);
};

/// All regions; a study runs over whatever is in the list.
std::span<const Region> regions();

/// A pair from the region, above the horizon.
DirectionPair draw_pair(const Region& region, RandomSource& random, const Reflectance& f);

/// What counts as the peak of f_r for this light: the largest over its viewers, or that for a light
/// at 45 degrees times cos(45 deg) where it is larger. Viewers are looked for in the mirror
/// direction, at the light's own place, at the normal, at polar angles to 89.999 degrees before,
/// behind and beside the light, and where the half vector is tilted along x or along y.
///
/// Times cos_i it is never above the peak of f_r cos_i over all directions: whatever exceeds a
/// share of that exceeds the same share here.
double peak_of(const Reflectance& f, const brdf::Direction<double>& wi);

}  // namespace gonio::bench
