#include "instrument/synthesize.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace gonio::instrument {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
// Readers take what is closer to the horizon than this for the horizon itself.
constexpr double horizon_margin_deg = 1e-6;

struct Angles {
  double theta_deg, phi_deg;
};

/// To a whole millionth of a degree: the double nearest to a short decimal number.
double rounded(double degrees) { return std::round(degrees * 1e6) / 1e6; }

/// Into [0, 360), rounded.
double azimuth(double degrees) {
  const double turned = rounded(std::fmod(degrees, 360));
  const double positive = turned < 0 ? rounded(turned + 360) : turned;
  return positive < 360 ? positive + 0.0 : 0.0;  // + 0.0: no negative zero
}

/// The multiples of `step` from `step` to `last`, inclusive to rounding.
std::vector<double> steps(double step, double last) {
  std::vector<double> values;
  const auto count = static_cast<std::size_t>(std::floor(last / step * (1 + 1e-12)));
  for (std::size_t k = 1; k <= count; ++k) values.push_back(static_cast<double>(k) * step);
  return values;
}

bool is_seen(const Recipe& recipe, const Angles& wo) {
  return wo.theta_deg <= recipe.theta_max_deg && wo.theta_deg < 90 - horizon_margin_deg;
}

void append_hemisphere(const Recipe& recipe, std::vector<Angles>& wo) {
  const double phi_step = recipe.hemisphere.phi_step_deg;
  const auto azimuths = static_cast<std::size_t>(std::ceil(360 / phi_step * (1 - 1e-12)));
  wo.push_back({0, 0});
  for (const double theta : steps(recipe.hemisphere.theta_step_deg, recipe.theta_max_deg)) {
    for (std::size_t k = 0; k < azimuths; ++k) {
      const Angles angles{rounded(theta), azimuth(static_cast<double>(k) * phi_step)};
      if (is_seen(recipe, angles)) wo.push_back(angles);
    }
  }
}

/// The direction at `radius` from the mirror direction s of a lamp at theta_i, azimuth 0. `around`
/// is the angle about s, from the plane of incidence on the side of the normal: with
/// s = (-sin, 0, cos), t = (cos, 0, sin) towards the normal and b = s x t = (0, 1, 0), it is
/// cos(radius) s + sin(radius) (cos(around) t + sin(around) b).
Angles about_mirror(double theta_i_deg, double radius, double around) {
  const double sin_i = std::sin(theta_i_deg / degrees_per_radian);
  const double cos_i = std::cos(theta_i_deg / degrees_per_radian);
  const double in_plane = std::sin(radius) * std::cos(around);
  const double x = in_plane * cos_i - std::cos(radius) * sin_i;
  const double y = std::sin(radius) * std::sin(around);
  const double z = in_plane * sin_i + std::cos(radius) * cos_i;
  return {rounded(std::atan2(std::hypot(x, y), z) * degrees_per_radian),
          azimuth(std::atan2(y, x) * degrees_per_radian)};
}

void append_mirror_patch(const Recipe& recipe, double theta_i_deg, std::vector<Angles>& wo) {
  const MirrorPatch& patch = *recipe.mirror_patch;
  const Angles mirror{rounded(theta_i_deg), 180};
  if (is_seen(recipe, mirror)) wo.push_back(mirror);
  for (const double radius : steps(patch.radius_step_deg, patch.radius_max_deg)) {
    for (std::uint32_t k = 0; k < patch.directions_per_ring; ++k) {
      const Angles angles = about_mirror(theta_i_deg, radius / degrees_per_radian,
                                         2 * std::numbers::pi * k / patch.directions_per_ring);
      if (is_seen(recipe, angles)) wo.push_back(angles);
    }
  }
}

/// What the camera sees for one position of the lamp, in the laboratory's frame.
std::vector<Angles> exitant_directions(const Recipe& recipe, double theta_i_deg) {
  std::vector<Angles> wo;
  append_hemisphere(recipe, wo);
  if (recipe.mirror_patch) append_mirror_patch(recipe, theta_i_deg, wo);
  return wo;
}

void append_sample(table::SampleTable& table, const Angles& wi, const Angles& wo) {
  table.wi.push_back(brdf::direction_from_degrees(wi.theta_deg, wi.phi_deg));
  table.wo.push_back(brdf::direction_from_degrees(wo.theta_deg, wo.phi_deg));
  table.angle_text.push_back(
      fmt::format("{},{},{},{}", wi.theta_deg, wi.phi_deg, wo.theta_deg, wo.phi_deg));
}

void append_directions(const Recipe& recipe, table::SampleTable& table) {
  for (const double theta_i : recipe.incidence_angles_deg) {
    const std::vector<Angles> seen = exitant_directions(recipe, theta_i);
    for (const double rotation : recipe.sample_rotations_deg) {
      const Angles wi{rounded(theta_i), azimuth(-rotation)};
      for (const Angles& wo : seen) {
        append_sample(table, wi, {wo.theta_deg, azimuth(wo.phi_deg - rotation)});
      }
    }
  }
}

/// Independent standard normal numbers, in pairs; see synthesize().
class NormalPairs {
 public:
  explicit NormalPairs(std::uint64_t seed) : generator_(seed) {}

  std::pair<double, double> next() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  /// In (0, 1), the ends excluded.
  double uniform() { return (static_cast<double>(generator_() >> 12) + 0.5) * 0x1p-52; }

  std::mt19937_64 generator_;
};

/// How many units of the recipe's quantity an f_r of 1/sr is.
double quantity_per_f_r(table::Quantity quantity, double cos_i) {
  switch (quantity) {
    case table::Quantity::brdf:
      return 1;
    case table::Quantity::brdf_cos:
      return cos_i;
    case table::Quantity::reflectance_factor:
      return std::numbers::pi;
  }
  return 1;
}

void measure(const Recipe& recipe, const brdf::BoundModel& model, table::SampleTable& table) {
  const std::size_t count = table.wi.size();
  table.values.assign(model.channel_count(), std::vector<double>(count));
  if (recipe.sigma_columns) table.sigma = table.values;
  NormalPairs normal(recipe.noise.seed);
  std::vector<double> f_r(model.channel_count());
  for (std::size_t i = 0; i < count; ++i) {
    model.f_r(table.wi[i], table.wo[i], f_r);
    const double floor = recipe.noise.floor / quantity_per_f_r(recipe.quantity, table.wi.z[i]);
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      const auto [e1, e2] = normal.next();
      table.values[c][i] = f_r[c] * (1 + recipe.noise.relative * e1) + floor * e2;
      if (recipe.sigma_columns) {
        table.sigma[c][i] = std::hypot(recipe.noise.relative * f_r[c], floor);
      }
    }
  }
}

}  // namespace

table::SampleTable synthesize(const Recipe& recipe) {
  if (const auto problem = find_problem(recipe)) {
    throw std::invalid_argument(
        fmt::format("recipe '{}': {}: {}", recipe.name, problem->pointer, problem->text));
  }
  table::SampleTable table;
  table.name = recipe.name;
  table.channels = recipe.channels;
  table.provenance.format = "virtual gonioreflectometer";
  table.provenance.quantity = recipe.quantity;
  append_directions(recipe, table);
  table.mask.assign(table.wi.size(), table::MaskReason::none);
  measure(recipe, bind(recipe), table);
  return table;
}

}  // namespace gonio::instrument
