#include "material/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "brdf/lobe_directions.h"

namespace gonio::material {
namespace {

using brdf::Direction;

void add_sample(table::SampleTable& table, const Direction<double>& wi, const Direction<double>& wo,
                double weight) {
  table.wi.push_back(wi);
  table.wo.push_back(wo);
  table.weight.push_back(weight);
}

/// The viewers at the largest angle that is compared: there wide lobes differ most. They stand for
/// no solid angle; a weight of 0 would leave them out.
void add_rim(table::SampleTable& table, const Direction<double>& wi, bool both_sides) {
  constexpr double no_weight = 1e-12;
  const double plane_of_incidence = std::atan2(wi.y, wi.x) * (180 / std::numbers::pi);
  for (int degrees = 0; degrees < (both_sides ? 360 : 181); degrees += 5) {
    add_sample(
        table, wi,
        brdf::direction_from_degrees(largest_compared_theta_deg, plane_of_incidence + degrees),
        no_weight);
  }
}

void add_directions(table::SampleTable& table, const Direction<double>& wi, bool both_sides) {
  for (const auto& [wo, solid_angle] : brdf::lobe_directions(wi, {.one_side = !both_sides})) {
    add_sample(table, wi, wo, solid_angle);
  }
  add_rim(table, wi, both_sides);
}

/// f_r at every sample of the table, [channel][sample].
std::vector<std::vector<double>> values_on(const table::SampleTable& table,
                                           const Reflectance& reflectance) {
  std::vector<std::vector<double>> values(table.channels.size(),
                                          std::vector<double>(table.wi.size()));
  std::vector<double> f_r(table.channels.size());
  for (std::size_t i = 0; i < table.wi.size(); ++i) {
    reflectance(table.wi[i], table.wo[i], f_r);
    for (std::size_t c = 0; c < f_r.size(); ++c) values[c][i] = f_r[c];
  }
  return values;
}

double degrees_of(double cosine) {
  return std::acos(std::min(cosine, 1.0)) * (180 / std::numbers::pi);
}

/// part / whole, where 0 of nothing is 0.
double share(double part, double whole) {
  if (part == 0) return 0;
  return whole > 0 ? part / whole : std::numeric_limits<double>::infinity();
}

/// True where the samples of another light begin: with its mirror direction, as add_directions()
/// has them.
bool begins_a_light(const table::SampleTable& table, std::size_t i) {
  return table.wo.x[i] == -table.wi.x[i] && table.wo.y[i] == -table.wi.y[i] &&
         table.wo.z[i] == table.wi.z[i];
}

/// The signed difference of albedo that is largest, over the lights of the table.
double largest_albedo_difference(const table::SampleTable& table, std::span<const double> material,
                                 std::span<const double> stand_in) {
  double largest = 0;
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    sum += (stand_in[i] - material[i]) * table.wo.z[i] * table.weight[i];
    if (i + 1 < table.size() && !begins_a_light(table, i + 1)) continue;
    if (std::abs(sum) > std::abs(largest)) largest = sum;
    sum = 0;
  }
  return largest;
}

double brightest_radiance(const table::SampleTable& material,
                          const table::SampleFilter& is_compared) {
  double brightest = 0;
  for (const std::vector<double>& channel : material.values) {
    for (std::size_t i = 0; i < material.size(); ++i) {
      if (is_compared(i)) brightest = std::max(brightest, channel[i] * material.wi.z[i]);
    }
  }
  return brightest;
}

/// Of the lobe along x and along y, from its two shape parameters there: roughness, or exponents,
/// whose roots are the inverse of a width.
double ratio_of_widths(const brdf::Parameter& along_x, double x, double y) {
  if (along_x.scale == brdf::Scale::logarithmic) return x / y;
  return std::sqrt((1 + y) / (1 + x));
}

}  // namespace

Reflectance reflectance_of(const brdf::BoundModel& model) {
  return [&model](const Direction<double>& wi, const Direction<double>& wo,
                  std::span<double> values) { model.f_r(wi, wo, values); };
}

Incidence default_incidence(const brdf::Model& model) {
  Incidence incidence;
  if (model.is_anisotropic()) {
    incidence.phi_deg = {0, 30, 60, 90};
    incidence.both_sides = true;
  }
  return incidence;
}

table::SampleTable sample(const Reflectance& reflectance, std::span<const std::string> channels,
                          const Incidence& incidence) {
  table::SampleTable table;
  table.channels.assign(channels.begin(), channels.end());
  for (const double theta_deg : incidence.theta_deg) {
    if (!(theta_deg >= 0 && theta_deg <= largest_compared_theta_deg)) {
      throw std::invalid_argument(fmt::format("light from {} degrees: expected 0 to {:g}",
                                              theta_deg, largest_compared_theta_deg));
    }
    for (const double phi_deg : incidence.phi_deg) {
      add_directions(table, brdf::direction_from_degrees(theta_deg, phi_deg), incidence.both_sides);
    }
  }
  table.mask.assign(table.wi.size(), table::MaskReason::none);
  table.values = values_on(table, reflectance);
  return table;
}

Difference difference(const table::SampleTable& material, const Reflectance& stand_in) {
  const auto values = values_on(material, stand_in);
  const table::SampleFilter is_compared(material, largest_compared_theta_deg);
  const double brightest = brightest_radiance(material, is_compared);
  // Of the brightest: the squares of huge or tiny radiances would leave the numbers.
  const double scale = brightest > 0 ? brightest : 1;
  Difference result;
  double worst = 0;
  double squared_difference = 0;
  double squared_radiance = 0;
  for (std::size_t c = 0; c < material.channels.size(); ++c) {
    for (std::size_t i = 0; i < material.size(); ++i) {
      if (!is_compared(i)) continue;
      const double radiance = material.values[c][i] * material.wi.z[i] / scale;
      const double apart = std::abs(values[c][i] * material.wi.z[i] / scale - radiance);
      if (apart > worst) {
        worst = apart;
        result.where = {degrees_of(material.wi.z[i]), degrees_of(material.wo.z[i]),
                        material.channels[c]};
      }
      squared_difference += apart * apart * material.weight[i];
      squared_radiance += radiance * radiance * material.weight[i];
    }
    const double albedo = largest_albedo_difference(material, material.values[c], values[c]);
    if (std::abs(albedo) > std::abs(result.albedo)) result.albedo = albedo;
  }
  result.peak = share(worst, brightest / scale);
  result.rms = std::sqrt(share(squared_difference, squared_radiance));
  return result;
}

double largest_anisotropy(const brdf::BoundModel& model) {
  double largest = 1;
  const auto terms = model.model().terms();
  const auto names = model.model().shape();
  for (std::size_t p = 0; p + 1 < names.size(); ++p) {
    const bool is_first_of_term = p == 0 || names[p - 1].term != names[p].term;
    if (!is_first_of_term || !terms[names[p].term]->description.anisotropic) continue;
    const double ratio =
        ratio_of_widths(names[p].descriptor, model.shape()[p], model.shape()[p + 1]);
    largest = std::max({largest, ratio, 1 / ratio});
  }
  return largest;
}

}  // namespace gonio::material
