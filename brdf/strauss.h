// Strauss's model: from matt to mirror and from plastic to metal with few intuitive parameters.
//
//   strauss           the argument of F and G is the angle over pi/2, as in the article: Fresnel
//                     reflection at grazing angles
//   strauss-listing   the argument is the cosine, as the Direct3D-book listing passes it: the
//                     Fresnel term is turned round, full at normal incidence
//
//   I = cos_i d Rd c + lobe R Cs,  f_r = I / (pi cos_i)
//   d = 1 - m s,  Rd = (1 - s^3)(1 - t),  r = s^3 (1 - t),  lobe = max(0, mirror.wo)^(3/(1-s)),
//   j = F(x_i) G(x_i) G(x_o),  R = min(1, r + j (r + 0.1)),  Cs = 1 + m (1 - F(x_i)) (c - 1)
//
// f_r is affine in the colour c. It is not reciprocal. Where the light grazes the surface it grows
// as 1/cos_i and saturates. At s = 1 the lobe is its limit: 1 in the mirror direction, else 0.
//
// Every difference that would cancel is written as a product or as a sum of positive numbers.
#pragma once

#include <cmath>

#include "brdf/mirror_lobe.h"
#include "brdf/polar_angle.h"
#include "brdf/saturated.h"
#include "brdf/term.h"

namespace gonio::brdf {

namespace strauss_detail {

/// The argument x of F and G with its complement, and both as multiples of the cosine, with which
/// one of them goes to 0.
template <class D>
struct Argument {
  D x;
  D complement;  // 1 - x
  D x_per_cosine;
  D complement_per_cosine;
};

/// F(x) / x and (1 - F(x)) / (1 - x): 1/(x - kf)^2, shifted and scaled to F(0) = 0 and F(1) = 1.
/// kf = 1.12.
template <class D>
struct Fresnel {
  D per_x;
  D complement_per_complement;
};

template <class D>
Fresnel<D> fresnel(const Argument<D>& a) {
  const D distance = D(0.12) + a.complement;  // kf - x
  const D denominator = D(1.24) * distance * distance;
  return {D(0.12 * 0.12) * (D(1.12) + distance) / denominator,
          D(1.12 * 1.12) * (D(0.12) + distance) / denominator};
}

/// G(x), the geometric attenuation: -1/(x - ks)^2, shifted and scaled to G(0) = 1 and G(1) = 0.
/// ks = 1.01.
template <class D>
D attenuation(const Argument<D>& a) {
  const D distance = D(0.01) + a.complement;  // ks - x
  return a.complement * (D(0.01) + distance) * D(1.01 * 1.01) / (D(1.02) * distance * distance);
}

/// max(0, mirror.wo)^(3/(1-s)).
template <class S, class D>
S lobe(const S& smoothness, const Direction<D>& wi, const Direction<D>& wo) {
  const MirrorCosine<D> cosine = mirror_cosine(wi, wo);
  const S rest = S(D(1)) - smoothness;
  const auto is_lobe = less(S(D(0)), rest);
  // Unit vectors are the mirror image of each other to their last digits only.
  const D epsilon(std::numeric_limits<D>::epsilon());
  const S mirror = S(select(less(cosine.log, D(D(-16) * epsilon * epsilon)), D(0), D(1)));
  return select(is_lobe, power(cosine, S(S(D(3)) / select(is_lobe, rest, S(D(1))))), mirror);
}

/// A shape parameter s, m or t.
constexpr Parameter share(std::string_view name, double search_lower, double search_upper,
                          std::string_view meaning) {
  return {.name = name,
          .unit = "1",
          .lower = 0,
          .upper = 1,
          .search_lower = search_lower,
          .search_upper = search_upper,
          .scale = Scale::linear,
          .meaning = meaning,
          .source = "Strauss 1990"};
}

}  // namespace strauss_detail

/// x as in Strauss's article: the polar angle over pi/2.
struct StraussAngle {
  static constexpr std::string_view name = "strauss";
  static constexpr std::string_view summary =
      "(cos_i d Rd c + lobe R Cs) / (pi cos_i), for the angle x = theta / (pi/2): metals and "
      "plastics, matt to mirror";

  template <class D>
  static strauss_detail::Argument<D> argument(const Direction<D>& w) {
    const D sine = polar_sine(w);
    const D x = quarter_turns(sine, w.z);
    const D complement = quarter_turns(w.z, sine);
    return {x, complement, x / w.z, complement / w.z};
  }
};

/// x as in the listing: the cosine of the polar angle.
struct StraussCosine {
  static constexpr std::string_view name = "strauss-listing";
  static constexpr std::string_view summary =
      "strauss for the cosine x = cos(theta), as a published shader has it, which turns the "
      "Fresnel effect round";

  template <class D>
  static strauss_detail::Argument<D> argument(const Direction<D>& w) {
    const D sine = polar_sine(w);
    const D complement = sine * sine / (D(1) + w.z);
    return {w.z, complement, D(1), complement / w.z};
  }
};

/// What the summaries are written with.
inline constexpr std::string_view strauss_symbols =
    "d = 1 - m s; Rd = (1 - s^3)(1 - t); lobe = max(0, mirror.wo)^(3/(1-s)); r = s^3 (1 - t); "
    "j = F(x_i) G(x_i) G(x_o); R = min(1, r + j (r + 0.1)); Cs = 1 + m (1 - F(x_i)) (c - 1); "
    "F: Fresnel reflection, from 0 at x = 0 to 1 at x = 1; G: attenuation, from 1 to 0";

template <class ArgumentOf>
struct StraussTerm {
  static constexpr TermDescription description{
      .name = ArgumentOf::name,
      .kind = TermKind::whole,
      .companion = "",
      .summary = ArgumentOf::summary,
      .source = "Strauss, A Realistic Lighting Model for Computer Animators, IEEE CG&A 10(6), 1990",
      .symbols = strauss_symbols,
      .coefficients = Coefficients::affine,
      .reciprocal = false};
  static constexpr std::array<Parameter, 1> amplitudes{
      {{.name = "c",
        .unit = "1",
        .lower = 0,
        .upper = 1,
        .search_lower = 0,
        .search_upper = 1,
        .scale = Scale::linear,
        .meaning = "base colour of a channel: of the diffuse light and of a metal's highlight",
        .source = "Strauss 1990"}}};
  static constexpr std::array<Parameter, 3> shape{
      strauss_detail::share("s", 0.05, 0.98,
                            "smoothness: 0 is matt, 1 a perfect mirror; the lobe's exponent is "
                            "3/(1 - s)"),
      strauss_detail::share("m", 0.02, 0.98,
                            "metalness: 1 tints the highlight with c and takes the diffuse light "
                            "away as s grows"),
      strauss_detail::share("t", 0, 0.95,
                            "transparency: the share of the light that passes through; 0 is "
                            "opaque")};

  template <class S>
  static std::array<S, 2> coefficients(const std::array<S, 1>& c) {
    return {c[0], S(1)};
  }

  /// Of a grey material, with one c for all channels, only (1 - m s) c and m (1 - c) are seen: the
  /// shape of the other one that looks the same; there is none where its m is not in 0..1. Its
  /// c is 1 - s m.
  static std::array<double, 3> twin(const std::array<double, 3>& smt,
                                    const std::array<double, 1>& c) {
    return {smt[0], (1 - c[0]) / smt[0], smt[2]};
  }

  template <class S, class D>
  static std::array<S, 2> basis(const std::array<S, 3>& smt, const Direction<D>& wi,
                                const Direction<D>& wo) {
    using namespace strauss_detail;  // NOLINT(google-build-using-namespace)
    const auto& [s, m, t] = smt;
    const S one(D(1));
    const D per_pi = D(1) / pi<D>();
    const Argument<D> in = ArgumentOf::argument(wi);
    const Argument<D> out = ArgumentOf::argument(wo);
    const Fresnel<D> f = fresnel(in);
    const D j = f.per_x * in.x * attenuation(in) * attenuation(out);

    const S opaque = one - t;
    const S dull = one - m + m * (one - s);                    // d = 1 - m s
    const S diffuse = (one - s) * (one + s + s * s) * opaque;  // Rd
    const S r = s * s * s * opaque;
    const S unbounded = r + S(j) * (r + S(D(0.1)));
    const S reflected = select(less(one, unbounded), one, unbounded);  // R
    const S highlight = lobe(s, wi, wo) * reflected * S(per_pi);

    const S tinted =
        highlight * m * S(saturated<S>(D(f.complement_per_complement * in.complement_per_cosine)));
    const S white = highlight * (one - m) * S(saturated<S>(D(D(1) / wi.z))) +
                    highlight * m * S(saturated<S>(D(f.per_x * in.x_per_cosine)));
    const auto above = above_horizon(wi, wo);
    return {select(above, S(dull * diffuse * S(per_pi) + tinted), S(D(0))),
            select(above, white, S(D(0)))};
  }
};

using Strauss = StraussTerm<StraussAngle>;
using StraussListing = StraussTerm<StraussCosine>;

}  // namespace gonio::brdf
