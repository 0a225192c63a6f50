// The list of terms. Adding a model is a header, a line here, and its tests.
#pragma once

#include <tuple>

#include "brdf/lambert.h"
#include "brdf/ward.h"

namespace gonio::brdf {

// clang-format off
using Terms = std::tuple<
    Lambert,
    IsotropicWard<WardLobe>,       AnisotropicWard<WardLobe>,
    IsotropicWard<WardApproxLobe>, AnisotropicWard<WardApproxLobe>,
    IsotropicWard<WardDuerLobe>,   AnisotropicWard<WardDuerLobe>,
    IsotropicWard<WardGmdLobe>,    AnisotropicWard<WardGmdLobe>>;
// clang-format on

}  // namespace gonio::brdf
