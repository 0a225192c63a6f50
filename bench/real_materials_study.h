// Every model on every real material: how good the models are on measurements.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fit/options.h"
#include "table/sample_table.h"

namespace gonio::bench {

/// A material of the data folder.
struct RealMaterial {
  std::string source;  // the folder: "paints"
  std::string name;
  std::string path;
  std::function<table::SampleTable()> read;
};

/// The materials below `folder`, in the order of their names: paints, rgl, merl, curet, zemax,
/// openmaterial. Those of a folder that is not there are left out. Throws table::FileError for a
/// CUReT pair that cannot be read.
std::vector<RealMaterial> real_materials(const std::filesystem::path& folder);

struct RealFit {
  std::string model;
  bool converged;
  std::vector<std::pair<std::string, double>> errors;  // by metric: every one but chi2
};

struct RealResult {
  std::string source, name;
  std::size_t samples, used;
  /// By the error under the metric of the fit, the smallest first; none if nothing can be fitted.
  std::vector<RealFit> fits;
  std::string problem;  // why there are none
};

/// Fits every model that the material's directions can determine. Throws FileError for a file that
/// cannot be read.
RealResult fit_every_model(const RealMaterial& material, const fit::Options& options);

/// How a model did on several materials.
struct ModelTally {
  std::string model;
  std::size_t materials = 0;  // that determine it
  std::size_t best = 0;       // on which it is first
  /// Over the materials, the geometric mean of its error over that of the best model there.
  double mean_ratio = 0;
  double worst_ratio = 0;
};

/// Of the results of one source under one metric, the smallest mean ratio first. Ratios to a best
/// error of 0 are left out.
std::vector<ModelTally> tally(const std::vector<RealResult>& results, const std::string& source,
                              const std::string& metric);

/// Of a fit; 0 if there is no such metric.
double error_under(const RealFit& fit, const std::string& metric);

}  // namespace gonio::bench
