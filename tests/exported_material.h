// What the tests of exports to renderers share: materials of three channels, and the loss of a
// stand-in by plain sums over other directions than those of the fit.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "brdf/direction.h"
#include "brdf/model.h"
#include "material/evaluate.h"
#include "material/material.h"

namespace gonio::tests {

using Rgb = std::array<double, 3>;

/// f_r of R, G and B in 1/sr.
using RgbReflectance =
    std::function<Rgb(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo)>;

/// A material of the channels R, G and B.
inline material::Material rgb_material_of(
    const std::string& model,
    std::initializer_list<std::pair<std::string, std::vector<double>>> parameters) {
  material::Material material;
  material.name = "test paint";
  material.model = brdf::Model(model).name();
  material.channels = {"R", "G", "B"};
  for (const auto& [name, values] : parameters) {
    material.parameters.push_back({.name = name, .value = values, .stddev = {}, .interval95 = {}});
  }
  return material;
}

/// The root mean square of the difference of f_r cos_i per that of the material, over the same
/// lights as the fit's, at azimuth 0 and, if asked for, over a quarter turn; viewers every half
/// degree to 80 deg and every 2 deg around.
inline double plain_rms_loss(const material::Material& material, const RgbReflectance& stand_in,
                             bool all_azimuths) {
  constexpr double degree = std::numbers::pi / 180;
  const brdf::BoundModel model = material::bind(material);
  double difference = 0;
  double radiance = 0;
  const std::vector<double> azimuths =
      all_azimuths ? std::vector<double>{0, 30, 60, 90} : std::vector<double>{0};
  for (double theta_i = 0; theta_i <= 75; theta_i += 15) {
    for (const double phi_i : azimuths) {
      const auto wi = brdf::direction_from_degrees(theta_i, phi_i);
      for (double theta_o = 0.25; theta_o < 80; theta_o += 0.5) {
        for (double phi_o = 1; phi_o < 360; phi_o += 2) {
          const auto wo = brdf::direction_from_degrees(theta_o, phi_o);
          Rgb truth{};
          model.f_r(wi, wo, truth);
          const Rgb other = stand_in(wi, wo);
          for (std::size_t c = 0; c < 3; ++c) {
            const double weight = std::sin(theta_o * degree) * wi.z * wi.z;
            difference += weight * (other[c] - truth[c]) * (other[c] - truth[c]);
            radiance += weight * truth[c] * truth[c];
          }
        }
      }
    }
  }
  return std::sqrt(difference / radiance);
}

}  // namespace gonio::tests
