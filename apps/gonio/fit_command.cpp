// gonio fit: from a table to parameters with error bars.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "apps/gonio/command.h"
#include "apps/gonio/fit_arguments.h"
#include "apps/gonio/fit_report.h"
#include "apps/gonio/progress.h"
#include "brdf/model.h"
#include "fit/fit.h"
#include "fit/ranking.h"
#include "material/evaluate.h"
#include "material/from_fit.h"
#include "material/material_json.h"
#include "table/formats/gonio_csv.h"
#include "table/output_file.h"
#include "table/read.h"

namespace gonio::app {
namespace {

struct TimedFit {
  fit::FitResult result;
  double seconds;
};

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool asks_for_all(const FitArguments& arguments) {
  return !arguments.models || *arguments.models == "all";
}

/// The models that the user named, each once, or all that the table can determine.
std::vector<brdf::Model> models_in(const FitArguments& arguments, const table::SampleTable& table,
                                   const fit::Options& options) {
  std::vector<brdf::Model> models;
  if (asks_for_all(arguments)) {
    std::vector<std::string> excluded;
    for (const std::string& name : fit::determinable_models(table, options, excluded)) {
      models.emplace_back(name);
    }
    for (const std::string& note : excluded) print_note(note);
    return models;
  }
  std::string_view rest = *arguments.models;
  while (true) {
    const std::size_t comma = rest.find(',');
    brdf::Model model(rest.substr(0, comma));
    if (std::none_of(models.begin(), models.end(),
                     [&](const brdf::Model& other) { return other.name() == model.name(); })) {
      models.push_back(std::move(model));
    }
    if (comma == std::string_view::npos) return models;
    rest.remove_prefix(comma + 1);
  }
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

/// Refuses a setting that no model has the parameter for, and notes those without effect.
void check_settings(const fit::Options& options, const std::vector<brdf::Model>& models,
                    const table::SampleTable& table) {
  std::vector<std::string> names;
  for (const auto& setting : options.fixed) names.push_back(setting.parameter);
  for (const auto& setting : options.start) names.push_back(setting.parameter);
  for (const auto& setting : options.bounds) names.push_back(setting.parameter);
  for (const std::string& name : names) {
    if (std::none_of(models.begin(), models.end(), [&](const brdf::Model& model) {
          return fit::has_parameter(model, table.channels, name);
        })) {
      throw std::invalid_argument(
          fmt::format("no parameter '{}' in the model or models of this fit: 'gonio models MODEL' "
                      "lists those of a model; one channel's part is written rho_d.{}",
                      name, table.channels.front()));
    }
  }
  for (const auto& setting : options.start) {
    if (setting.parameter.starts_with("rho_")) {
      print_note(fmt::format("--start {}: amplitudes are solved for exactly and need no start",
                             setting.parameter));
    }
  }
}

std::vector<TimedFit> fit_models(const std::vector<brdf::Model>& models,
                                 const table::SampleTable& table, const fit::Options& all_options) {
  fit::Options options = all_options;
  std::vector<TimedFit> fits;
  for (const brdf::Model& model : models) {
    const std::string what =
        fmt::format("fitting {} ({} of {})", model.name(), fits.size() + 1, models.size());
    ProgressLine progress(what);
    options.progress = [&](int pass, double share) {
      progress.set(fmt::format("{}, pass {}", what, pass), share);
    };
    options.fixed = applicable(all_options.fixed, model, table);
    options.start = applicable(all_options.start, model, table);
    options.bounds = applicable(all_options.bounds, model, table);
    const Stopwatch stopwatch;
    fit::FitResult result = fit::fit(model, table, options);
    fits.push_back({std::move(result), stopwatch.seconds()});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const TimedFit& a, const TimedFit& b) {
    return fit::ranks_before(a.result, b.result);
  });
  return fits;
}

/// True if both paths name one file, which may not exist yet.
bool is_same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error)) return fs::equivalent(a, b, error);
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

/// Refuses outputs that would destroy the input or each other, and those that cannot be written:
/// before the work, not after it.
void check_outputs(const FitArguments& arguments) {
  const auto check = [&](std::string_view option, const std::string& path) {
    if (path.empty()) return;
    if (is_same_file(path, arguments.table)) {
      throw std::invalid_argument(
          fmt::format("{} {}: would overwrite the table: name another file", option, path));
    }
    const table::OutputFile probe(path);
  };
  check("-o", arguments.output);
  check("--residuals", arguments.residuals);
  if (!arguments.output.empty() && !arguments.residuals.empty() &&
      is_same_file(arguments.output, arguments.residuals)) {
    throw std::invalid_argument(fmt::format(
        "--residuals {}: is the file of -o as well: name another file", arguments.residuals));
  }
}

/// The columns that --residuals adds for a channel.
std::string model_column(const std::string& channel) { return channel + "_model"; }
std::string residual_column(const std::string& channel) { return channel + "_residual"; }

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

/// Writes the table with a column of the model's values and one of the residuals per channel.
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

nlohmann::ordered_json json_of(const TimedFit& timed, const table::SampleTable& table,
                               const std::string& command, double read_seconds) {
  nlohmann::ordered_json json = material::to_json(material::from_fit(timed.result, table, command));
  json["timing"] = {
      {"read_s", read_seconds}, {"fit_s", timed.seconds}, {"passes", timed.result.passes}};
  return json;
}

void print_json_of(const std::vector<TimedFit>& fits, const table::SampleTable& table,
                   const std::string& command, double read_seconds, bool as_list) {
  if (!as_list) {
    print_json(json_of(fits.front(), table, command, read_seconds));
    return;
  }
  nlohmann::ordered_json all;
  for (const TimedFit& timed : fits) {
    all["fits"].push_back(json_of(timed, table, command, read_seconds));
  }
  print_json(all);
}

void print_report_of(const std::vector<TimedFit>& fits, const table::SampleTable& table,
                     const fit::Options& options) {
  const fit::FitResult& best = fits.front().result;
  print(report_table(table, best, options.max_theta_deg));
  if (fits.size() > 1) {
    std::vector<fit::FitResult> results;
    for (const TimedFit& timed : fits) results.push_back(timed.result);
    print(report_ranking(results));
  }
  print(report_fit(best));
}

void run_fit(const FitArguments& arguments, Invocation& invocation) {
  const fit::Options options = options_in(arguments);
  check_outputs(arguments);
  table::SampleTable table;
  double read_seconds = 0;
  {
    const ProgressLine progress("reading " + arguments.table);
    const Stopwatch stopwatch;
    table = table::read(arguments.table, {.keep_angle_text = !arguments.residuals.empty(),
                                          .threads = arguments.threads});
    read_seconds = stopwatch.seconds();
    if (arguments.json || !arguments.output.empty()) {
      table.provenance.sha256 = table::sha256_of_file(arguments.table);
    }
  }
  for (const std::string& note : table.notes) {
    print_note(fmt::format("{}: {}", arguments.table, note));
  }

  if (!arguments.residuals.empty()) check_residual_columns(table);
  const std::vector<brdf::Model> models = models_in(arguments, table, options);
  check_settings(options, models, table);
  const std::vector<TimedFit> fits = fit_models(models, table, options);

  const fit::FitResult& best = fits.front().result;
  const material::Material material = material::from_fit(best, table, invocation.command_line);
  if (!arguments.output.empty()) material::write_material(material, arguments.output);
  if (!arguments.residuals.empty()) write_residuals(arguments.residuals, table, material);
  if (arguments.json) {
    const bool as_list = asks_for_all(arguments) || models.size() > 1;
    print_json_of(fits, table, invocation.command_line, read_seconds, as_list);
  } else {
    print_report_of(fits, table, options);
  }
  for (const std::string& warning : best.warnings) print_note("warning: " + warning);
  for (const TimedFit& timed : fits) {
    if (!timed.result.converged) invocation.exit_status = 1;
  }
}

}  // namespace

void add_fit_command(CLI::App& app, Invocation& invocation) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand(
      "fit", "Fit models to a table: parameters with standard deviations and 95 % intervals");
  command->add_option("TABLE", arguments->table, "the measured table, in any format")->required();
  command
      ->add_option("-m,--model", arguments->models,
                   "MODEL[,MODEL..] (see gonio models), or all; without it, all the models "
                   "that this table can determine")
      ->type_name("MODEL");
  command->add_option("--metric", arguments->metric, "l2, cosine-l2 or chi2")
      ->capture_default_str()
      ->type_name("METRIC");
  command
      ->add_option("--noise", arguments->noise,
                   "for chi2: sigma^2 = (REL f)^2 + ABS^2, instead of the table's sigma")
      ->type_name("REL,ABS");
  command
      ->add_option("--max-theta", arguments->max_theta,
                   "leave out samples with a polar angle beyond it, in degrees")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_option("--fix", arguments->fixed, "hold a parameter, e.g. alpha=0.1 or rho_d.R=0.2")
      ->allow_extra_args(false)
      ->type_name("P=V");
  command->add_option("--bounds", arguments->bounds, "confine a parameter, e.g. alpha=0.01:0.5")
      ->allow_extra_args(false)
      ->type_name("P=LO:HI");
  command
      ->add_option("--start", arguments->start,
                   "start a shape parameter there instead of searching")
      ->allow_extra_args(false)
      ->type_name("P=V");
  command
      ->add_option("--covariance", arguments->covariance, "auto, known-sigma, residual or sandwich")
      ->capture_default_str()
      ->type_name("KIND");
  command->add_option("--threads", arguments->threads, "0: all; the result is the same for any")
      ->capture_default_str()
      ->type_name("N");
  command->add_option("-o,--output", arguments->output, "write the (best) material as JSON")
      ->type_name("FILE");
  command
      ->add_option("--residuals", arguments->residuals,
                   "write the table with the (best) model's values and the residuals")
      ->type_name("CSV");
  command->add_flag("--json", arguments->json, "print the result as JSON");
  command->callback([arguments, &invocation] { run_fit(*arguments, invocation); });
}

}  // namespace gonio::app
