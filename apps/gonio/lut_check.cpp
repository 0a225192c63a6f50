// gonio lut check: a look-up table's error beside that of the fit whose parameters it serves.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "apps/gonio/device_option.h"
#include "apps/gonio/lut_check_report.h"
#include "apps/gonio/lut_command.h"
#include "apps/gonio/lut_options.h"
#include "apps/gonio/progress.h"
#include "apps/gonio/table_options.h"
#include "export/shader_table.h"
#include "lut/table_model.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/file_error.h"
#include "table/read.h"
#include "trade/table_choice.h"

namespace gonio::app {
namespace {

struct CheckOptions {
  std::string material;
  LutOptions lut;
  std::string lut_path;
  std::string filter;  // linear or nearest; empty: linear
  std::string device;
  std::string samples;
  TableOptions reading;
  std::string tolerance;
  std::string max_theta = "80";
  bool recommend = false;
  bool json = false;
};

/// The samples that a material is checked on, or why there are none.
struct Samples {
  std::optional<table::SampleTable> table;
  std::string path;
  std::string reason;
};

table::SampleTable read_samples(const std::string& path, const TableOptions& reading) {
  const ProgressLine progress("reading " + path);
  return read_table(path, reading);
}

/// Where a material's table is: as its provenance has it, or from the folder of the material.
std::string path_of_samples(const std::string& path, const std::string& material_path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return path;
  const auto beside = std::filesystem::path(material_path).parent_path() / path;
  return std::filesystem::is_regular_file(beside, error) ? beside.string() : path;
}

/// The table that the material was fitted to, if it is still there and still the same.
Samples samples_of(const CheckOptions& options, const material::Material& material) {
  if (!material.provenance || material.provenance->table.empty()) {
    return {std::nullopt, {}, "the material names no table; --samples TABLE does"};
  }
  const std::string path = path_of_samples(material.provenance->table, options.material);
  const std::string& sha256 = material.provenance->sha256;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return {std::nullopt,
            {},
            fmt::format("the material's {} is not there; --samples TABLE names it", path)};
  }
  if (table::sha256_of_file(path) != sha256) {
    return {
        std::nullopt,
        {},
        fmt::format("the material's {} has changed since; --samples takes it all the same", path)};
  }
  try {
    return {read_samples(path, options.reading), path, {}};
  } catch (const table::FileError& unreadable) {
    return {std::nullopt,
            {},
            fmt::format("the material's table cannot be read ({}); --samples takes it with the "
                        "options that it was fitted with",
                        unreadable.what())};
  }
}

Samples samples_for(const CheckOptions& options, const material::Material& material) {
  if (options.samples.empty()) return samples_of(options, material);
  return {read_samples(options.samples, options.reading), options.samples, {}};
}

double parse_number_within(std::string_view option, const std::string& text, double above,
                           double most, std::string_view expected) {
  const auto number = parse_number(text);
  if (!number || !(*number > above && *number <= most)) {
    throw std::invalid_argument(fmt::format("{}: found '{}', expected {}", option, text, expected));
  }
  return *number;
}

double tolerance_in(const CheckOptions& options) {
  if (options.tolerance.empty()) return trade::half_display_step;
  return parse_number_within("--tolerance", options.tolerance, 0, 1,
                             "a fraction of the lobe's peak, above 0 and at most 1");
}

lut::Filter filter_in(const CheckOptions& options) {
  return options.filter.empty() ? lut::Filter::linear : lut::filter_named(options.filter);
}

/// Throws if an option that describes a table is given beside one that says which it is.
void refuse_beside(std::string_view chooser, std::string_view does, const CheckOptions& options) {
  for (const auto& [option, given] :
       {std::pair{"--table", options.lut.table}, std::pair{"--size", options.lut.size},
        std::pair{"--coordinate", options.lut.coordinate}, std::pair{"--reach", options.lut.reach},
        std::pair{"--format", options.lut.format}, std::pair{"--alpha", options.lut.alpha},
        std::pair{"--exponent", options.lut.exponent}}) {
    if (given.empty()) continue;
    throw std::invalid_argument(fmt::format("{} {}: {} {} the table, expected one of the two",
                                            option, given, chooser, does));
  }
}

void refuse_contradictions(const CheckOptions& options) {
  if (options.recommend) refuse_beside("--recommend", "chooses", options);
  if (options.recommend && !options.filter.empty()) {
    throw std::invalid_argument(fmt::format(
        "--filter {}: --recommend chooses the filter, expected one of the two", options.filter));
  }
  if (options.lut_path.empty()) return;
  refuse_beside("--lut", "names", options);
  if (options.recommend) {
    throw std::invalid_argument(fmt::format(
        "--lut {}: --recommend chooses the table, expected one of the two", options.lut_path));
  }
}

/// The table that the options name, which serves the model.
lut::Table table_in(const CheckOptions& options, const brdf::BoundModel& model) {
  if (options.lut_path.empty()) return lut::bake(layout_from(options.lut, &model));
  lut::Table table = exports::read_shader_table(options.lut_path).table;
  try {
    lut::require_serves(model, table);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--lut {}: {}", options.lut_path, error.what()));
  }
  return table;
}

/// As trade::check_table; a driver that fails is no reason to do without an answer.
trade::TableCheck check_table(const brdf::BoundModel& model, const trade::Reference& reference,
                              const lut::Table& table, lut::Filter filter, ChosenDevice& chosen) {
  if (!chosen.device) return trade::check_table(model, reference, table, filter, nullptr);
  try {
    return trade::check_table(model, reference, table, filter, &*chosen.device);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("{}: {}; --device cpu does without it", chosen.text, error.what()));
  }
}

/// Checks the recommended tables in turn, until one keeps the limits on the device too: some filter
/// 8 bits with 8 bits.
void check_recommended(const brdf::BoundModel& model, const trade::Reference& reference,
                       ChosenDevice& device, LutCheckReport& report) {
  std::vector<trade::GoodTable>& tables = *report.recommended;
  while (!tables.empty()) {
    const auto& [layout, filter] = tables.front().table;
    const trade::TableCheck check =
        check_table(model, reference, lut::bake(layout), filter, device);
    if (trade::keeps(report.limits, trade::worst_error(check))) {
      report.check = check;
      return;
    }
    report.passed_over.push_back(check);
    tables.erase(tables.begin());
  }
}

void recommend(const brdf::BoundModel& model, const trade::Reference& reference,
               ChosenDevice& device, LutCheckReport& report) {
  const trade::TableLimits asked = trade::with_headroom(report.limits);
  report.recommended = trade::smallest_tables(model, reference, asked);
  if (report.recommended->empty() && asked.rms) {
    const trade::TableLimits tolerance{asked.largest, std::nullopt};
    report.some_keep_tolerance = !trade::smallest_tables(model, reference, tolerance).empty();
  }
  check_recommended(model, reference, device, report);
}

void check(const CheckOptions& options, Invocation& invocation) {
  const double tolerance = tolerance_in(options);
  const double max_theta_deg =
      parse_number_within("--max-theta", options.max_theta, 0, 90, "degrees, above 0, at most 90");
  const lut::Filter filter = filter_in(options);
  refuse_contradictions(options);
  const material::Material material = material::read_material(options.material);
  const brdf::BoundModel model = material::bind(material);
  const lut::Table table = table_in(options, model);
  ChosenDevice device = choose_device(options.device);
  const Samples samples = samples_for(options, material);
  const table::SampleTable* given = samples.table ? &*samples.table : nullptr;
  const trade::Reference reference =
      given != nullptr ? trade::reference_on_samples(model, material, *given, max_theta_deg)
                       : trade::reference_on_grid(model);
  const trade::FitErrors fit = trade::fit_errors(model, material, reference, given, max_theta_deg);

  LutCheckReport report{
      .path = options.material,
      .material = material,
      .device = device.text,
      .samples_path = given != nullptr ? std::optional(samples.path) : std::nullopt,
      .no_samples = samples.reason,
      .samples = reference.samples,
      .grid = reference.pairs.size() - reference.samples,
      .max_theta_deg = max_theta_deg,
      .default_tolerance = options.tolerance.empty(),
      .fit = fit,
      .residual_use = trade::residual_use(reference, fit.residual),
      .limits = trade::limits_of(reference, tolerance, fit.residual),
      .lut_path = options.lut_path,
      .check = {},
      .recommended = {},
      .passed_over = {},
      .some_keep_tolerance = false};
  if (options.recommend) {
    recommend(model, reference, device, report);
  } else {
    report.check = check_table(model, reference, table, filter, device);
  }
  if (options.json) {
    print_json(json_of(report));
  } else {
    print(text_of(report));
  }
  if (!within_tolerance(report)) invocation.exit_status = 1;
}

}  // namespace

void add_lut_check_command(CLI::App& lut, Invocation& invocation) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = lut.add_subcommand(
      "check", "The error of a look-up table beside that of the fit whose parameters it serves");
  command->add_option("MATERIAL", options->material, "The material (JSON)")->required();
  add_lut_options(*command, options->lut);
  command
      ->add_option(
          "--lut", options->lut_path,
          "A table baked before (gonio lut bake), in place of the options that describe one")
      ->type_name("FILE.exr");
  command->add_option("--filter", options->filter, "linear or nearest (default linear)")
      ->type_name("FILTER");
  add_device_option(*command, options->device);
  command
      ->add_option("--samples", options->samples,
                   "The measured table whose directions count (default: the one that the material "
                   "was fitted to, if it is there)")
      ->type_name("TABLE");
  command
      ->add_option("--max-theta", options->max_theta,
                   "Samples with a larger polar angle are left out, in degrees (default 80)")
      ->type_name("DEG");
  command
      ->add_option("--tolerance", options->tolerance,
                   "The largest error allowed, as a fraction of the specular lobe's peak (default "
                   "1/510: half a step of an 8-bit display)")
      ->type_name("X");
  command->add_flag("--recommend", options->recommend,
                    "Find the smallest table within the tolerance and 1 % of the fit's residual, "
                    "and check that one");
  command->add_flag("--json", options->json, "Print the result as JSON");
  add_table_options(*command, options->reading);
  command->callback([options, &invocation] {
    try {
      check(*options, invocation);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("lut check {}: {}", options->material, error.what()));
    }
  });
}

}  // namespace gonio::app
