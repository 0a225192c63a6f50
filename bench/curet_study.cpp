#include "bench/curet_study.h"

#include <cmath>

#include "fit/fit.h"
#include "table/parallel.h"

namespace gonio::bench {
namespace {

/// Errors closer than this are the same: each is a root of a sum of squares, rounded.
constexpr double rounding = 1e-12;

RoughFit fit_of(const fit::FitResult& result) {
  RoughFit fit;
  fit.error = result.metric_error;
  fit.converged = result.converged;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    if (result.unknowns[u].parameter != "sigma") continue;
    fit.sigma = result.values[result.unknowns[u]];
    fit.sigma_stddev = result.uncertainty.stddev[u];
  }
  return fit;
}

RoughMaterial study_material(const table::SampleTable& table, const fit::Options& options) {
  RoughMaterial material;
  material.name = table.name;
  for (std::size_t m = 0; m < rough_models.size(); ++m) {
    const fit::FitResult result =
        fit::fit(brdf::Model(std::string(rough_models[m])), table, options);
    material.used = result.used;
    material.fits[m] = fit_of(result);
  }
  return material;
}

}  // namespace

std::vector<RoughMaterial> study_roughness(std::span<const table::SampleTable> tables,
                                           fit::Metric metric, double max_theta_deg, int threads) {
  std::vector<RoughMaterial> materials(tables.size());
  table::parallel_for(tables.size(), threads, [&](std::size_t i) {
    materials[i] =
        study_material(tables[i], {.metric = metric, .max_theta_deg = max_theta_deg, .threads = 1});
  });
  return materials;
}

Tally tally(std::span<const RoughMaterial> materials, std::size_t model, std::size_t reference) {
  Tally result;
  for (const RoughMaterial& material : materials) {
    const double error = material.fits[model].error;
    const double other = material.fits[reference].error;
    const bool is_better = error < other * (1 - rounding);
    const bool is_worse = error > other * (1 + rounding);
    ++(is_better ? result.better : is_worse ? result.worse : result.equal);
  }
  return result;
}

double geometric_mean_ratio(std::span<const RoughMaterial> materials, std::size_t model,
                            std::size_t reference) {
  double sum = 0;
  for (const RoughMaterial& material : materials) {
    sum += std::log(material.fits[model].error / material.fits[reference].error);
  }
  return std::exp(sum / double(materials.size()));
}

}  // namespace gonio::bench
