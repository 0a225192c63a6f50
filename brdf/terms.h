// The list of terms. Adding a model is a header, a line here, and its tests.
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

#include "brdf/ashikhmin_shirley.h"
#include "brdf/free_frame.h"
#include "brdf/lambert.h"
#include "brdf/oren_nayar.h"
#include "brdf/phong.h"
#include "brdf/strauss.h"
#include "brdf/ward.h"

namespace gonio::brdf {

// clang-format off
using Terms = std::tuple<
    Lambert,
    OrenNayar,                     OrenNayarFull,
    Phong,                         BlinnPhong,
    IsotropicWard<WardLobe>,       AnisotropicWard<WardLobe>,
    IsotropicWard<WardApproxLobe>, AnisotropicWard<WardApproxLobe>,
    IsotropicWard<WardDuerLobe>,   AnisotropicWard<WardDuerLobe>,
    IsotropicWard<WardGmdLobe>,    AnisotropicWard<WardGmdLobe>,
    AshikhminShirley<IsotropicExponent>,        AshikhminShirley<AnisotropicExponents>,
    CoupledAshikhminShirley<IsotropicExponent>, CoupledAshikhminShirley<AnisotropicExponents>,
    Strauss,                                    StraussListing>;
// clang-format on

namespace terms_detail {

template <class T>
using FreeFrameIfAnisotropic =
    std::conditional_t<T::description.anisotropic, std::tuple<FreeFrame<T>>, std::tuple<>>;

template <class... T>
auto with_free_frames(const std::tuple<T...>&)
    -> decltype(std::tuple_cat(std::declval<std::tuple<T...>>(),
                               std::declval<FreeFrameIfAnisotropic<T>>()...));

}  // namespace terms_detail

/// Everything that a model may be made of: the list above, then every anisotropic term of it again
/// with a free frame. TermEntry::index counts in it.
using EvaluatedTerms = decltype(terms_detail::with_free_frames(std::declval<Terms>()));

}  // namespace gonio::brdf
