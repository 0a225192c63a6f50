#include "apps/gonio/fit_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "material/evaluate.h"
#include "table/formats/gonio_csv.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

std::string model_column(const std::string& channel) { return channel + "_model"; }
std::string residual_column(const std::string& channel) { return channel + "_residual"; }

}  // namespace

void check_residual_columns(const table::SampleTable& table) {
  for (const std::string& channel : table.channels) {
    for (const std::string& name : {model_column(channel), residual_column(channel)}) {
      if (std::find(table.channels.begin(), table.channels.end(), name) == table.channels.end()) {
        continue;
      }
      throw std::invalid_argument(
          fmt::format("--residuals: the table has a channel '{}' already: rename it", name));
    }
  }
}

void write_residuals(const std::string& path, const table::SampleTable& table,
                     const material::Material& material) {
  const std::vector<std::vector<double>> model = material::evaluate(material, table);
  std::vector<std::vector<double>> residuals = table.values;
  std::vector<table::ExtraColumn> columns;
  for (std::size_t c = 0; c < model.size(); ++c) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      residuals[c][i] = table.mask[i] == table::MaskReason::none
                            ? residuals[c][i] - model[c][i]
                            : std::numeric_limits<double>::quiet_NaN();
    }
    columns.push_back({model_column(table.channels[c]), model[c]});
    columns.push_back({residual_column(table.channels[c]), residuals[c]});
  }
  table::OutputFile file(path);
  table::write_gonio_csv(table, columns, [&](std::string_view text) { file.write(text); });
  file.commit();
}

}  // namespace gonio::app
