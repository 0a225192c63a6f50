// What a user writes behind gonio fit, and what it means.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/gonio/table_options.h"
#include "brdf/model.h"
#include "fit/options.h"

namespace gonio::app {

/// The texts of the command line.
struct FitArguments {
  std::vector<std::string> tables;
  TableOptions reading;
  std::optional<std::string> models;
  std::string metric = "cosine-l2";
  std::string loss = "none";
  std::string loss_scale;
  std::string covariance = "auto";
  std::string noise;
  std::vector<std::string> fixed, start, bounds;
  double max_theta = 80;
  bool free_frame = false;
  bool homogeneous = false;
  int threads = 0;
  std::string output;
  std::string residuals;
  bool summary = false;
  bool json = false;
};

/// The options that they stand for. Throws std::invalid_argument that names the option and what it
/// needs.
fit::Options options_in(const FitArguments& arguments);

/// Where the tangent of the models points.
brdf::Frame frame_in(const FitArguments& arguments);

/// The models that the user named, each once; none: all that a table can determine. Throws
/// std::invalid_argument for an unknown one.
std::optional<std::vector<brdf::Model>> models_in(const FitArguments& arguments);

}  // namespace gonio::app
