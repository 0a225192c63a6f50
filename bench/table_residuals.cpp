// table_residuals: the recommended look-up table of fitted materials, and its error beside the
// fit's residual: Ward's ten materials with 2 % of noise, and five measured paints.
//
// Exit status: 0 the figure is reached by all; 1 not by all; 2 wrong usage; 3 unusable data or a
// driver that failed.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "bench/measured_data.h"
#include "bench/study_main.h"
#include "bench/table_residuals_study.h"
#include "trade/table_choice.h"

namespace gonio::bench {
namespace {

std::optional<shader::VulkanDevice> open_device() {
  try {
    return shader::VulkanDevice();
  } catch (const shader::NoVulkanDevice& error) {
    fmt::print("predicted only, nothing is measured: {}\n", error.what());
    return std::nullopt;
  }
}

std::string text_of(const trade::TableChoice& table) {
  const lut::Layout& layout = table.layout;
  return fmt::format("{} {}x{} {} {} reach {:.3g} {}", lut::name_of(layout.kind), layout.width,
                     layout.height, lut::name_of(layout.storage), lut::name_of(layout.coordinate),
                     layout.reach, lut::name_of(table.filter));
}

void print_row(const TableResidual& result) {
  const char* mark = figure_holds(result) ? "" : ">";
  if (!result.check) {
    fmt::print("{:1} {:<25} {:<18} no table keeps the limits\n", mark, result.name, result.model);
    return;
  }
  const trade::TableCheck& check = *result.check;
  fmt::print("{:1} {:<25} {:<18} {:>9.2e} {:>8.3f} % {:>9.2e} {:>8}  {}\n", mark, result.name,
             result.model, result.residual, 100 * result.share(), trade::worst_error(check).largest,
             trade::size_of(check.table.layout), text_of(check.table));
}

int study(const std::string& project, const std::string& data) {
  std::optional<shader::VulkanDevice> device = open_device();
  if (device) fmt::print("device: {}\n", shader::text_of(device->description()));
  std::vector<MeasuredMaterial> materials = ward_materials(project);
  const std::vector<MeasuredMaterial> measured = paints(data);
  if (measured.empty()) {
    fmt::print(stderr, "table_residuals: SKIPPED the paints: none in {}; set GONIO_DATA\n", data);
  }
  materials.insert(materials.end(), measured.begin(), measured.end());
  fmt::print(
      "table error over the fit's residual, root mean squares of f_r cos_i over the samples: the "
      "figure is under {:g} %\n{:1} {:<25} {:<18} {:>9} {:>10} {:>9} {:>8}  {}\n",
      100 * trade::share_of_residual, "", "material", "model", "residual", "table", "of peak",
      "bytes", "recommended table");
  bool all_hold = true;
  for (const MeasuredMaterial& material : materials) {
    const TableResidual result = table_residual(material, device ? &*device : nullptr);
    print_row(result);
    all_hold = all_hold && figure_holds(result);
  }
  fmt::print("{} by all {} materials\n", all_hold ? "reached" : "NOT reached", materials.size());
  return all_hold ? 0 : 1;
}

int run(int argc, char** argv) {
  std::string project = ".";
  std::string data = data_folder().string();
  CLI::App app{"The recommended look-up table of fitted materials beside the fit's residual."};
  app.name("table_residuals");
  app.add_option("--project", project, "The project's folder")->capture_default_str();
  app.add_option("--data", data, "The folder of measurements")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "table_residuals: {} (--help says what there is)\n", error.what());
    return 2;
  }
  return study(project, data);
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("table_residuals", gonio::bench::run, argc, argv);
}
