#include "bench/real_materials_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>

#include "brdf/model.h"
#include "fit/fit.h"
#include "fit/ranking.h"
#include "table/file_error.h"
#include "table/formats/curet.h"
#include "table/read.h"

namespace gonio::bench {
namespace {

struct Source {
  std::string_view folder;
  std::string_view ending;
};

constexpr std::array sources{Source{"paints", ".astm"}, Source{"rgl", ".bsdf"},
                             Source{"merl", ".binary"}, Source{"zemax", ".bsdf"},
                             Source{"openmaterial", ".xompt"}};

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            std::string_view ending) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<RealMaterial> curet_materials(const std::filesystem::path& folder) {
  std::vector<RealMaterial> materials;
  const std::string path = (folder / "abrdf.dat").string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return materials;
  auto tables = table::read_curet(
      table::CuretFiles{.measurements = path, .directions = (folder / "table.txt").string()});
  for (table::SampleTable& table : tables) {
    auto shared = std::make_shared<table::SampleTable>(std::move(table));
    materials.push_back({"curet", shared->name, path, [shared] { return *shared; }});
  }
  return materials;
}

/// The models that the table determines, or why there is nothing to fit.
std::vector<std::string> models_for(const table::SampleTable& table, const fit::Options& options,
                                    std::string& problem) {
  std::vector<std::string> excluded;
  try {
    return fit::determinable_models(table, options, excluded);
  } catch (const table::FileError& error) {
    problem = error.what();
    return {};
  }
}

}  // namespace

std::vector<RealMaterial> real_materials(const std::filesystem::path& folder) {
  std::vector<RealMaterial> materials;
  for (const Source& source : sources) {
    for (const auto& file : files_in(folder / source.folder, source.ending)) {
      materials.push_back({std::string(source.folder), file.stem().string(), file.string(),
                           [path = file.string()] { return table::read(path); }});
    }
  }
  for (RealMaterial& material : curet_materials(folder / "curet")) {
    materials.push_back(std::move(material));
  }
  return materials;
}

RealResult fit_every_model(const RealMaterial& material, const fit::Options& options) {
  const table::SampleTable table = material.read();
  RealResult result{.source = material.source,
                    .name = material.name,
                    .samples = table.size(),
                    .used = 0,
                    .fits = {},
                    .problem = {}};
  for (const std::string& name : models_for(table, options, result.problem)) {
    const fit::FitResult fitted = fit::fit(brdf::Model(name), table, options);
    result.used = fitted.used;
    RealFit fit{.model = name, .converged = fitted.converged, .errors = {}};
    for (const auto& [metric, error] : fitted.errors) fit.errors.emplace_back(metric, error);
    result.fits.push_back(std::move(fit));
  }
  const std::string metric(fit::name(options.metric));
  std::stable_sort(result.fits.begin(), result.fits.end(), [&](const RealFit& a, const RealFit& b) {
    return error_under(a, metric) < error_under(b, metric);
  });
  return result;
}

double error_under(const RealFit& fit, const std::string& metric) {
  const auto found = std::find_if(fit.errors.begin(), fit.errors.end(),
                                  [&](const auto& error) { return error.first == metric; });
  return found == fit.errors.end() ? 0 : found->second;
}

std::vector<ModelTally> tally(const std::vector<RealResult>& results, const std::string& source,
                              const std::string& metric) {
  std::map<std::string, ModelTally> by_model;
  for (const RealResult& result : results) {
    if (result.source != source || result.fits.empty()) continue;
    const auto least = std::min_element(result.fits.begin(), result.fits.end(),
                                        [&](const RealFit& a, const RealFit& b) {
                                          return error_under(a, metric) < error_under(b, metric);
                                        });
    const double best = error_under(*least, metric);
    if (!(best > 0)) continue;
    for (const RealFit& fit : result.fits) {
      ModelTally& tally = by_model[fit.model];
      tally.model = fit.model;
      const double ratio = error_under(fit, metric) / best;
      ++tally.materials;
      tally.best += &fit == &*least ? 1U : 0U;
      tally.mean_ratio += std::log(ratio);
      tally.worst_ratio = std::max(tally.worst_ratio, ratio);
    }
  }
  std::vector<ModelTally> tallies;
  for (auto& [name, tally] : by_model) {
    tally.mean_ratio = std::exp(tally.mean_ratio / double(tally.materials));
    tallies.push_back(tally);
  }
  std::stable_sort(tallies.begin(), tallies.end(), [](const ModelTally& a, const ModelTally& b) {
    return a.mean_ratio < b.mean_ratio;
  });
  return tallies;
}

}  // namespace gonio::bench
