#include "apps/gonio/fit_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <utility>

#include "apps/gonio/fit_residuals.h"
#include "brdf/nearest_name.h"
#include "fit/held_out.h"
#include "fit/nested.h"
#include "fit/ranking.h"
#include "material/from_fit.h"
#include "material/material_json.h"
#include "table/file_error.h"
#include "table/read.h"

namespace gonio::app {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The table and the seconds that reading it took, without its digest.
std::pair<table::SampleTable, double> timed_table(const FitRequest& request, const FitFiles& files,
                                                  FitMessages& messages) {
  messages.progress("reading " + files.table);
  const Stopwatch stopwatch;
  table::SampleTable table =
      read_table(files.table, request.reading,
                 {.keep_angle_text = !files.residuals.empty(), .threads = request.options.threads});
  const double seconds = stopwatch.seconds();
  if (request.with_digest) table.provenance.sha256 = table::sha256_of_file(files.table);
  for (const std::string& note : table.notes) messages.note_on_table(note);
  return {std::move(table), seconds};
}

std::vector<brdf::Model> models_for(const table::SampleTable& table, const FitRequest& request,
                                    FitMessages& messages) {
  if (request.models) return *request.models;
  std::vector<brdf::Model> models;
  std::vector<std::string> excluded;
  for (const std::string& name :
       fit::determinable_models(table, request.options, excluded, request.frame)) {
    models.emplace_back(name, request.frame);
  }
  for (const std::string& note : excluded) messages.note(note);
  if (models.empty()) {
    throw table::FileError(
        fmt::format("{}: its directions determine no model: name one with -m, or measure more",
                    table.provenance.path));
  }
  return models;
}

/// Of the settings for several models those that this one has a parameter for.
template <class Settings>
Settings applicable(const Settings& settings, const brdf::Model& model,
                    const table::SampleTable& table) {
  Settings kept;
  for (const auto& setting : settings) {
    if (fit::has_parameter(model, table.channels, setting.parameter)) kept.push_back(setting);
  }
  return kept;
}

/// The options as far as they are about this model.
fit::Options options_for(const brdf::Model& model, const table::SampleTable& table,
                         const fit::Options& all) {
  fit::Options options = all;
  options.fixed = applicable(all.fixed, model, table);
  options.start = applicable(all.start, model, table);
  options.bounds = applicable(all.bounds, model, table);
  return options;
}

/// ", did you mean 'alpha_x'?", or nothing.
std::string suggestion(const std::string& name, const std::vector<brdf::Model>& models,
                       const table::SampleTable& table) {
  std::vector<std::string> known;
  for (const brdf::Model& model : models) {
    for (const fit::Unknown& unknown : fit::unknowns_of(model, table.channels)) {
      known.push_back(unknown.parameter);
      known.push_back(unknown.name);
    }
  }
  const std::optional<std::string_view> nearest = brdf::nearest_name(name, known);
  return nearest ? fmt::format(", did you mean '{}'?", *nearest) : "";
}

/// Whether a model of these has an amplitude of that name, or one channel's part of it.
bool is_amplitude(const std::string& name, const std::vector<brdf::Model>& models,
                  const table::SampleTable& table) {
  return std::any_of(models.begin(), models.end(), [&](const brdf::Model& model) {
    const std::vector<fit::Unknown> unknowns = fit::unknowns_of(model, table.channels);
    return std::any_of(unknowns.begin(), unknowns.end(), [&](const fit::Unknown& unknown) {
      return !unknown.is_shape && (unknown.parameter == name || unknown.name == name);
    });
  });
}

/// Refuses a setting that no model has the parameter for, and notes those without effect.
void check_settings(const fit::Options& options, const std::vector<brdf::Model>& models,
                    const table::SampleTable& table, FitMessages& messages) {
  std::vector<std::string> names;
  for (const auto& setting : options.fixed) names.push_back(setting.parameter);
  for (const auto& setting : options.start) names.push_back(setting.parameter);
  for (const auto& setting : options.bounds) names.push_back(setting.parameter);
  for (const std::string& name : names) {
    if (std::none_of(models.begin(), models.end(), [&](const brdf::Model& model) {
          return fit::has_parameter(model, table.channels, name);
        })) {
      throw std::invalid_argument(fmt::format(
          "no parameter '{}' in the model or models of this fit{}: 'gonio models MODEL' "
          "lists those of a model; one channel's part is written {}.{}",
          name, suggestion(name, models, table), models.front().amplitudes().front().name,
          table.channels.front()));
    }
  }
  for (const auto& setting : options.start) {
    if (is_amplitude(setting.parameter, models, table)) {
      messages.note(fmt::format("--start {}: amplitudes are solved for exactly and need no start",
                                setting.parameter));
    }
  }
}

void note_idle_frame(const std::vector<brdf::Model>& models, const FitRequest& request,
                     FitMessages& messages) {
  if (request.frame == brdf::Frame::of_table ||
      std::any_of(models.begin(), models.end(), std::mem_fn(&brdf::Model::has_free_frame))) {
    return;
  }
  messages.note("--free-frame: no model of this fit has a tangent, so that it changes nothing");
}

/// Adds what only a comparison tells: errors held out, and tests of models within others.
void compare(std::vector<fit::FitResult>& results, const table::SampleTable& table,
             const fit::Options& options, FitMessages& messages) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    fit::FitResult& result = results[i];
    messages.progress(fmt::format("predicting angles held out from {} ({} of {})",
                                  result.model.name(), i + 1, results.size()));
    result.held_out =
        fit::held_out_errors(result, table, options_for(result.model, table, options));
  }
  fit::compare_nested(results);
}

std::vector<ModelFit> fit_models(const std::vector<brdf::Model>& models,
                                 const table::SampleTable& table, const FitRequest& request,
                                 FitMessages& messages) {
  std::vector<fit::FitResult> results;
  std::vector<double> seconds;
  for (const brdf::Model& model : models) {
    const std::string what =
        fmt::format("fitting {} ({} of {})", model.name(), results.size() + 1, models.size());
    messages.progress(what);
    fit::Options options = options_for(model, table, request.options);
    options.progress = [&](int pass, double share) {
      messages.progress(fmt::format("{}, pass {}", what, pass), share);
    };
    const Stopwatch stopwatch;
    results.push_back(fit::fit(model, table, options));
    seconds.push_back(stopwatch.seconds());
  }
  if (results.size() > 1) compare(results, table, request.options, messages);
  std::vector<ModelFit> fits;
  for (const std::size_t i : fit::ranking(results)) {
    material::Material material = material::from_fit(results[i], table, request.command_line);
    fits.push_back({std::move(results[i]), std::move(material), seconds[i]});
  }
  return fits;
}

}  // namespace

bool TableFit::has_converged() const {
  return std::all_of(fits.begin(), fits.end(),
                     [](const ModelFit& fit) { return fit.result.converged; });
}

TableFit fit_table(const FitRequest& request, const FitFiles& files, FitMessages& messages) {
  auto [table, read_seconds] = timed_table(request, files, messages);
  if (!files.residuals.empty()) check_residual_columns(table, request.options);
  const std::vector<brdf::Model> models = models_for(table, request, messages);
  check_settings(request.options, models, table, messages);
  note_idle_frame(models, request, messages);
  std::vector<ModelFit> fits = fit_models(models, table, request, messages);

  const ModelFit& best = fits.front();
  if (!files.material.empty()) material::write_material(best.material, files.material);
  if (!files.residuals.empty()) {
    write_residuals(files.residuals, table, best.material, best.result, request.options);
  }
  return {std::move(table), read_seconds, std::move(fits)};
}

void note_warnings(const TableFit& table_fit, FitMessages& messages) {
  for (const std::string& warning : table_fit.fits.front().result.warnings) {
    messages.note("warning: " + warning);
  }
}

nlohmann::ordered_json json_of_fits(const TableFit& table_fit) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ModelFit& fit : table_fit.fits) {
    nlohmann::ordered_json json = material::to_json(fit.material);
    json["timing"] = {
        {"read_s", table_fit.read_seconds}, {"fit_s", fit.seconds}, {"passes", fit.result.passes}};
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace gonio::app
