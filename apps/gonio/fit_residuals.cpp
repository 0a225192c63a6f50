#include "apps/gonio/fit_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "fit/outliers.h"
#include "material/evaluate.h"
#include "table/formats/gonio_csv.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

std::string model_column(const std::string& channel) { return channel + "_model"; }
std::string residual_column(const std::string& channel) { return channel + "_residual"; }
std::string outlier_column(const std::string& channel) { return channel + "_outlier"; }

using Columns = std::vector<std::vector<double>>;

/// NaN where a sample is masked.
Columns residuals_of(const table::SampleTable& table, const Columns& model) {
  Columns residuals = table.values;
  for (std::size_t c = 0; c < model.size(); ++c) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      residuals[c][i] = table.mask[i] == table::MaskReason::none
                            ? residuals[c][i] - model[c][i]
                            : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return residuals;
}

/// 1 for an outlier, 0 for another value, NaN for what the fit did not use. No columns without a
/// robust loss.
Columns outlier_flags(const table::SampleTable& table, const fit::FitResult& result,
                      const fit::Options& options) {
  if (result.loss == fit::Loss::none) return {};
  const table::SampleFilter is_used(table, options.max_theta_deg, options.incidence);
  Columns flags = table.values;
  for (std::vector<double>& channel : flags) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      channel[i] =
          is_used(i) && !std::isnan(channel[i]) ? 0 : std::numeric_limits<double>::quiet_NaN();
    }
  }
  for (const fit::Outlier& outlier : fit::all_outliers(result, table, options)) {
    flags[outlier.channel][outlier.sample] = 1;
  }
  return flags;
}

}  // namespace

void check_residual_columns(const table::SampleTable& table, const fit::Options& options) {
  for (const std::string& channel : table.channels) {
    std::vector<std::string> added{model_column(channel), residual_column(channel)};
    if (options.loss != fit::Loss::none) added.push_back(outlier_column(channel));
    for (const std::string& name : added) {
      if (std::find(table.channels.begin(), table.channels.end(), name) == table.channels.end()) {
        continue;
      }
      throw std::invalid_argument(
          fmt::format("--residuals: the table has a channel '{}' already: rename it", name));
    }
  }
}

void write_residuals(const std::string& path, const table::SampleTable& table,
                     const material::Material& material, const fit::FitResult& result,
                     const fit::Options& options) {
  const Columns model = material::evaluate(material, table);
  const Columns residuals = residuals_of(table, model);
  const Columns outliers = outlier_flags(table, result, options);
  std::vector<table::ExtraColumn> columns;
  for (std::size_t c = 0; c < model.size(); ++c) {
    columns.push_back({model_column(table.channels[c]), model[c]});
    columns.push_back({residual_column(table.channels[c]), residuals[c]});
    if (!outliers.empty()) columns.push_back({outlier_column(table.channels[c]), outliers[c]});
  }
  table::OutputFile file(path);
  table::write_gonio_csv(table, columns, [&](std::string_view text) { file.write(text); });
  file.commit();
}

}  // namespace gonio::app
