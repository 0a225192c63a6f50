// One answer where several parameter values describe the same material.
#pragma once

#include <optional>

#include "brdf/model.h"
#include "fit/parameters.h"

namespace gonio::fit {

/// The same f_r, described canonically, as far as the box allows:
///   in a free frame alpha_x <= alpha_y (exponents nu >= nv), psi turned by a quarter where they
///   were swapped, and in [-pi/2, pi/2);
///   of two equal lobes the first is the one whose shape comes first in ascending order.
ParameterValues canonical(const brdf::Model& model, const Box& box, ParameterValues values);

/// The start to another material that looks like this one where all channels are alike (a term's
/// twin, brdf/term.h); nothing where the model has none, or none inside the box.
std::optional<ParameterValues> twin_of(const brdf::Model& model, const Box& box,
                                       ParameterValues values);

}  // namespace gonio::fit
