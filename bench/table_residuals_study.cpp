#include "bench/table_residuals_study.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <string_view>

#include "fit/fit.h"
#include "instrument/recipe.h"
#include "material/evaluate.h"
#include "material/from_fit.h"
#include "table/file_error.h"
#include "table/read.h"
#include "trade/table_choice.h"

namespace gonio::bench {

namespace fs = std::filesystem;

std::vector<MeasuredMaterial> ward_materials(const std::string& project) {
  std::vector<MeasuredMaterial> materials;
  const fs::path folder = fs::path(project) / "data" / "synthetic";
  if (!fs::is_directory(folder)) {
    throw table::FileError(folder.string() +
                           ": not found, expected gonio's synthetic tables: name the project's "
                           "folder by --project");
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    fs::path measured = entry.path();
    measured.replace_extension(".csv");
    materials.push_back({measured.string(), instrument::read_recipe(entry.path().string()).model});
  }
  std::sort(materials.begin(), materials.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  return materials;
}

std::vector<MeasuredMaterial> paints(const std::string& data) {
  // Matt, glossy and metallic ones.
  constexpr std::array<std::string_view, 5> names{"C1_White", "C6_Green", "C8_Silver", "Metal_Blue",
                                                  "Metal_Yellow"};
  std::vector<MeasuredMaterial> materials;
  for (const std::string_view name : names) {
    const fs::path path = fs::path(data) / "paints" / (std::string(name) + ".astm");
    if (fs::exists(path)) materials.push_back({path.string(), "ward"});
  }
  return materials;
}

double TableResidual::share() const {
  return check ? trade::worst_error(*check).rms / residual
               : std::numeric_limits<double>::infinity();
}

TableResidual table_residual(const MeasuredMaterial& measured, shader::VulkanDevice* device) {
  const table::SampleTable samples = table::read(measured.path);
  const fit::Options options{.metric = fit::Metric::cosine_l2};
  const fit::FitResult fitted = fit::fit(brdf::Model(measured.model), samples, options);
  const material::Material material = material::from_fit(fitted, samples, "table_residuals");
  const brdf::BoundModel model = material::bind(material);
  const trade::Reference reference =
      trade::reference_on_samples(model, material, samples, options.max_theta_deg);
  TableResidual result{
      .name = material.name,
      .model = material.model,
      .residual = trade::cosine_residual(model, material, samples, options.max_theta_deg),
      .check = {}};
  const auto limits = trade::limits_of(reference, trade::half_display_step, result.residual);
  const auto tables = trade::smallest_tables(model, reference, trade::with_headroom(limits));
  if (!tables.empty()) {
    result.check = trade::check_table(model, reference, tables.front().table, device);
  }
  return result;
}

bool figure_holds(const TableResidual& result) { return result.share() < trade::share_of_residual; }

}  // namespace gonio::bench
