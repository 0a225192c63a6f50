// A recipe: what the virtual gonioreflectometer is to measure, and how noisily. Its JSON file is
// described by schema/recipe.schema.json.
//
// The instrument is Ward's (Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992): the
// lamp moves on an arc at azimuth 0 of the laboratory (the incidence angles), the sample turns
// about its normal (the rotations), a camera sees all exitant directions at once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/bound_model.h"
#include "table/sample_table.h"

namespace gonio::instrument {

/// Exitant directions over the whole hemisphere: the pole, then rings of constant theta, from the
/// laboratory's azimuth 0 on.
struct HemisphereGrid {
  double theta_step_deg = 10;
  double phi_step_deg = 30;
};

/// Further exitant directions about the mirror direction of the lamp: the mirror direction, then
/// rings of constant angle to it.
struct MirrorPatch {
  double radius_step_deg = 2;
  double radius_max_deg = 10;
  std::uint32_t directions_per_ring = 12;
};

/// A reading of the true quantity q is q (1 + relative e1) + floor e2, with e1 and e2 independent
/// and standard normal.
struct Noise {
  double relative = 0;
  /// In units of the recipe's quantity: 1/sr for brdf and brdf_cos.
  double floor = 0;
  std::uint64_t seed = 0;
};

struct Recipe {
  std::string name;
  std::string comment;
  /// As brdf::Model takes it; a bare specular name brings its author's diffuse term.
  std::string model;
  std::vector<std::string> channels;
  /// Every parameter of the model: one value per channel for an amplitude, a single one for a
  /// shape. With a tangent angle (psi, psi_2) among them, the material's frame is turned by it in
  /// the sample's.
  std::map<std::string, std::vector<double>> parameters;
  std::vector<double> incidence_angles_deg;
  std::vector<double> sample_rotations_deg;
  /// Exitant directions beyond it are left out.
  double theta_max_deg = 80;
  HemisphereGrid hemisphere;
  std::optional<MirrorPatch> mirror_patch;
  Noise noise;
  /// Whether the table states the standard deviation of each value.
  bool sigma_columns = false;
  /// What the instrument reads, and therefore what the noise is added to. The table holds f_r.
  table::Quantity quantity = table::Quantity::brdf;
};

/// The recipe's material, to be evaluated many times. Throws std::invalid_argument for an unknown
/// model or values that do not suit it.
brdf::BoundModel bind(const Recipe& recipe);

/// What keeps a recipe from being measured.
struct RecipeProblem {
  std::string pointer;  // the JSON pointer of the field
  std::string text;     // what was found, expected, and what to do
};

/// The first thing that is wrong with a recipe: an unknown model, parameters that do not suit it,
/// an angle out of range, a step that is not positive, sigma columns that would hold 0, more than
/// 100 million samples.
std::optional<RecipeProblem> find_problem(const Recipe& recipe);

/// Reads a recipe file. Throws table::FileError with the field, what was found and expected.
Recipe read_recipe(const std::string& path);

/// The same for a text; `path` is for messages.
Recipe parse_recipe(std::string_view json, const std::string& path);

}  // namespace gonio::instrument
