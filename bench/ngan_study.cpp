#include "bench/ngan_study.h"

#include <algorithm>
#include <cmath>

#include "bench/scaled_fresnel.h"
#include "fit/fit.h"

namespace gonio::bench {
namespace {

table::SampleTable weighted_by_solid_angle(table::SampleTable table) {
  table.weight.resize(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.weight[i] = std::hypot(table.wo.x[i], table.wo.y[i]);
  }
  return table;
}

double least(const Ranked& material) { return *material.errors[order_of(material.errors).front()]; }

}  // namespace

Ranked rank(const table::SampleTable& table, const View& view, double max_theta_deg, int threads) {
  const table::SampleTable weighted =
      view.solid_angle ? weighted_by_solid_angle(table) : table::SampleTable{};
  const table::SampleTable& samples = view.solid_angle ? weighted : table;
  Ranked result;
  result.material = table.name;
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    if (c == ngan_form) {
      if (view.metric != fit::Metric::cosine_l2) continue;
      result.errors[c] = fit_scaled_fresnel(samples, max_theta_deg).error;
      continue;
    }
    const fit::FitResult fit =
        fit::fit(brdf::Model(std::string(contenders[c].name)), samples,
                 {.metric = view.metric, .max_theta_deg = max_theta_deg, .threads = threads});
    result.errors[c] = fit.metric_error;
    result.used = fit.used;
    result.all_converged = result.all_converged && fit.converged;
  }
  return result;
}

std::vector<std::size_t> order_of(
    std::span<const std::optional<double>, contenders.size()> errors) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (errors[c]) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return *errors[a] < *errors[b]; });
  return order;
}

RankingTally tally_ranking(std::span<const Ranked> materials, std::size_t form) {
  RankingTally tally;
  for (const Ranked& material : materials) {
    const auto& errors = material.errors;
    const bool first = errors[form] && *errors[form] < *errors[ward_duer];
    const bool second = *errors[ward_duer] < *errors[ward];
    const bool third = *errors[ward] < *errors[blinn_phong];
    tally.before_ward_duer += first ? 1 : 0;
    tally.ward_duer_before_ward += second ? 1 : 0;
    tally.ward_before_blinn_phong += third ? 1 : 0;
    tally.all += first && second && third ? 1 : 0;
  }
  return tally;
}

std::array<std::optional<double>, contenders.size()> pooled_errors(
    std::span<const Ranked> materials) {
  std::array<std::optional<double>, contenders.size()> pooled;
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    if (!materials.front().errors[c]) continue;
    double sum = 0;
    for (const Ranked& material : materials) {
      sum += std::log(*material.errors[c] / least(material));
    }
    pooled[c] = std::exp(sum / double(materials.size()));
  }
  return pooled;
}

}  // namespace gonio::bench
