// gonio eval: a material's f_r for one pair of directions, or for every row of a table.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "apps/gonio/command.h"
#include "apps/gonio/progress.h"
#include "apps/gonio/table_options.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/file_error.h"
#include "table/formats/gonio_csv.h"
#include "table/read.h"

namespace gonio::app {
namespace {

struct EvalOptions {
  std::string material;
  std::string wi, wo;
  std::string table;
  TableOptions reading;
  bool json = false;
};

struct Angles {
  double theta_deg, phi_deg;
};

Angles parse_angles(std::string_view option, std::string_view text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto theta = parse_number(text.substr(0, comma));
  const auto phi = parse_number(text.substr(std::min(comma + 1, text.size())));
  if (!theta || !phi || !std::isfinite(*phi)) {
    throw std::invalid_argument(fmt::format(
        "{} {}: expected THETA,PHI in degrees, two numbers such as 30,180", option, text));
  }
  if (!(*theta >= 0 && *theta <= 90)) {
    throw std::invalid_argument(fmt::format(
        "{} {}: theta is {} degrees, expected 0 to 90, measured from the surface normal", option,
        text, *theta));
  }
  return {*theta, *phi};
}

brdf::Direction<double> direction_of(const Angles& angles) {
  auto direction = brdf::direction_from_degrees(angles.theta_deg, angles.phi_deg);
  if (angles.theta_deg == 90) direction.z = 0;  // exactly the horizon, where every f_r is 0
  return direction;
}

nlohmann::ordered_json json_of(const Angles& angles) {
  return {{"theta_deg", angles.theta_deg}, {"phi_deg", angles.phi_deg}};
}

void eval_directions(const EvalOptions& options) {
  const Angles wi = parse_angles("--wi", options.wi);
  const Angles wo = parse_angles("--wo", options.wo);
  const auto material = material::read_material(options.material);
  std::vector<double> f_r(material.channels.size());
  material::bind(material).f_r(direction_of(wi), direction_of(wo), f_r);
  if (options.json) {
    print_json({{"material", material.name},
                {"model", material.model},
                {"wi", json_of(wi)},
                {"wo", json_of(wo)},
                {"channels", material.channels},
                {"unit", "1/sr"},
                {"f_r", f_r}});
    return;
  }
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    print(fmt::format("{} {}\n", material.channels[c], f_r[c]));
  }
}

/// Throws if the table could not be told from what is added to it.
void refuse_name_clash(const EvalOptions& options, const table::SampleTable& table,
                       const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::find(table.channels.begin(), table.channels.end(), name) == table.channels.end()) {
      continue;
    }
    throw table::FileError(fmt::format(
        "{}: the table has a channel '{}' already, which is what the model's column of {} is to "
        "be called: rename the channel in one of the two files",
        options.table, name, options.material));
  }
}

void eval_table(const EvalOptions& options) {
  const auto material = material::read_material(options.material);
  const auto table = [&] {
    const ProgressLine progress("reading " + options.table);
    return read_table(options.table, options.reading, {.keep_angle_text = true});
  }();
  std::vector<std::string> names;
  for (const std::string& channel : material.channels) names.push_back(channel + "_model");
  refuse_name_clash(options, table, names);
  const auto f_r = material::evaluate(material, table);
  if (options.json) {
    print_json({{"material", material.name},
                {"model", material.model},
                {"table", options.table},
                {"channels", material.channels},
                {"unit", "1/sr"},
                {"f_r", f_r}});
    return;
  }
  std::vector<table::ExtraColumn> columns;
  for (std::size_t c = 0; c < f_r.size(); ++c) columns.push_back({names[c], f_r[c]});
  for (const std::string& note : table.notes) {
    print_note(fmt::format("{}: {}", options.table, note));
  }
  table::write_gonio_csv(table, columns, print);
}

void eval(const EvalOptions& options) {
  const bool has_directions = !options.wi.empty() || !options.wo.empty();
  if (has_directions == !options.table.empty()) {
    throw std::invalid_argument(
        "eval: expected either --wi THETA,PHI and --wo THETA,PHI, or --table TABLE");
  }
  if (!has_directions) return eval_table(options);
  if (options.wi.empty() || options.wo.empty()) {
    throw std::invalid_argument(fmt::format("eval: {} is missing: give it as THETA,PHI in degrees",
                                            options.wi.empty() ? "--wi" : "--wo"));
  }
  eval_directions(options);
}

}  // namespace

void add_eval_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* command =
      app.add_subcommand("eval", "Evaluate a material: f_r in 1/sr, channel by channel");
  command->add_option("MATERIAL", options->material, "The material (JSON)")->required();
  command
      ->add_option("--wi", options->wi,
                   "The direction to the light in degrees: polar angle, azimuth")
      ->type_name("THETA,PHI");
  command
      ->add_option("--wo", options->wo,
                   "The direction to the viewer in degrees: polar angle, azimuth")
      ->type_name("THETA,PHI");
  command
      ->add_option("--table", options->table,
                   "Evaluate every row: the table as CSV, with columns <channel>_model")
      ->type_name("TABLE");
  command->add_flag("--json", options->json, "Print the result as JSON");
  add_table_options(*command, options->reading);
  command->callback([options] { eval(*options); });
}

}  // namespace gonio::app
