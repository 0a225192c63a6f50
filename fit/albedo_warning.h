// A fitted model that reflects more light than arrives at angles that were measured. Duer's lobe
// grows as 1/cos_i at grazing incidence and Ward's as 1/sqrt(cos_i), however small the amplitude.
#pragma once

#include <optional>
#include <string>

#include "brdf/direction.h"
#include "fit/fit.h"

namespace gonio::fit {

/// Where the directional albedo is largest, and over 1, for the light `most_grazing_wi`, the most
/// grazing one of the samples used, or, from its azimuth, light from 60 deg or the middle between
/// both. Channels with an undetermined unknown are left out. The albedo is known to 1 %.
std::optional<std::string> albedo_warning(const FitResult& result,
                                          const Identifiability& identifiability,
                                          const brdf::Direction<double>& most_grazing_wi);

}  // namespace gonio::fit
