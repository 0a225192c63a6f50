#include "table/describe.h"

#include <fmt/core.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>

#include "table/projected_disc.h"

namespace gonio::table {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr std::size_t most_listed_incidences = 24;
constexpr double bin_deg = 15;
// Below this coverage the mean over the disc says nothing about the rest of it: a scan within the
// plane of incidence covers 2 of 12 sectors.
constexpr double least_coverage_for_albedo = 0.25;
constexpr double implausibly_small_albedo = 1e-3;
// Only where no albedo can be estimated, and a median stands for it.
constexpr double implausibly_large_albedo = 1.5;
constexpr double conspicuous_negative_share = 0.05;
constexpr double conspicuous_reciprocity_error = 0.3;

double polar_angle_deg(const brdf::Direction<double>& d) {
  return std::atan2(std::hypot(d.x, d.y), d.z) * degrees_per_radian;
}

/// To 1e-9 deg, so that an angle that was written as 20 is shown as 20.
double without_rounding_noise(double angle_deg) { return std::round(angle_deg * 1e9) / 1e9; }

void widen(Range& range, double value, bool first) {
  range.minimum = first ? value : std::min(range.minimum, value);
  range.maximum = first ? value : std::max(range.maximum, value);
}

std::vector<std::uint32_t> used_samples(const SampleTable& table) {
  std::vector<std::uint32_t> used;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] == MaskReason::none) used.push_back(static_cast<std::uint32_t>(i));
  }
  return used;
}

ChannelSummary summarise_channel(const std::string& name, const std::vector<double>& values,
                                 const std::vector<std::uint32_t>& used) {
  ChannelSummary summary{.name = name};
  for (const std::uint32_t i : used) {
    if (std::isnan(values[i])) {
      ++summary.holes;
      continue;
    }
    widen(summary.value, values[i], summary.measured == 0);
    if (values[i] < 0) ++summary.negative;
    ++summary.measured;
  }
  return summary;
}

/// The used samples by incidence: by angle to 0.1 deg, or by bin if there are too many angles.
struct IncidenceGroups {
  bool binned = false;
  std::map<long, std::vector<std::uint32_t>> samples{};
};

IncidenceGroups group_by_incidence(const std::vector<std::uint32_t>& used,
                                   const std::vector<double>& theta_i_deg) {
  std::set<long> angles;
  for (const double theta : theta_i_deg) {
    if (angles.size() <= most_listed_incidences) angles.insert(std::lround(theta * 10));
  }
  IncidenceGroups groups{.binned = angles.size() > most_listed_incidences};
  for (std::size_t k = 0; k < used.size(); ++k) {
    const long group = groups.binned ? static_cast<long>(std::min(theta_i_deg[k], 89.9) / bin_deg)
                                     : std::lround(theta_i_deg[k] * 10);
    groups.samples[group].push_back(used[k]);
  }
  return groups;
}

/// wo from above, turned so that wi lies over the positive x axis.
DiscPoint relative_to_incidence(const brdf::Direction<double>& wi,
                                const brdf::Direction<double>& wo) {
  const double sin_i = std::hypot(wi.x, wi.y);
  if (sin_i == 0) return {wo.x, wo.y};
  return {(wo.x * wi.x + wo.y * wi.y) / sin_i, (wo.y * wi.x - wo.x * wi.y) / sin_i};
}

std::size_t incidence_azimuths(const SampleTable& table,
                               const std::vector<std::uint32_t>& samples) {
  std::bitset<360> seen;
  for (const std::uint32_t i : samples) {
    const brdf::Direction<double> wi = table.wi[i];
    const double degrees = wi.x == 0 && wi.y == 0 ? 0 : std::atan2(wi.y, wi.x) * degrees_per_radian;
    seen.set(static_cast<std::size_t>(std::lround(degrees) + 360) % 360);
  }
  return seen.count();
}

/// The mean of a channel over the projected disc, by the solid angles that the samples stand for.
double weighted_mean(const SampleTable& table, const std::vector<double>& values,
                     const std::vector<std::uint32_t>& samples) {
  double sum = 0;
  double weights = 0;
  for (const std::uint32_t i : samples) {
    if (std::isnan(values[i])) continue;
    const double weight = table.weight[i] * table.wo.z[i];
    sum += weight * values[i];
    weights += weight;
  }
  return sum / weights;  // NaN of nothing
}

IncidenceSummary summarise_incidence(const SampleTable& table, double theta_deg,
                                     const std::vector<std::uint32_t>& samples) {
  IncidenceSummary summary{.theta_deg = theta_deg,
                           .samples = samples.size(),
                           .azimuths = incidence_azimuths(table, samples)};
  std::vector<DiscPoint> points;
  points.reserve(samples.size());
  for (const std::uint32_t i : samples) {
    points.push_back(relative_to_incidence(table.wi[i], table.wo[i]));
  }
  const std::size_t measured_points = points.size();
  // What is measured on one side of the plane of incidence, an isotropic material has on the other.
  for (std::size_t k = 0; table.takes_isotropy && k < measured_points; ++k) {
    points.push_back({points[k].x, -points[k].y});
  }
  const DiscCoverage coverage(points);
  points.resize(measured_points);
  summary.cells = coverage.cells();
  summary.coverage = coverage.share();
  if (summary.coverage < least_coverage_for_albedo) return summary;

  const DiscAverage average(points);
  for (const std::vector<double>& channel : table.values) {
    const double mean = table.weight_is_solid_angle ? weighted_mean(table, channel, samples)
                                                    : average.mean(channel, samples);
    summary.albedo.push_back(std::isnan(mean) ? std::nullopt
                                              : std::optional(std::numbers::pi * mean));
  }
  return summary;
}

HalfVectorCoverage half_vector_coverage(const SampleTable& table,
                                        const std::vector<std::uint32_t>& used) {
  constexpr std::size_t fewest_samples = 10;
  // A half vector closer than this to the normal leans nowhere: it says as much about one
  // roughness as about the other.
  constexpr double least_slope = 0.02;
  const double tan_30 = std::numbers::inv_sqrt3;
  HalfVectorCoverage coverage;
  for (const std::uint32_t i : used) {
    const brdf::Direction<double> h = brdf::half_vector(table.wi[i], table.wo[i]);
    const double slope_x = std::abs(h.x);
    const double slope_y = std::abs(h.y);
    if (std::max(slope_x, slope_y) < least_slope * h.z) continue;
    if (slope_y <= tan_30 * slope_x) ++coverage.along_x;
    if (slope_x <= tan_30 * slope_y) ++coverage.along_y;
  }
  const std::size_t fewest = std::max(fewest_samples, used.size() / 100);
  coverage.both = coverage.along_x >= fewest && coverage.along_y >= fewest;
  return coverage;
}

void warn_of_negative_values(Description& d) {
  for (const ChannelSummary& channel : d.channels) {
    const double share =
        static_cast<double>(channel.negative) / static_cast<double>(channel.measured);
    if (channel.measured > 0 && share > conspicuous_negative_share) {
      d.warnings.push_back(
          fmt::format("{:.1f} % of the values of channel {} are negative: more than noise would "
                      "explain",
                      100 * share, channel.name));
    }
  }
}

/// The median of a channel's measured values; nothing if there are none.
std::optional<double> median_value(const std::vector<double>& values,
                                   const std::vector<std::uint32_t>& used) {
  std::vector<double> measured;
  for (const std::uint32_t i : used) {
    if (!std::isnan(values[i])) measured.push_back(values[i]);
  }
  if (measured.empty()) return std::nullopt;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::nth_element(measured.begin(), middle, measured.end());
  return *middle;
}

/// Where no incidence is covered enough for an albedo: what one would be if every direction were
/// like the brightest, and like the middle one.
void warn_of_implausible_values(const SampleTable& table, const std::vector<std::uint32_t>& used,
                                Description& d) {
  double brightest = 0;
  for (const ChannelSummary& channel : d.channels) {
    brightest = std::max(brightest, std::numbers::pi * channel.value.maximum);
  }
  if (d.used > 0 && brightest < implausibly_small_albedo) {
    d.warnings.push_back(fmt::format(
        "were every direction as bright as the brightest, no channel would reflect more than "
        "{:.2g} of the light: implausibly small; is the quantity, or its unit, what the file says?",
        brightest));
  }
  for (std::size_t c = 0; c < table.channels.size(); ++c) {
    const auto median = median_value(table.values[c], used);
    if (!median || std::numbers::pi * *median <= implausibly_large_albedo) continue;
    d.warnings.push_back(
        fmt::format("were every direction as bright as the middle one, channel {} would reflect "
                    "{:.2f} times the light that arrives: implausibly large; is the quantity, or "
                    "its unit, what the file says?",
                    table.channels[c], std::numbers::pi * *median));
    return;
  }
}

void warn_of_implausible_albedo(Description& d) {
  struct Extreme {
    double albedo = 0, theta_deg = 0;
    std::size_t channel = 0;
  };
  std::optional<Extreme> highest;
  for (const IncidenceSummary& incidence : d.incidences) {
    for (std::size_t c = 0; c < incidence.albedo.size(); ++c) {
      const std::optional<double> albedo = incidence.albedo[c];
      if (albedo && (!highest || *albedo > highest->albedo)) {
        highest = Extreme{*albedo, incidence.theta_deg, c};
      }
    }
  }
  if (!highest) return;
  if (highest->albedo > 1) {
    d.warnings.push_back(fmt::format(
        "channel {} reflects {:.2f} times the light that arrives at {:g} deg, by estimate: more "
        "than 1 is not possible; is the quantity what the file says?",
        d.channels[highest->channel].name, highest->albedo, highest->theta_deg));
  }
  if (highest->albedo <= 0) {
    d.warnings.emplace_back(
        "no channel reflects any light, by estimate; are the values what the file says?");
  } else if (highest->albedo < implausibly_small_albedo) {
    d.warnings.push_back(fmt::format(
        "no channel reflects more than {:.2g} of the light, by estimate: implausibly small; is "
        "the quantity, or its unit, what the file says?",
        highest->albedo));
  }
}

void warn_of_broken_reciprocity(Description& d) {
  if (!d.reciprocity || d.reciprocity->rms_relative <= conspicuous_reciprocity_error) return;
  d.warnings.push_back(fmt::format(
      "swapping light and viewer changes the value by {:.0f} % (RMS): a cosine too many or too "
      "few in the values, or light and viewer in the wrong columns?",
      100 * d.reciprocity->rms_relative));
}

}  // namespace

Description describe(const SampleTable& table) {
  Description d;
  d.samples = table.size();
  for (const MaskReason reason : table.mask) ++d.masked[static_cast<std::size_t>(reason)];
  d.used = d.masked[static_cast<std::size_t>(MaskReason::none)];
  d.masked[static_cast<std::size_t>(MaskReason::none)] = 0;

  const std::vector<std::uint32_t> used = used_samples(table);
  std::vector<double> theta_i_deg;
  theta_i_deg.reserve(used.size());
  for (const std::uint32_t i : used) {
    const bool first = theta_i_deg.empty();
    theta_i_deg.push_back(without_rounding_noise(polar_angle_deg(table.wi[i])));
    widen(d.theta_i_deg, theta_i_deg.back(), first);
    widen(d.theta_o_deg, without_rounding_noise(polar_angle_deg(table.wo[i])), first);
  }
  for (std::size_t c = 0; c < table.channels.size(); ++c) {
    d.channels.push_back(summarise_channel(table.channels[c], table.values[c], used));
  }

  const IncidenceGroups groups = group_by_incidence(used, theta_i_deg);
  d.incidence_binned = groups.binned;
  for (const auto& [group, samples] : groups.samples) {
    const double theta = groups.binned ? (static_cast<double>(group) + 0.5) * bin_deg
                                       : static_cast<double>(group) / 10;
    d.incidences.push_back(summarise_incidence(table, theta, samples));
  }
  d.reciprocity = reciprocity_of(table);
  d.half_vectors = half_vector_coverage(table, used);

  if (d.used == 0) d.warnings.emplace_back("every sample is masked: there is nothing to fit");
  warn_of_negative_values(d);
  const bool has_albedo =
      std::any_of(d.incidences.begin(), d.incidences.end(),
                  [](const IncidenceSummary& incidence) { return !incidence.albedo.empty(); });
  if (has_albedo) {
    warn_of_implausible_albedo(d);
  } else {
    warn_of_implausible_values(table, used, d);
  }
  warn_of_broken_reciprocity(d);
  return d;
}

}  // namespace gonio::table
