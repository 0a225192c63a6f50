// gonio albedo: the share of the light that a material reflects, by the angle of incidence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "apps/gonio/command.h"
#include "apps/gonio/polar_angles.h"
#include "brdf/albedo.h"
#include "material/evaluate.h"
#include "material/material_json.h"

namespace gonio::app {
namespace {

using nlohmann::ordered_json;

struct AlbedoOptions {
  std::string material;
  std::string theta = "0,30,60,75,85,89";
  std::string phi = "0";
  std::string tolerance = fmt::format("{}", brdf::albedo_tolerance);
  bool json = false;
};

struct AlbedoRow {
  double theta_deg;
  brdf::Albedo albedo;
};

double parse_phi(std::string_view text) {
  const auto phi = parse_number(text);
  if (!phi || !std::isfinite(*phi)) {
    throw std::invalid_argument(
        fmt::format("--phi {}: expected an azimuth in degrees, one number such as 45", text));
  }
  return *phi;
}

double parse_tolerance(std::string_view text) {
  const auto tolerance = parse_number(text);
  if (!tolerance || !(*tolerance >= 1e-10 && *tolerance <= 0.1)) {
    throw std::invalid_argument(
        fmt::format("--tolerance {}: expected a relative error from 1e-10 to 0.1", text));
  }
  return *tolerance;
}

/// By more than the albedo may be wrong by: 1 itself may come out as 1 + 1e-9.
bool is_over_one(const brdf::Albedo& albedo, std::size_t channel) {
  return albedo.values[channel] - albedo.errors[channel] > 1;
}

std::vector<bool> over_one(const brdf::Albedo& albedo) {
  std::vector<bool> flags;
  for (std::size_t c = 0; c < albedo.values.size(); ++c) flags.push_back(is_over_one(albedo, c));
  return flags;
}

void print_table(const material::Material& material, const std::vector<AlbedoRow>& rows,
                 double phi_deg) {
  std::string text =
      fmt::format("{}, albedo of light from azimuth {} deg\n\n  theta", material.model, phi_deg);
  for (const std::string& channel : material.channels) text += fmt::format(" {:>11} ", channel);
  std::vector<double> angles_over;
  for (const AlbedoRow& row : rows) {
    text += fmt::format("\n{:>7}", row.theta_deg);
    const std::vector<bool> flags = over_one(row.albedo);
    for (std::size_t c = 0; c < flags.size(); ++c) {
      text += fmt::format(" {:>11.6g}{}", row.albedo.values[c], flags[c] ? '*' : ' ');
    }
    if (std::find(flags.begin(), flags.end(), true) != flags.end()) {
      angles_over.push_back(row.theta_deg);
    }
  }
  if (angles_over.empty()) {
    text += "\n\nAt none of these angles more light leaves than arrives.\n";
  } else {
    text += fmt::format(
        "\n\n* over 1: for light from {} deg more leaves than arrives, which no material does. Do "
        "not\n"
        "  render or simulate with the model at such angles.\n",
        fmt::join(angles_over, ", "));
  }
  print(text);
}

ordered_json json_of(const material::Material& material, const std::vector<AlbedoRow>& rows,
                     double phi_deg, double tolerance) {
  ordered_json angles = ordered_json::array();
  for (const AlbedoRow& row : rows) {
    angles.push_back({{"theta_deg", row.theta_deg},
                      {"albedo", row.albedo.values},
                      {"error", row.albedo.errors},
                      {"over_one", over_one(row.albedo)}});
  }
  return {{"material", material.name}, {"model", material.model},       {"phi_deg", phi_deg},
          {"tolerance", tolerance},    {"channels", material.channels}, {"angles", angles}};
}

/// Says where the integral is less precise than asked for; whether it is anywhere.
bool note_imprecision(const std::vector<AlbedoRow>& rows, double tolerance) {
  bool any = false;
  for (const AlbedoRow& row : rows) {
    double worst = 0;
    for (std::size_t c = 0; c < row.albedo.values.size(); ++c) {
      const double allowed = tolerance * std::abs(row.albedo.values[c]);
      if (row.albedo.errors[c] > allowed) {
        worst = std::max(worst, row.albedo.errors[c] / std::abs(row.albedo.values[c]));
      }
    }
    if (worst == 0) continue;
    any = true;
    print_note(fmt::format(
        "gonio: theta {} deg: the relative error may be {:.2g}, the tolerance asked for is {:g}",
        row.theta_deg, worst, tolerance));
  }
  return any;
}

void albedo(const AlbedoOptions& options, Invocation& invocation) {
  constexpr double radians_per_degree = std::numbers::pi / 180;
  const std::vector<double> angles = parse_polar_angles("--theta", options.theta);
  const double phi_deg = parse_phi(options.phi);
  const double tolerance = parse_tolerance(options.tolerance);
  const auto material = material::read_material(options.material);
  const brdf::BoundModel model = material::bind(material);
  std::vector<AlbedoRow> rows;
  for (const double theta_deg : angles) {
    rows.push_back({theta_deg, brdf::albedo(model, theta_deg * radians_per_degree,
                                            phi_deg * radians_per_degree, tolerance)});
  }
  if (options.json) {
    print_json(json_of(material, rows, phi_deg, tolerance));
  } else {
    print_table(material, rows, phi_deg);
  }
  if (note_imprecision(rows, tolerance)) invocation.exit_status = 1;
}

}  // namespace

void add_albedo_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<AlbedoOptions>();
  CLI::App* command = app.add_subcommand(
      "albedo", "The share of light that a material reflects, by angle; marked where it is over 1");
  command->add_option("MATERIAL", options->material, "The material (JSON)")->required();
  command
      ->add_option("--theta", options->theta,
                   "Polar angles of the light in degrees (default " + options->theta + ")")
      ->type_name("T,T,..");
  command->add_option("--phi", options->phi, "Azimuth of the light in degrees (default 0)")
      ->type_name("P");
  command
      ->add_option("--tolerance", options->tolerance,
                   "Relative error of the integral (default " + options->tolerance + ")")
      ->type_name("X");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &invocation] { albedo(*options, invocation); });
}

}  // namespace gonio::app
