#include "instrument/recipe.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "table/channel_names.h"
#include "table/json_file.h"

namespace gonio::instrument {
namespace {

using table::JsonField;

constexpr std::string_view format_word = "gonio-recipe";
constexpr std::uint64_t newest_version = 1;
constexpr double most_samples = 1e8;
// Readers take what is closer to the horizon than this for the horizon itself.
constexpr double horizon_deg = 90 - 1e-6;

using Problem = std::optional<RecipeProblem>;

// Checks -------------------------------------------------------------------------------------

Problem material_problem(const Recipe& recipe) {
  if (const auto problem = table::channel_names_problem(recipe.channels)) {
    return RecipeProblem{"/channels", *problem};
  }
  try {
    bind(recipe);
  } catch (const brdf::ParameterError& error) {
    return RecipeProblem{"/parameters/" + error.parameter(), error.what()};
  } catch (const std::invalid_argument& error) {
    return RecipeProblem{"/model", error.what()};
  }
  return std::nullopt;
}

Problem angles_problem(const std::string& pointer, const std::vector<double>& angles, double lowest,
                       double highest, std::string_view range) {
  if (angles.empty()) return RecipeProblem{pointer, "found no angle, expected one at least"};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (angles[i] >= lowest && angles[i] <= highest) continue;
    return RecipeProblem{fmt::format("{}/{}", pointer, i),
                         fmt::format("found {} degrees, expected {}", angles[i], range)};
  }
  return std::nullopt;
}

Problem number_problem(const std::string& pointer, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return std::nullopt;
  return RecipeProblem{pointer, fmt::format("found {}, expected {} to {}", value, lowest, highest)};
}

Problem directions_problem(const Recipe& recipe) {
  constexpr double smallest_step = 1e-3;
  const std::string at = "/exitant_directions";
  if (auto p = number_problem(at + "/theta_max_deg", recipe.theta_max_deg, 0, 90)) return p;
  if (auto p = number_problem(at + "/hemisphere/theta_step_deg", recipe.hemisphere.theta_step_deg,
                              smallest_step, 90)) {
    return p;
  }
  if (auto p = number_problem(at + "/hemisphere/phi_step_deg", recipe.hemisphere.phi_step_deg,
                              smallest_step, 360)) {
    return p;
  }
  if (!recipe.mirror_patch) return std::nullopt;
  const MirrorPatch& patch = *recipe.mirror_patch;
  if (auto p = number_problem(at + "/mirror_patch/radius_step_deg", patch.radius_step_deg,
                              smallest_step, 90)) {
    return p;
  }
  if (auto p = number_problem(at + "/mirror_patch/radius_max_deg", patch.radius_max_deg, 0, 90)) {
    return p;
  }
  return number_problem(at + "/mirror_patch/directions_per_ring", patch.directions_per_ring, 1,
                        1e6);
}

Problem noise_problem(const Recipe& recipe) {
  constexpr double largest = 1e6;
  if (auto p = number_problem("/noise/relative", recipe.noise.relative, 0, largest)) return p;
  if (auto p = number_problem("/noise/floor", recipe.noise.floor, 0, largest)) return p;
  if (recipe.sigma_columns && recipe.noise.floor == 0) {
    return RecipeProblem{"/sigma_columns",
                         "found true with a noise floor of 0, where a reading of 0 would have the "
                         "standard deviation 0: give noise.floor a value or leave sigma_columns "
                         "out"};
  }
  return std::nullopt;
}

Problem size_problem(const Recipe& recipe) {
  const double rings = std::floor(recipe.theta_max_deg / recipe.hemisphere.theta_step_deg);
  double exitant = 1 + rings * std::ceil(360 / recipe.hemisphere.phi_step_deg);
  if (recipe.mirror_patch) {
    exitant +=
        1 + std::floor(recipe.mirror_patch->radius_max_deg / recipe.mirror_patch->radius_step_deg) *
                recipe.mirror_patch->directions_per_ring;
  }
  const double samples = exitant * static_cast<double>(recipe.incidence_angles_deg.size()) *
                         static_cast<double>(recipe.sample_rotations_deg.size());
  if (samples <= most_samples) return std::nullopt;
  return RecipeProblem{"/exitant_directions",
                       fmt::format("found {:.0f} samples in all, expected at most {:.0f}: take "
                                   "larger steps or fewer incidence angles and rotations",
                                   samples, most_samples)};
}

// Reading ------------------------------------------------------------------------------------

std::map<std::string, std::vector<double>> read_parameters(const JsonField& field) {
  std::map<std::string, std::vector<double>> parameters;
  for (const auto& [name, value] : field.members()) {
    if (!value.is_array() && !value.is_number()) {
      value.expected("a number, or an array with one number per channel");
    }
    parameters[name] = value.is_array() ? value.numbers() : std::vector{value.number()};
  }
  return parameters;
}

MirrorPatch read_mirror_patch(const JsonField& field) {
  field.allow_only({"radius_step_deg", "radius_max_deg", "directions_per_ring"});
  const JsonField count = field.member("directions_per_ring");
  if (count.whole_number() > std::numeric_limits<std::uint32_t>::max()) {
    count.expected("1 to 1000000");
  }
  return {.radius_step_deg = field.member("radius_step_deg").number(),
          .radius_max_deg = field.member("radius_max_deg").number(),
          .directions_per_ring = static_cast<std::uint32_t>(count.whole_number())};
}

void read_exitant_directions(const JsonField& field, Recipe& recipe) {
  field.allow_only({"theta_max_deg", "hemisphere", "mirror_patch"});
  recipe.theta_max_deg = field.member("theta_max_deg").number();
  const JsonField hemisphere = field.member("hemisphere");
  hemisphere.allow_only({"theta_step_deg", "phi_step_deg"});
  recipe.hemisphere = {.theta_step_deg = hemisphere.member("theta_step_deg").number(),
                       .phi_step_deg = hemisphere.member("phi_step_deg").number()};
  if (const auto patch = field.find("mirror_patch")) {
    recipe.mirror_patch = read_mirror_patch(*patch);
  }
}

Noise read_noise(const JsonField& field) {
  field.allow_only({"relative", "floor", "seed"});
  return {.relative = field.member("relative").number(),
          .floor = field.member("floor").number(),
          .seed = field.member("seed").whole_number()};
}

table::Quantity read_quantity(const JsonField& field) {
  using table::Quantity;
  const std::string text = field.text();
  for (const Quantity q : {Quantity::brdf, Quantity::brdf_cos, Quantity::reflectance_factor}) {
    if (text == table::name(q)) return q;
  }
  field.expected("brdf, brdf_cos or reflectance_factor");
}

Recipe recipe_of(const table::JsonFile& file) {
  file.require_format(format_word, newest_version);
  const JsonField root = file.root();
  root.allow_only({"$schema", "format", "version", "name", "comment", "model", "channels",
                   "parameters", "incidence_angles_deg", "sample_rotations_deg",
                   "exitant_directions", "noise", "sigma_columns", "quantity"});
  Recipe recipe;
  recipe.name = root.member("name").text();
  if (const auto comment = root.find("comment")) recipe.comment = comment->text();
  recipe.model = root.member("model").text();
  recipe.channels = root.member("channels").texts();
  recipe.parameters = read_parameters(root.member("parameters"));
  recipe.incidence_angles_deg = root.member("incidence_angles_deg").numbers();
  recipe.sample_rotations_deg = root.member("sample_rotations_deg").numbers();
  read_exitant_directions(root.member("exitant_directions"), recipe);
  if (const auto noise = root.find("noise")) recipe.noise = read_noise(*noise);
  if (const auto sigma = root.find("sigma_columns")) recipe.sigma_columns = sigma->flag();
  if (const auto quantity = root.find("quantity")) recipe.quantity = read_quantity(*quantity);
  if (const auto problem = find_problem(recipe)) {
    file.refuse(problem->pointer, problem->text);
  }
  return recipe;
}

}  // namespace

brdf::BoundModel bind(const Recipe& recipe) {
  std::vector<brdf::NamedValues> values;
  for (const auto& [name, value] : recipe.parameters) values.push_back({name, value});
  return {brdf::model_for(recipe.model, values), recipe.channels.size(), values};
}

std::optional<RecipeProblem> find_problem(const Recipe& recipe) {
  if (auto problem = material_problem(recipe)) return problem;
  if (auto problem = angles_problem("/incidence_angles_deg", recipe.incidence_angles_deg, 0,
                                    horizon_deg, "0 to less than 90")) {
    return problem;
  }
  if (auto problem = angles_problem("/sample_rotations_deg", recipe.sample_rotations_deg, -360, 360,
                                    "-360 to 360")) {
    return problem;
  }
  if (auto problem = directions_problem(recipe)) return problem;
  if (auto problem = noise_problem(recipe)) return problem;
  return size_problem(recipe);
}

Recipe read_recipe(const std::string& path) { return recipe_of(table::JsonFile::read(path)); }

Recipe parse_recipe(std::string_view json, const std::string& path) {
  return recipe_of(table::JsonFile::parse(json, path));
}

}  // namespace gonio::instrument
