// The study of the extremes as text: a table per model, and which figures are reached.
#pragma once

#include <span>
#include <string>

#include "bench/extremes_study.h"
#include "bench/finite_study.h"

namespace gonio::bench {

/// The regions by name, with what they mean.
std::string region_legend();

/// Worst and median errors of double and float in each region, beside those of the naive form.
std::string error_table(const ModelErrors& model);

/// What of the figures is reached, a line per model.
std::string figure_table(std::span<const ModelErrors> models);

/// True if every figure is reached, or bound by the condition of its model.
bool all_figures_hold(std::span<const ModelErrors> models);

/// Evaluations and what was unsound among them, a line per model, and where the first is.
std::string finite_table(std::span<const ModelFiniteness> models);

bool all_sound(std::span<const ModelFiniteness> models);

}  // namespace gonio::bench
