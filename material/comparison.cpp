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

void add_directions(table::SampleTable& table, const Direction<double>& wi) {
  for (const auto& [wo, solid_angle] : brdf::lobe_directions(wi)) {
    table.wi.push_back(wi);
    table.wo.push_back(wo);
    table.weight.push_back(solid_angle);
  }
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

bool is_same_light(const table::SampleTable& table, std::size_t i, std::size_t j) {
  return table.wi.x[i] == table.wi.x[j] && table.wi.y[i] == table.wi.y[j] &&
         table.wi.z[i] == table.wi.z[j];
}

/// The signed difference of albedo that is largest, over the lights of the table.
double largest_albedo_difference(const table::SampleTable& table, std::span<const double> material,
                                 std::span<const double> stand_in) {
  double largest = 0;
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    sum += (stand_in[i] - material[i]) * table.wo.z[i] * table.weight[i];
    if (i + 1 < table.size() && is_same_light(table, i, i + 1)) continue;
    if (std::abs(sum) > std::abs(largest)) largest = sum;
    sum = 0;
  }
  return largest;
}

}  // namespace

Reflectance reflectance_of(const brdf::BoundModel& model) {
  return [&model](const Direction<double>& wi, const Direction<double>& wo,
                  std::span<double> values) { model.f_r(wi, wo, values); };
}

Incidence default_incidence(const brdf::Model& model) {
  Incidence incidence;
  if (model.is_anisotropic()) incidence.phi_deg = {0, 30, 60, 90};
  return incidence;
}

table::SampleTable sample(const Reflectance& reflectance, std::span<const std::string> channels,
                          const Incidence& incidence) {
  table::SampleTable table;
  table.channels.assign(channels.begin(), channels.end());
  for (const double theta_deg : incidence.theta_deg) {
    if (!(theta_deg >= 0 && theta_deg < 90)) {
      throw std::invalid_argument(
          fmt::format("an incidence angle of {} degrees: expected 0 to less than 90", theta_deg));
    }
    for (const double phi_deg : incidence.phi_deg) {
      add_directions(table, brdf::direction_from_degrees(theta_deg, phi_deg));
    }
  }
  table.mask.assign(table.wi.size(), table::MaskReason::none);
  table.values = values_on(table, reflectance);
  return table;
}

Difference difference(const table::SampleTable& material, const Reflectance& stand_in) {
  const auto values = values_on(material, stand_in);
  const table::SampleFilter is_compared(material, largest_compared_theta_deg);
  Difference result;
  double squared_difference = 0;
  double squared_radiance = 0;
  for (std::size_t c = 0; c < material.channels.size(); ++c) {
    double brightest = 0;
    double worst = 0;
    std::size_t worst_sample = 0;
    for (std::size_t i = 0; i < material.size(); ++i) {
      if (!is_compared(i)) continue;
      const double radiance = material.values[c][i] * material.wi.z[i];
      const double apart = std::abs(values[c][i] * material.wi.z[i] - radiance);
      brightest = std::max(brightest, radiance);
      if (apart > worst) {
        worst = apart;
        worst_sample = i;
      }
      squared_difference += apart * apart * material.weight[i];
      squared_radiance += radiance * radiance * material.weight[i];
    }
    if (share(worst, brightest) > result.peak) {
      result.peak = share(worst, brightest);
      result.where = {degrees_of(material.wi.z[worst_sample]),
                      degrees_of(material.wo.z[worst_sample]), material.channels[c]};
    }
    const double albedo = largest_albedo_difference(material, material.values[c], values[c]);
    if (std::abs(albedo) > std::abs(result.albedo)) result.albedo = albedo;
  }
  result.rms = std::sqrt(share(squared_difference, squared_radiance));
  return result;
}

}  // namespace gonio::material
