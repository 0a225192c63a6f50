// A coverage study as text for people and as JSON for machines, ending with what of the promised
// figures is reached.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/coverage_study.h"

namespace gonio::bench {

/// A promised figure and what was found.
struct FigureCheck {
  std::string promise;
  std::string found;
  bool reached;
};

/// The estimator's figures, and that every fit converged and took the expected covariance.
std::vector<FigureCheck> check_figures(const Estimator& estimator, const CoverageTotals& totals);

/// Headings, then one line per parameter of each material.
std::string parameter_table(const Estimator& estimator,
                            std::span<const MaterialCoverage> materials);

/// The totals and the figures, one line each.
std::string figure_lines(const Estimator& estimator, std::span<const MaterialCoverage> materials);

nlohmann::ordered_json to_json(const Estimator& estimator,
                               std::span<const MaterialCoverage> materials);

}  // namespace gonio::bench
