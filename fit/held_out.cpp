#include "fit/held_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "table/file_error.h"

namespace gonio::fit {
namespace {

constexpr std::size_t most_folds = 5;
/// Angles closer than this are one.
constexpr double angle_step_deg = 0.01;

struct Band {
  double lower_deg, upper_deg;    // of what is held out, up to below the upper
  double least_deg, largest_deg;  // of the samples
};

/// How many used samples there are at each incidence angle, in steps of angle_step_deg. Steps begin
/// off the round angles that instruments stand at.
std::vector<std::size_t> count_by_angle(const table::SampleTable& table,
                                        const table::SampleFilter& filter) {
  std::vector<std::size_t> counts(std::size_t(90 / angle_step_deg) + 2);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!filter(i)) continue;
    const double theta = std::acos(std::min(table.wi.z[i], 1.0)) * 180 / std::numbers::pi;
    ++counts[std::size_t(theta / angle_step_deg + 0.25)];
  }
  return counts;
}

std::vector<Band> bands_of(const std::vector<std::size_t>& counts) {
  std::vector<std::size_t> angles;
  std::size_t total = 0;
  for (std::size_t a = 0; a < counts.size(); ++a) {
    if (counts[a] > 0) angles.push_back(a);
    total += counts[a];
  }
  const std::size_t folds = std::min(most_folds, angles.size());
  const auto degrees = [](std::size_t angle) { return double(angle) * angle_step_deg; };
  std::vector<Band> bands;
  std::size_t sum = 0;
  std::size_t first = 0;
  for (std::size_t a = 0; a < angles.size() && folds > 1; ++a) {
    sum += counts[angles[a]];
    const std::size_t wanted = folds - bands.size() - 1;  // bands after this one
    const std::size_t left = angles.size() - a - 1;
    const bool is_full = sum * folds >= total * (bands.size() + 1);
    if (left > 0 && left > wanted && !is_full) continue;
    if (wanted == 0 && left > 0) continue;
    const double lower = first == 0 ? 0 : (degrees(angles[first - 1]) + degrees(angles[first])) / 2;
    const double upper = left == 0 ? 90 : (degrees(angles[a]) + degrees(angles[a + 1])) / 2;
    bands.push_back({lower, upper, degrees(angles[first]), degrees(angles[a])});
    first = a + 1;
  }
  return bands;
}

/// What the fit to the others says of a band.
Assessment assess_band(const FitResult& result, const table::SampleTable& table,
                       const Options& options, const Band& band, std::span<const double> floors) {
  Options without = options;
  without.incidence = table::IncidenceBand{band.lower_deg, band.upper_deg, false};
  without.progress = nullptr;
  if (result.loss != Loss::none) without.loss_scale = result.loss_scale;
  const FitResult others = fit(result.model, table, without);

  Options within = without;
  within.incidence->inside = true;
  const BatchModel batch(result.model);
  const WeightedSamples samples(
      table, batch, within,
      survey_of(table, table::SampleFilter(table, within.max_theta_deg, within.incidence),
                options.threads),
      floors, &others.values);
  return assess(samples, batch, others.values, others.unknowns, floors,
                {.loss = {result.loss, result.loss == Loss::none ? 1 : result.loss_scale}},
                {.threads = options.threads, .on_pass = {}});
}

}  // namespace

std::optional<HeldOut> held_out_errors(const FitResult& result, const table::SampleTable& table,
                                       const Options& options) {
  const table::SampleFilter filter(table, options.max_theta_deg, options.incidence);
  const std::vector<Band> bands = bands_of(count_by_angle(table, filter));
  if (bands.empty()) return std::nullopt;
  const std::vector<double> floors = relative_floors(table, filter, options.threads);

  HeldOut held_out;
  held_out.errors = result.errors;
  std::vector<double> squares(result.errors.size());
  double weight = 0;
  double metric_square = 0;
  double metric_weight = 0;
  for (const Band& band : bands) {
    Assessment assessment;
    try {
      assessment = assess_band(result, table, options, band, floors);
    } catch (const table::FileError&) {
      return std::nullopt;  // without the band too few samples are left
    }
    for (std::size_t m = 0; m < squares.size(); ++m) {
      squares[m] += assessment.weight * std::pow(assessment.errors[m].second, 2);
    }
    weight += assessment.weight;
    metric_square += assessment.metric_weight * std::pow(assessment.metric_error, 2);
    metric_weight += assessment.metric_weight;
    held_out.folds.push_back(
        {band.least_deg, band.largest_deg, assessment.values, assessment.metric_error});
  }
  const auto root = [](double square, double sum) { return sum > 0 ? std::sqrt(square / sum) : 0; };
  for (std::size_t m = 0; m < squares.size(); ++m) {
    held_out.errors[m].second = root(squares[m], weight);
  }
  held_out.metric_error = root(metric_square, metric_weight);
  return held_out;
}

}  // namespace gonio::fit
