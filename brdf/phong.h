// Phong's lobe about the mirror direction and Blinn's about the half vector.
//
//   phong        f_r = ks max(0, r.wo)^n, r = wi mirrored at the normal: (-x, -y, z)
//   blinn-phong  f_r = ks (n.h)^n
//
// The amplitude ks is that of the BRDF itself, in 1/sr, with no normalisation: times (n+2)/(2 pi)
// of Lafortune & Willems 1994 Phong's lobe has albedo 1 at normal incidence. Phong's own shading
// multiplies no cosine: his reflected light is ks cos^n, here it is f_r cos_i.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "brdf/half_vector_lobe.h"
#include "brdf/mirror_lobe.h"
#include "brdf/term.h"

namespace gonio::brdf {

/// ks, the amplitude of the Phong lobes of one channel.
inline constexpr Parameter specular_peak{
    .name = "ks",
    .unit = "1/sr",
    .lower = 0,
    .upper = std::numeric_limits<double>::infinity(),
    .search_lower = 0,
    .search_upper = 1,
    .scale = Scale::linear,
    .meaning = "specular peak: the BRDF of the lobe where its cosine is 1",
    .source = "Phong 1975"};

struct Phong {
  static constexpr TermDescription description{
      .name = "phong",
      .kind = TermKind::specular,
      .companion = "lambert",
      .summary = "ks max(0, r.wo)^exponent, r = mirror direction of wi",
      .source = "Phong, Illumination for Computer Generated Pictures, CACM 18(6), 1975"};
  static constexpr std::array<Parameter, 1> amplitudes{specular_peak};
  static constexpr std::array<Parameter, 1> shape{cosine_exponent(
      "exponent", "sharpness: power of the cosine between the mirror direction and the viewer",
      "Phong 1975")};

  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 1>& exponent, const Direction<D>& wi,
                                const Direction<D>& wo) {
    const S lobe = power(mirror_cosine(wi, wo), exponent[0]);
    return {select(above_horizon(wi, wo), lobe, S(D(0)))};
  }
};

struct BlinnPhong {
  static constexpr TermDescription description{
      .name = "blinn-phong",
      .kind = TermKind::specular,
      .companion = "lambert",
      .summary = "ks (n.h)^exponent",
      .source =
          "Blinn, Models of Light Reflection for Computer Synthesized Pictures, SIGGRAPH 1977"};
  static constexpr std::array<Parameter, 1> amplitudes{specular_peak};
  static constexpr std::array<Parameter, 1> shape{cosine_exponent(
      "exponent", "sharpness: power of the cosine between the normal and the half vector",
      "Blinn 1977")};

  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 1>& exponent, const Direction<D>& wi,
                                const Direction<D>& wo) {
    using std::exp;
    const Direction<D> h = half_vector(wi, wo);
    const D decay = minus_log_cosine(h, length_above_horizon(h));
    return {select(above_horizon(wi, wo), exp(-exponent[0] * S(decay)), S(D(0)))};
  }
};

}  // namespace gonio::brdf
