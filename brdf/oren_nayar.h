// Oren and Nayar's diffuse reflection from a surface of Lambertian V-cavities, whose slope angles
// are normally distributed with the standard deviation sigma.
//
//   oren-nayar        the simplified form that they recommend (their eq. 30): the full form without
//                     C3, without interreflection, and with C2 as if cos(dphi) were positive
//   oren-nayar-full   the functional approximation of the whole model (their eq. 27 to 29): direct
//                     illumination, linear in the albedo, plus interreflection, quadratic in it
//
// a and b are the larger and the smaller polar angle, dphi the azimuth between wi and wo. Neither
// form goes through azimuths, which do not exist at the pole.
//
// f_r grows as 1/cos(b) where both directions graze the surface on the same side (both forms) or
// anywhere but opposite each other (full form); there it saturates. The direct illumination of the
// full form, as published, falls below 0 for sigma > 0.6644 rad (38 deg) where both directions
// graze it opposite each other. It is 0 there: for rho_d near 1 the published sum with the
// interreflection may be positive and is then smaller than the one here.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "brdf/lambert.h"
#include "brdf/polar_angle.h"
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
    .scale = Scale::linear,
    .meaning = "standard deviation of the slope angle of the facets; 0 is Lambert's reflector",
    .source = "Oren & Nayar 1994"};

namespace oren_nayar_detail {

/// The smaller of a quotient and the largest finite number.
template <class D>
D saturated(const D& quotient) {
  const D largest((std::numeric_limits<D>::max)());
  return select(less(quotient, largest), quotient, largest);
}

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
  return saturated(D(larger(D(0), horizontal_dot(wi, wo)) / larger(wi.z, wo.z)));
}

/// What the full form needs of a direction; the azimuth is a unit vector, or 0 at the pole.
template <class D>
struct Polar {
  D sine, cosine, azimuth_x, azimuth_y;
};

template <class D>
Polar<D> polar(const Direction<D>& w) {
  const D sine = polar_sine(w);
  const D scale = select(less(D(0), sine), sine, D(1));
  return {sine, w.z, w.x / scale, w.y / scale};
}

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

/// tan(b) (sin(a) - (2b/pi)^3) with y = 1 - 2b/pi: the difference is y (1 + B + B^2) - (1 - sin a),
/// B = 2b/pi, and divided by cos(b) term by term it stays exact down to the smallest cosine.
template <class D>
D opposite_side(const Polar<D>& a, const Polar<D>& b, const D& b_turns) {
  const D y_per_cosine = quarter_turns(b.cosine, b.sine) / b.cosine;
  return b.sine * (y_per_cosine * (D(1) + b_turns + b_turns * b_turns) -
                   a.cosine * (a.cosine / b.cosine) / (D(1) + a.sine));
}

template <class D>
Geometry<D> geometry(const Direction<D>& wi, const Direction<D>& wo) {
  using std::abs;
  const auto i_is_lower = less(wi.z, wo.z);
  const auto choose = [&](const D& if_i, const D& if_o) { return select(i_is_lower, if_i, if_o); };
  const Polar<D> i = polar(wi);
  const Polar<D> o = polar(wo);
  const Polar<D> a{choose(i.sine, o.sine), choose(i.cosine, o.cosine), D(0), D(0)};
  const Polar<D> b{choose(o.sine, i.sine), choose(o.cosine, i.cosine), D(0), D(0)};
  const D a_turns = quarter_turns(a.sine, a.cosine);
  const D b_turns = quarter_turns(b.sine, b.cosine);
  const D cosine = i.azimuth_x * o.azimuth_x + i.azimuth_y * o.azimuth_y;
  const D sine = i.azimuth_x * o.azimuth_y - i.azimuth_y * o.azimuth_x;
  // 1 - |cos| = sin^2 / (1 + |cos|), which does not cancel.
  const D off_plane = sine * sine / (D(1) + abs(cosine));
  const D turns = a_turns * b_turns;
  return {select(less(cosine, D(0)), D(cosine * opposite_side(a, b, b_turns)), same_side(wi, wo)),
          saturated(D(off_plane * (turns * turns) * (a.sine + b.sine) / (a.cosine + b.cosine))),
          D(1) - cosine * (b_turns * b_turns)};
}

}  // namespace oren_nayar_detail

struct OrenNayar {
  static constexpr TermDescription description{
      .name = "oren-nayar",
      .kind = TermKind::diffuse,
      .companion = "",
      .summary = "rho_d / pi (A + B max(0, cos dphi) sin(a) tan(b)), a >= b",
      .source = "Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994"};
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
      .summary = "Oren and Nayar's model with all its terms: direct light and interreflection",
      .source = "Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994",
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
