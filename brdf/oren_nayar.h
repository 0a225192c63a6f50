// Oren and Nayar's diffuse reflection from a surface of Lambertian V-cavities, whose slope angles
// are normally distributed with the standard deviation sigma.
//
//   oren-nayar        the simplified form: the full form without C3, without interreflection, and
//                     flat where the directions are on opposite sides
//   oren-nayar-full   their approximation of the whole model: direct illumination, linear in the
//                     albedo, plus interreflection, quadratic in it
//
// a and b are the larger and the smaller polar angle, dphi the azimuth between wi and wo. Neither
// form goes through azimuths, which do not exist at the pole.
//
// f_r grows as 1/cos(b) where both directions graze the surface on the same side (both forms) or
// anywhere but opposite each other (full form); there it saturates. Close to dphi = 90 deg, where
// the dot product of the horizontal components cancels, the first of these shares has a rounding of
// epsilon/cos(b).
//
// The direct illumination of the full form, as published, falls below 0 for sigma > 0.6644 rad
// (38 deg) where both directions graze the surface opposite each other: for sigma = 1 rad beyond
// 77 deg, for sigma = pi/2 beyond 70 deg if both are equal. It is 0 here. For rho_d near 1 the
// published sum with the interreflection is positive all the same, and is smaller than the one here
// by what was cut off, at most 0.0861 rho_d.
#pragma once

#include <cmath>
#include <numbers>

#include "brdf/lambert.h"
#include "brdf/polar_angle.h"
#include "brdf/saturated.h"
#include "brdf/term.h"

namespace gonio::brdf {

/// sigma, the roughness of Oren and Nayar's surface.
inline constexpr Parameter slope_deviation{
    .name = "sigma",
    .unit = "rad",
    .lower = 0,
    .upper = std::numbers::pi / 2,
    .search_lower = 0,
    .search_upper = 1.2,
    .scale = Scale::quadratic,
    .meaning = "standard deviation of the slope angle of the facets; 0 is Lambert's reflector",
    .source = "Oren & Nayar 1994"};

namespace oren_nayar_detail {

/// variance / (variance + offset): how the authors let everything grow with roughness.
template <class S>
S growth(const S& sigma, double offset) {
  const S variance = sigma * sigma;
  return variance / (variance + S(offset));
}

/// sin(a) sin(b) cos(dphi), without any of the three.
template <class D>
D horizontal_dot(const Direction<D>& wi, const Direction<D>& wo) {
  return wi.x * wo.x + wi.y * wo.y;
}

/// max(0, cos dphi) sin(a) tan(b): both polar sines are in the dot product.
template <class D>
D same_side(const Direction<D>& wi, const Direction<D>& wo) {
  return saturated<D>(D(larger(D(0), horizontal_dot(wi, wo)) / larger(wi.z, wo.z)));
}

/// The polar angle of a direction.
template <class D>
struct Polar {
  D sine, cosine;
};

/// The full form's functions of the two directions; none depends on roughness or albedo.
template <class D>
struct Geometry {
  /// cos(dphi) tan(b) times sin(a), or sin(a) - (2b/pi)^3 where cos(dphi) < 0: goes with C2.
  D along;
  /// (1 - |cos(dphi)|) (4ab/pi^2)^2 tan((a+b)/2): goes with C3.
  D across;
  /// 1 - cos(dphi) (2b/pi)^2: goes with the interreflection.
  D interreflection;
};

/// The cosine of the azimuth between the directions, 0 where one is at the pole.
template <class D>
D azimuth_cosine(const Direction<D>& wi, const Direction<D>& wo, const D& sine_i, const D& sine_o) {
  const D scale_i = select(less(D(0), sine_i), sine_i, D(1));
  const D scale_o = select(less(D(0), sine_o), sine_o, D(1));
  return (wi.x / scale_i) * (wo.x / scale_o) + (wi.y / scale_i) * (wo.y / scale_o);
}

/// 1 - |cosine| of that azimuth = sin^2 / (1 + |cosine|), which does not cancel. The sine comes
/// from the cross product of u and v -+ u, the same as that of u and v: it keeps its digits where
/// both graze the surface, when 1/cos(b) makes much of it. u is the one nearer to the pole, so that
/// the rounding stays within the product of their sines.
template <class D>
D off_plane(const Direction<D>& u, const Direction<D>& v, const D& sines, const D& cosine) {
  using std::abs;
  const D side = select(less(cosine, D(0)), D(1), D(-1));
  const D cross = u.x * (v.y + side * u.y) - u.y * (v.x + side * u.x);
  const D sine = cross / select(less(D(0), sines), sines, D(1));
  return sine * sine / (D(1) + abs(cosine));
}

template <class M, class D>
Direction<D> select_direction(const M& mask, const Direction<D>& a, const Direction<D>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// tan(b) (sin(a) - B^3) for B = 2b/pi, y = 1 - B: the difference is y (1 + B + B^2) - (1 - sin a),
/// and divided by cos(b) term by term it stays exact down to the smallest cosine.
template <class D>
D opposite_side(const Polar<D>& a, const Polar<D>& b, const D& b_turns, const D& y) {
  return b.sine * ((y / b.cosine) * (D(1) + b_turns + b_turns * b_turns) -
                   a.cosine * (a.cosine / b.cosine) / (D(1) + a.sine));
}

template <class D>
Geometry<D> geometry(const Direction<D>& wi, const Direction<D>& wo) {
  const Polar<D> i{polar_sine(wi), wi.z};
  const Polar<D> o{polar_sine(wo), wo.z};
  const auto i_is_lower = less(i.cosine, o.cosine);
  const Polar<D> a{select(i_is_lower, i.sine, o.sine), select(i_is_lower, i.cosine, o.cosine)};
  const Polar<D> b{select(i_is_lower, o.sine, i.sine), select(i_is_lower, o.cosine, i.cosine)};
  const D b_turns = quarter_turns(b.sine, b.cosine);
  const D y = quarter_turns(b.cosine, b.sine);
  const D turns = quarter_turns(a.sine, a.cosine) * b_turns;

  const D cosine = azimuth_cosine(wi, wo, i.sine, o.sine);
  const auto i_is_nearer = less(i.sine, o.sine);
  const D across = off_plane(select_direction(i_is_nearer, wi, wo),
                             select_direction(i_is_nearer, wo, wi), D(i.sine * o.sine), cosine);
  const auto opposite = less(cosine, D(0));
  const D from_same = select(opposite, D(1) - cosine, across);  // 1 - cos(dphi)
  return {select(opposite, D(cosine * opposite_side(a, b, b_turns, y)), same_side(wi, wo)),
          saturated<D>(D(across * (turns * turns) * (a.sine + b.sine) / (a.cosine + b.cosine))),
          y * (D(1) + b_turns) + from_same * (b_turns * b_turns)};
}

}  // namespace oren_nayar_detail

/// What the summaries are written with.
inline constexpr std::string_view oren_nayar_symbols =
    "a >= b: the polar angles of wi and wo; dphi: the azimuth between them; "
    "A = 1 - 0.5 sigma^2 / (sigma^2 + 0.33); B = 0.45 sigma^2 / (sigma^2 + 0.09)";
inline constexpr std::string_view oren_nayar_full_symbols =
    "a >= b: the polar angles of wi and wo; dphi: the azimuth between them; "
    "C1 = 1 - 0.5 sigma^2 / (sigma^2 + 0.33); g = sigma^2 / (sigma^2 + 0.09); "
    "C2 = 0.45 g (sin(a) - (cos(dphi) < 0 ? (2b/pi)^3 : 0)); C3 = 0.125 g (4ab/pi^2)^2; "
    "interreflection: 0.17 rho_d^2 / pi sigma^2 / (sigma^2 + 0.13) (1 - cos(dphi) (2b/pi)^2)";

struct OrenNayar {
  static constexpr TermDescription description{
      .name = "oren-nayar",
      .kind = TermKind::diffuse,
      .companion = "",
      .summary = "rho_d / pi (A + B max(0, cos(dphi)) sin(a) tan(b))",
      .source = "Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994",
      .symbols = oren_nayar_symbols};
  static constexpr std::array<Parameter, 1> amplitudes{diffuse_albedo};
  static constexpr std::array<Parameter, 1> shape{slope_deviation};

  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 1>& sigma, const Direction<D>& wi,
                                const Direction<D>& wo) {
    using namespace oren_nayar_detail;  // NOLINT(google-build-using-namespace)
    const D per_pi = D(1) / pi<D>();
    const S a = S(1) - S(0.5) * growth(sigma[0], 0.33);
    const S b = S(0.45) * growth(sigma[0], 0.09);
    const S value = a * S(per_pi) + b * S(per_pi * same_side(wi, wo));
    return {select(above_horizon(wi, wo), value, S(D(0)))};
  }
};

struct OrenNayarFull {
  static constexpr TermDescription description{
      .name = "oren-nayar-full",
      .kind = TermKind::diffuse,
      .companion = "",
      .summary =
          "rho_d / pi (C1 + C2 cos(dphi) tan(b) + C3 (1 - |cos(dphi)|) tan((a+b)/2)) and the "
          "interreflection of the facets, quadratic in rho_d",
      .source = "Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994",
      .symbols = oren_nayar_full_symbols,
      .coefficients = Coefficients::nonlinear};
  static constexpr std::array<Parameter, 1> amplitudes{diffuse_albedo};
  static constexpr std::array<Parameter, 1> shape{slope_deviation};

  template <class S>
  static std::array<S, 2> coefficients(const std::array<S, 1>& rho) {
    return {rho[0], rho[0] * rho[0]};
  }

  template <class S, class D>
  static std::array<S, 2> basis(const std::array<S, 1>& sigma, const Direction<D>& wi,
                                const Direction<D>& wo) {
    using namespace oren_nayar_detail;  // NOLINT(google-build-using-namespace)
    const D per_pi = D(1) / pi<D>();
    const Geometry<D> g = geometry(wi, wo);
    const S c1 = S(1) - S(0.5) * growth(sigma[0], 0.33);
    // g.along and g.across are up to the largest number: scaled down before they meet a derivative.
    const S rough = growth(sigma[0], 0.09);
    const S direct = c1 * S(per_pi) + rough * S(per_pi * (D(0.45) * g.along)) +
                     rough * S(per_pi * (D(0.125) * g.across));
    const S indirect = growth(sigma[0], 0.13) * S(D(0.17) * per_pi * g.interreflection);
    const auto above = above_horizon(wi, wo);
    return {select(above, larger(S(D(0)), direct), S(D(0))), select(above, indirect, S(D(0)))};
  }
};

}  // namespace gonio::brdf
