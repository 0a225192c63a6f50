// A Zemax tabular BSDF between its samples.
#pragma once

#include <functional>
#include <span>

#include "brdf/direction.h"
#include "table/formats/zemax_text.h"

namespace gonio::table {

/// GriddedTable::f_r of the text's values, in which a NaN is a hole. Holds the values by itself.
std::function<void(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                   std::span<double> f_r)>
zemax_interpolation(ZemaxText text);

}  // namespace gonio::table
