// Which models a table can determine, and which of them fits best.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fit/fit.h"

namespace gonio::fit {

/// The models of brdf::model_names() whose parameters these directions could tell apart if the
/// material had them, e.g. no anisotropic one where the half vectors cover no azimuth or the
/// table's format takes the material for isotropic; each with the given frame. With
/// options.homogeneous only those that can be so. `excluded` gets a sentence for each of the
/// others.
std::vector<std::string> determinable_models(const table::SampleTable& table,
                                             const Options& options,
                                             std::vector<std::string>& excluded,
                                             brdf::Frame frame = brdf::Frame::of_table);

/// The smaller error under the metric first; of equals the one with fewer unknowns.
bool ranks_before(const FitResult& a, const FitResult& b);

/// The indices of the results, best first: as ranks_before() has it, but a model whose richer
/// relative is no better beyond chance (FitResult::nested, p > 0.05) stands right before that one
/// if it would come later.
std::vector<std::size_t> ranking(std::span<const FitResult> results);

}  // namespace gonio::fit
