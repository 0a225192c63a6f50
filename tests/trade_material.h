// Small materials for the tests of trade/.
#pragma once

#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "material/evaluate.h"
#include "material/material.h"

namespace gonio::tests {

/// One channel "Y" of lambert+ward.
inline material::Material ward_material(double rho_d, double rho_s, double alpha) {
  material::Material material;
  material.name = "ward";
  material.model = "lambert+ward";
  material.channels = {"Y"};
  material.parameters = {
      {"rho_d", {rho_d}, {}, {}}, {"rho_s", {rho_s}, {}, {}}, {"alpha", {alpha}, {}, {}}};
  return material;
}

inline brdf::BoundModel ward_model(double rho_d, double rho_s, double alpha) {
  return material::bind(ward_material(rho_d, rho_s, alpha));
}

/// One channel of lambert+ward-gmd-aniso.
inline brdf::BoundModel brushed_model(double rho_d, double rho_s, double alpha_x, double alpha_y) {
  material::Material material;
  material.model = "lambert+ward-gmd-aniso";
  material.channels = {"Y"};
  material.parameters = {{"rho_d", {rho_d}, {}, {}},
                         {"rho_s", {rho_s}, {}, {}},
                         {"alpha_x", {alpha_x}, {}, {}},
                         {"alpha_y", {alpha_y}, {}, {}}};
  return material::bind(material);
}

/// Light from the polar angle, in degrees, and the viewer in its mirror direction.
inline brdf::DirectionPair<double> mirrored_pair(double theta_deg) {
  return {brdf::direction_from_degrees(theta_deg, 0), brdf::direction_from_degrees(theta_deg, 180)};
}

}  // namespace gonio::tests
