// gonio fit: from a table to parameters with error bars.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include "apps/gonio/command.h"
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

struct FitArguments {
  std::string table;
  std::string models;
  std::string metric = "cosine-l2";
  std::string covariance = "auto";
  std::string noise;
  std::vector<std::string> fixed, start, bounds;
  double max_theta = 80;
  int threads = 0;
  std::string output;
  std::string residuals;
  bool json = false;
};

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

double number_in(std::string_view text, std::string_view option, std::string_view form) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument(
        fmt::format("{} needs {}; '{}' is not a number", option, form, text));
  }
  return value;
}

/// Splits at the first `separator`. Throws if there is none.
std::pair<std::string, std::string> split(const std::string& text, char separator,
                                          std::string_view option, std::string_view form) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) {
    throw std::invalid_argument(fmt::format("{} needs {}; found '{}'", option, form, text));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

std::vector<fit::ParameterSetting> settings_in(const std::vector<std::string>& texts,
                                               std::string_view option) {
  constexpr std::string_view form = "parameter=value, e.g. alpha_x=0.1 or rho_d.R=0.2";
  std::vector<fit::ParameterSetting> settings;
  for (const std::string& text : texts) {
    const auto [parameter, value] = split(text, '=', option, form);
    settings.push_back({parameter, number_in(value, option, form)});
  }
  return settings;
}

fit::Options options_in(const FitArguments& arguments) {
  fit::Options options;
  options.metric = fit::metric_from_name(arguments.metric);
  options.covariance = fit::covariance_from_name(arguments.covariance);
  if (!(arguments.max_theta > 0 && arguments.max_theta <= 90)) {
    throw std::invalid_argument("--max-theta needs an angle above 0 and up to 90 degrees");
  }
  options.max_theta_deg = arguments.max_theta;
  if (arguments.threads < 0) throw std::invalid_argument("--threads needs a number from 0 (all)");
  options.threads = arguments.threads;
  if (!arguments.noise.empty()) {
    constexpr std::string_view form = "REL,ABS, e.g. 0.02,0.001 for 2 % and 0.001/sr";
    if (options.metric != fit::Metric::chi2) {
      throw std::invalid_argument("--noise is what metric chi2 weighs by: add --metric chi2");
    }
    const auto [relative, absolute] = split(arguments.noise, ',', "--noise", form);
    options.noise = {number_in(relative, "--noise", form), number_in(absolute, "--noise", form)};
    if (!(options.noise->relative >= 0 && options.noise->absolute >= 0)) {
      throw std::invalid_argument("--noise needs two numbers that are not negative");
    }
  }
  options.fixed = settings_in(arguments.fixed, "--fix");
  options.start = settings_in(arguments.start, "--start");
  for (const std::string& text : arguments.bounds) {
    constexpr std::string_view form = "parameter=lower:upper, e.g. alpha=0.01:0.5";
    const auto [parameter, range] = split(text, '=', "--bounds", form);
    const auto [lower, upper] = split(range, ':', "--bounds", form);
    options.bounds.push_back(
        {parameter, number_in(lower, "--bounds", form), number_in(upper, "--bounds", form)});
  }
  return options;
}

/// The models that the user named, or all that the table can determine.
std::vector<std::string> models_in(const FitArguments& arguments, const table::SampleTable& table,
                                   const fit::Options& options) {
  if (arguments.models.empty() || arguments.models == "all") {
    std::vector<std::string> excluded;
    std::vector<std::string> names = fit::determinable_models(table, options, excluded);
    for (const std::string& note : excluded) print_note(note);
    return names;
  }
  std::vector<std::string> names;
  std::string_view rest = arguments.models;
  while (true) {
    const std::size_t comma = rest.find(',');
    names.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) return names;
    rest.remove_prefix(comma + 1);
  }
}

std::vector<TimedFit> fit_models(const std::vector<brdf::Model>& models,
                                 const table::SampleTable& table, fit::Options options) {
  std::vector<TimedFit> fits;
  for (const brdf::Model& model : models) {
    const std::string what =
        fmt::format("fitting {} ({} of {})", model.name(), fits.size() + 1, models.size());
    ProgressLine progress(what);
    options.progress = [&](int pass, double share) {
      progress.set(fmt::format("{}, pass {}", what, pass), share);
    };
    const Stopwatch stopwatch;
    fit::FitResult result = fit::fit(model, table, options);
    fits.push_back({std::move(result), stopwatch.seconds()});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const TimedFit& a, const TimedFit& b) {
    return fit::ranks_before(a.result, b.result);
  });
  return fits;
}

/// Writes the table with a column of the model's values and one of the residuals per channel.
void write_residuals(const std::string& path, const table::SampleTable& table,
                     const material::Material& material) {
  const std::vector<std::vector<double>> model = material::evaluate(material, table);
  std::vector<std::vector<double>> residuals = table.values;
  std::vector<table::ExtraColumn> columns;
  for (std::size_t c = 0; c < model.size(); ++c) {
    for (std::size_t i = 0; i < table.size(); ++i) residuals[c][i] -= model[c][i];
    columns.push_back({table.channels[c] + "_model", model[c]});
    columns.push_back({table.channels[c] + "_residual", residuals[c]});
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
                   const std::string& command, double read_seconds) {
  if (fits.size() == 1) {
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

  std::vector<brdf::Model> models;
  for (const std::string& name : models_in(arguments, table, options)) models.emplace_back(name);
  const std::vector<TimedFit> fits = fit_models(models, table, options);

  const fit::FitResult& best = fits.front().result;
  const material::Material material = material::from_fit(best, table, invocation.command_line);
  if (!arguments.output.empty()) material::write_material(material, arguments.output);
  if (!arguments.residuals.empty()) write_residuals(arguments.residuals, table, material);
  if (arguments.json) {
    print_json_of(fits, table, invocation.command_line, read_seconds);
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
      ->type_name("P=V");
  command->add_option("--bounds", arguments->bounds, "confine a parameter, e.g. alpha=0.01:0.5")
      ->type_name("P=LO:HI");
  command
      ->add_option("--start", arguments->start,
                   "start a shape parameter there instead of searching")
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
