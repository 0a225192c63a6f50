// A term in a frame of its own: the material's tangent x' lies at the azimuth psi of the table's
// frame, from x towards y. Turning both directions by -psi about the normal gives their components
// along x' and y'; z stays.
//
// A lobe that is even in x' and in y' has the period pi in psi, and is the same with alpha_x and
// alpha_y swapped and psi a quarter turn further: a fit has to choose one of these descriptions.
//
// The turned components carry the rounding of the sine and cosine, some 1e-16 of the direction; a
// slope hx/hz at grazing angles feels it as it feels the rounding of the directions themselves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "brdf/term.h"

namespace gonio::brdf {

/// psi, the last shape parameter of every term with a free frame.
inline constexpr Parameter tangent_angle{
    .name = "psi",
    .unit = "rad",
    .lower = -std::numbers::pi / 2,
    .upper = std::numbers::pi / 2,
    .search_lower = -std::numbers::pi / 2,
    .search_upper = std::numbers::pi / 2,
    .scale = Scale::periodic,
    .meaning =
        "tangent angle: azimuth of the material's tangent x (the brushing) in the table's "
        "frame, from its x towards its y",
    .source = "Ward 1992, eq. 5a: phi is measured from x"};

/// The direction's components in the frame whose tangent is at psi, of that cosine and sine.
template <class S, class D>
Direction<S> turned(const Direction<D>& w, const S& cosine, const S& sine) {
  return {cosine * S(w.x) + sine * S(w.y), cosine * S(w.y) - sine * S(w.x), S(w.z)};
}

/// The anisotropic term T with the parameter psi after its own shape.
template <Term T>
struct FreeFrame {
  static_assert(T::description.anisotropic, "an isotropic term has no tangent to turn");

  static constexpr TermDescription description = T::description;
  static constexpr auto amplitudes = T::amplitudes;
  static constexpr std::size_t own_shape = T::shape.size();
  static constexpr std::array<Parameter, own_shape + 1> shape = [] {
    std::array<Parameter, own_shape + 1> all{};
    std::copy(T::shape.begin(), T::shape.end(), all.begin());
    all.back() = tangent_angle;
    return all;
  }();

  template <class S>
  static std::array<S, basis_size<T>> coefficients(const std::array<S, amplitudes.size()>& given) {
    return coefficients_of<T, S>(given);
  }

  template <class S, class D>
  static std::array<S, basis_size<T>> basis(const std::array<S, own_shape + 1>& theta,
                                            const Direction<D>& wi, const Direction<D>& wo) {
    using std::cos;
    using std::sin;
    const S c = cos(theta[own_shape]);
    const S s = sin(theta[own_shape]);
    std::array<S, own_shape> own;
    std::copy_n(theta.begin(), own_shape, own.begin());
    return T::template basis<S, S>(own, turned(wi, c, s), turned(wo, c, s));
  }
};

}  // namespace gonio::brdf
