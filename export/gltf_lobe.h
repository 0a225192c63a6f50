// The metallic-roughness material of glTF 2.0 with KHR_materials_ior, KHR_materials_specular and
// KHR_materials_anisotropy, as its specification evaluates it.
//
// Sources: glTF 2.0 specification, Appendix B ("BRDF Implementation": D of GGX, height-correlated
// Smith visibility, Schlick's Fresnel, metal and dielectric mixed by metallic);
// KHR_materials_specular, "Implementation" (F0 and F90 of the dielectric, whose largest component
// the diffuse part loses); KHR_materials_anisotropy, "Anisotropy" (alpha along the tangent is
// mix(roughness^2, 1, strength^2), across it roughness^2). That extension's sample code also clamps
// the visibility to 1, which darkens grazing angles and is no part of the model: left out here.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "brdf/direction.h"
#include "brdf/scalar.h"
#include "export/foreign_lobe.h"
#include "export/microfacet.h"

namespace gonio::exports {

/// The material by the numbers that the specification's formulas take; `f0` of the dielectric is
/// min(1, ((ior - 1) / (ior + 1))^2 specularColor) there.
template <class S>
struct GltfSurface {
  std::array<S, 3> base_color;
  S metallic;
  S specular;
  std::array<S, 3> f0;
  S largest_f0;
  S alpha_along;  // the tangent
  S alpha_across;
};

/// f_r in 1/sr of R, G and B for directions above the horizon.
template <class S>
std::array<S, 3> gltf_f_r(const GltfSurface<S>& surface, const brdf::Direction<double>& wi,
                          const brdf::Direction<double>& wo) {
  const Facet facet(wi, wo);
  const S lobe =
      finite(S(ggx_d(surface.alpha_along, surface.alpha_across, facet.normal) *
               ggx_correlated_visibility(surface.alpha_along, surface.alpha_across, wi, wo)));
  const double weight = std::pow(1 - facet.cos_to_w, 5);
  const auto schlick = [&](const S& f0) { return S(f0 + (1.0 - f0) * weight); };
  const S dielectric = 1.0 - surface.metallic;
  const S diffuse =
      dielectric * (1.0 - surface.specular * schlick(surface.largest_f0)) * std::numbers::inv_pi;
  std::array<S, 3> f_r;
  for (std::size_t c = 0; c < 3; ++c) {
    const S fresnel = dielectric * surface.specular * schlick(surface.f0[c]) +
                      surface.metallic * schlick(surface.base_color[c]);
    f_r[c] = surface.base_color[c] * diffuse + fresnel * lobe;
  }
  return f_r;
}

/// The material as it is fitted: F0 of the dielectric instead of the index and the specular colour
/// that give it, largest in the first channel and elsewhere a share of that. So nothing has a kink
/// inside the bounds, and an uncoloured highlight lies on one of them.
template <bool anisotropic>
struct GltfLobe {
  static constexpr auto parameters = [] {
    constexpr LobeParameter roughness{"roughness", 0.01, 1, Walk::logarithmic};
    if constexpr (anisotropic) {
      return std::array<LobeParameter, 10>{{{"base color 1", 0, 1},
                                            {"base color 2", 0, 1},
                                            {"base color 3", 0, 1},
                                            {"metallic", 0, 1},
                                            roughness,
                                            {"specular", 0, 1},
                                            {"F0 1", 0, 1},
                                            {"F0 2 per F0 1", 0, 1},
                                            {"F0 3 per F0 1", 0, 1},
                                            {"anisotropy strength", 0, 1}}};
    } else {
      return std::array<LobeParameter, 9>{{{"base color 1", 0, 1},
                                           {"base color 2", 0, 1},
                                           {"base color 3", 0, 1},
                                           {"metallic", 0, 1},
                                           roughness,
                                           {"specular", 0, 1},
                                           {"F0 1", 0, 1},
                                           {"F0 2 per F0 1", 0, 1},
                                           {"F0 3 per F0 1", 0, 1}}};
    }
  }();
  using Values = std::array<double, parameters.size()>;

  static std::vector<Values> starts() {
    std::vector<Values> starts;
    for (const double roughness : {0.06, 0.15, 0.3, 0.6}) {
      for (const double metallic : {0.1, 0.9}) {
        if constexpr (anisotropic) {
          for (const double strength : {0.1, 0.5}) {
            starts.push_back({0.5, 0.5, 0.5, metallic, roughness, 0.5, 0.5, 0.8, 0.8, strength});
          }
        } else {
          starts.push_back({0.5, 0.5, 0.5, metallic, roughness, 0.5, 0.5, 0.8, 0.8});
        }
      }
    }
    return starts;
  }

  template <class S>
  static GltfSurface<S> surface(const std::array<S, parameters.size()>& values) {
    const S across = values[4] * values[4];
    const S along = [&] {
      if constexpr (anisotropic) {
        return S(across + (1.0 - across) * values[9] * values[9]);
      } else {
        return S(across);
      }
    }();
    return {.base_color = {values[0], values[1], values[2]},
            .metallic = values[3],
            .specular = values[5],
            .f0 = {values[6], values[6] * values[7], values[6] * values[8]},
            .largest_f0 = values[6],
            .alpha_along = along,
            .alpha_across = across};
  }

  template <class S>
  static std::array<S, 3> f_r(const std::array<S, parameters.size()>& values,
                              const brdf::Direction<double>& wi,
                              const brdf::Direction<double>& wo) {
    return gltf_f_r(surface(values), wi, wo);
  }
};

}  // namespace gonio::exports
