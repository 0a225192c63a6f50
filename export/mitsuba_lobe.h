// Mitsuba 3's materials that a measured one is exported to.
//
//   blend       blendbsdf of diffuse and roughconductor: (1 - weight) reflectance / pi
//               + weight specular_reflectance D G / (4 cos_i cos_o). A roughconductor of no
//               material (eta 0, k 1) is a perfect mirror, F = 1; D and G1 are those of its
//               `distribution`, G = G1(wi) G1(wo).
//   principled  the metallic-roughness mixture after Burley, Physically Based Shading at Disney,
//               2012, with Mitsuba's mappings: alpha = max(0.001, roughness^2), stretched by
//               sqrt(1 - 0.9 anisotropic); eta = 2 / (1 - sqrt(0.08 specular)) - 1; GGX; Fresnel's
//               equations for the dielectric, Schlick's for the metal.
//
// Sources: the plugin reference of Mitsuba 3 ("roughconductor", "diffuse", "blendbsdf",
// "principled") for the names, ranges and meanings; src/bsdfs/roughconductor.cpp, principled.cpp
// and include/mitsuba/render/microfacet.h for the formulas.
#pragma once

#include <algorithm>
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

enum class Distribution { beckmann, ggx };

template <Distribution distribution, bool anisotropic>
struct MitsubaBlend {
  static constexpr auto parameters = [] {
    // Mitsuba clamps a roughness below 1e-4 and refuses a reflectance above 1.
    constexpr double least = 1e-4;
    if constexpr (anisotropic) {
      return std::array<LobeParameter, 9>{{{"weight", 0, 1},
                                           {"reflectance red", 0, 1},
                                           {"reflectance green", 0, 1},
                                           {"reflectance blue", 0, 1},
                                           {"specular_reflectance red", 0, 1},
                                           {"specular_reflectance green", 0, 1},
                                           {"specular_reflectance blue", 0, 1},
                                           {"alpha_u", least, 10, Walk::logarithmic},
                                           {"alpha_v", least, 10, Walk::logarithmic}}};
    } else {
      return std::array<LobeParameter, 8>{{{"weight", 0, 1},
                                           {"reflectance red", 0, 1},
                                           {"reflectance green", 0, 1},
                                           {"reflectance blue", 0, 1},
                                           {"specular_reflectance red", 0, 1},
                                           {"specular_reflectance green", 0, 1},
                                           {"specular_reflectance blue", 0, 1},
                                           {"alpha", least, 10, Walk::logarithmic}}};
    }
  }();
  using Values = std::array<double, parameters.size()>;

  static std::vector<Values> starts() {
    std::vector<Values> starts;
    for (const double alpha : {0.003, 0.01, 0.03, 0.1, 0.3, 0.8}) {
      if constexpr (anisotropic) {
        for (const double ratio : {0.25, 1.0, 4.0}) {
          starts.push_back({0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, alpha, alpha * ratio});
        }
      } else {
        starts.push_back({0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, alpha});
      }
    }
    return starts;
  }

  template <class S>
  static std::array<S, 3> f_r(const std::array<S, parameters.size()>& values,
                              const brdf::Direction<double>& wi,
                              const brdf::Direction<double>& wo) {
    const S& alpha_u = values[7];
    const S& alpha_v = values.back();
    const Facet facet(wi, wo);
    const S lobe = [&] {
      if constexpr (distribution == Distribution::beckmann) {
        return S(beckmann_d(alpha_u, alpha_v, facet.normal) * beckmann_g1(alpha_u, alpha_v, wi) *
                 beckmann_g1(alpha_u, alpha_v, wo));
      } else {
        return S(ggx_d(alpha_u, alpha_v, facet.normal) * ggx_g1(alpha_u, alpha_v, wi) *
                 ggx_g1(alpha_u, alpha_v, wo));
      }
    }();
    const S specular = finite(S(values[0] * lobe / (4 * wi.z) / wo.z));
    const S diffuse = (1.0 - values[0]) * std::numbers::inv_pi;
    std::array<S, 3> f_r;
    for (std::size_t c = 0; c < 3; ++c) {
      f_r[c] = values[1 + c] * diffuse + values[4 + c] * specular;
    }
    return f_r;
  }
};

template <bool anisotropic>
struct MitsubaPrincipled {
  static constexpr auto parameters = [] {
    // From sqrt(0.001): Mitsuba clamps roughness^2 there.
    constexpr LobeParameter roughness{"roughness", 0.0317, 1, Walk::logarithmic};
    if constexpr (anisotropic) {
      return std::array<LobeParameter, 7>{{{"base_color red", 0, 1},
                                           {"base_color green", 0, 1},
                                           {"base_color blue", 0, 1},
                                           {"metallic", 0, 1},
                                           {"specular", 1e-6, 1},
                                           roughness,
                                           {"anisotropic", 0, 1}}};
    } else {
      return std::array<LobeParameter, 6>{{{"base_color red", 0, 1},
                                           {"base_color green", 0, 1},
                                           {"base_color blue", 0, 1},
                                           {"metallic", 0, 1},
                                           {"specular", 1e-6, 1},
                                           roughness}};
    }
  }();
  using Values = std::array<double, parameters.size()>;

  static std::vector<Values> starts() {
    std::vector<Values> starts;
    for (const double roughness : {0.06, 0.12, 0.25, 0.5, 0.9}) {
      for (const double metallic : {0.05, 0.9}) {
        if constexpr (anisotropic) {
          starts.push_back({0.5, 0.5, 0.5, metallic, 0.5, roughness, 0.3});
        } else {
          starts.push_back({0.5, 0.5, 0.5, metallic, 0.5, roughness});
        }
      }
    }
    return starts;
  }

  template <class S>
  static std::array<S, 3> f_r(const std::array<S, parameters.size()>& values,
                              const brdf::Direction<double>& wi,
                              const brdf::Direction<double>& wo) {
    using std::sqrt;
    const S& metallic = values[3];
    const S& roughness = values[5];
    const S eta = 2.0 / (1.0 - sqrt(0.08 * values[4])) - 1.0;
    const S squared = roughness * roughness;
    S aspect(1.0);
    if constexpr (anisotropic) aspect = sqrt(1.0 - 0.9 * values[6]);
    // Mitsuba's clamp; the stretched width across may reach it.
    const S alpha_u = brdf::larger(S(squared / aspect), S(0.001));
    const S alpha_v = brdf::larger(S(squared * aspect), S(0.001));
    const Facet facet(wi, wo);
    const S lobe = finite(S(ggx_d(alpha_u, alpha_v, facet.normal) * ggx_g1(alpha_u, alpha_v, wi) *
                            ggx_g1(alpha_u, alpha_v, wo) / (4 * wi.z) / wo.z));
    const S dielectric = (1.0 - metallic) * fresnel(eta, facet.cos_to_w);
    const S diffuse = (1.0 - metallic) * burley(roughness, wi, wo, facet.cos_to_w);
    const double weight = schlick_weight(facet.cos_to_w);
    std::array<S, 3> f_r;
    for (std::size_t c = 0; c < 3; ++c) {
      const S metal = metallic * (values[c] + (1.0 - values[c]) * weight);
      f_r[c] = values[c] * diffuse + (dielectric + metal) * lobe;
    }
    return f_r;
  }

 private:
  static double schlick_weight(double cosine) {
    return std::pow(std::clamp(1 - cosine, 0., 1.), 5);
  }

  /// Fresnel's equations for unpolarised light onto a dielectric of index eta >= 1.
  template <class S>
  static S fresnel(const S& eta, double cosine) {
    using std::sqrt;
    const S transmitted = sqrt(1.0 - (1 - cosine * cosine) / (eta * eta));
    const S parallel = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    const S perpendicular = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
  }

  /// The diffuse lobe with its retro-reflection for a base colour of 1, per Burley 2012 section
  /// 5.3, split as in his course notes of 2015.
  template <class S>
  static S burley(const S& roughness, const brdf::Direction<double>& wi,
                  const brdf::Direction<double>& wo, double cos_to_w) {
    const double in = schlick_weight(wi.z);
    const double out = schlick_weight(wo.z);
    const S retro = 2.0 * roughness * (cos_to_w * cos_to_w);
    return ((1 - in / 2) * (1 - out / 2) + retro * (out + in + out * in * (retro - 1.0))) *
           std::numbers::inv_pi;
  }
};

}  // namespace gonio::exports
