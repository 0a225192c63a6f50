// Lambert's ideal diffuse reflector: f_r = rho_d / pi.
#pragma once

#include <limits>

#include "brdf/term.h"

namespace gonio::brdf {

/// rho_d, the amplitude that all diffuse terms share: the diffuse albedo of a channel.
inline constexpr Parameter diffuse_albedo{
    .name = "rho_d",
    .unit = "1",
    .lower = 0,
    .upper = std::numeric_limits<double>::infinity(),
    .search_lower = 0,
    .search_upper = 1,
    .scale = Scale::linear,
    .meaning = "diffuse albedo: the share of the incident light that is scattered diffusely",
    .source = "Lambert 1760"};

struct Lambert {
  static constexpr TermDescription description{
      .name = "lambert",
      .kind = TermKind::diffuse,
      .companion = "",
      .summary = "ideal diffuse reflector, f_r = rho_d / pi",
      .source = "Lambert, Photometria, 1760"};
  static constexpr std::array<Parameter, 1> amplitudes{diffuse_albedo};
  static constexpr std::array<Parameter, 0> shape{};

  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 0>& /*shape*/, const Direction<D>& wi,
                                const Direction<D>& wo) {
    return {select(above_horizon(wi, wo), S(D(1) / pi<D>()), S(D(0)))};
  }
};

}  // namespace gonio::brdf
