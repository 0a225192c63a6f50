// The ten materials of Ward 1992, Table 1, and tables of them in memory.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "instrument/recipe.h"
#include "table/sample_table.h"

namespace gonio::tests {

struct WardMaterial {
  std::string_view name;
  double rho_d, rho_s, alpha_x, alpha_y;
};

/// Ward, SIGGRAPH 1992, Table 1.
inline constexpr std::array<WardMaterial, 10> ward_materials{{
    {"rolled brass", .10, .33, .050, .16},
    {"rolled aluminum", .10, .21, .040, .090},
    {"lightly brushed aluminum", .15, .19, .088, .13},
    {"varnished plywood", .33, .025, .040, .11},
    {"enamel finished metal", .25, .047, .080, .096},
    {"painted cardboard box", .19, .043, .076, .085},
    {"white ceramic tile", .70, .050, .071, .071},
    {"glossy grey paper", .29, .083, .082, .082},
    {"ivory computer plastic", .45, .043, .13, .13},
    {"plastic laminate", .67, .070, .092, .092},
}};

/// A recipe that samples the material well: five incidences, four rotations, the hemisphere and a
/// dense patch about the mirror direction, one channel "Y". `model` is a Ward variant; an isotropic
/// one takes alpha_x for alpha.
inline instrument::Recipe ward_recipe(const WardMaterial& material, std::string_view model) {
  instrument::Recipe recipe;
  recipe.name = material.name;
  recipe.model = model;
  recipe.channels = {"Y"};
  recipe.parameters["rho_d"] = {material.rho_d};
  recipe.parameters["rho_s"] = {material.rho_s};
  if (model.ends_with("-aniso")) {
    recipe.parameters["alpha_x"] = {material.alpha_x};
    recipe.parameters["alpha_y"] = {material.alpha_y};
  } else {
    recipe.parameters["alpha"] = {material.alpha_x};
  }
  recipe.incidence_angles_deg = {10, 25, 40, 55, 70};
  recipe.sample_rotations_deg = {0, 30, 60, 90};
  recipe.hemisphere = {.theta_step_deg = 10, .phi_step_deg = 30};
  recipe.mirror_patch = instrument::MirrorPatch{
      .radius_step_deg = 2, .radius_max_deg = 16, .directions_per_ring = 12};
  return recipe;
}

}  // namespace gonio::tests
