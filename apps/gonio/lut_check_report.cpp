#include "apps/gonio/lut_check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "apps/gonio/command.h"

namespace gonio::app {
namespace {

using nlohmann::ordered_json;

std::string texels_of(const lut::Layout& layout) {
  return layout.height == 1 ? fmt::format("{}", layout.width)
                            : fmt::format("{}x{}", layout.width, layout.height);
}

std::string headline(const LutCheckReport& report) {
  std::string text =
      fmt::format("{}, {}\n", report.material.name.empty() ? report.path : report.material.name,
                  report.material.model);
  if (!report.check) return text;
  const auto& [layout, filter] = report.check->table;
  text += fmt::format(
      "table: {}, {} texels of {}, {} bytes, {} filter; coordinate {}, reach {:.3g}\n",
      lut::name_of(layout.kind), texels_of(layout), lut::name_of(layout.storage),
      trade::size_of(layout), lut::name_of(filter), lut::name_of(layout.coordinate), layout.reach);
  if (!report.lut_path.empty()) text += fmt::format("  of {}\n", report.lut_path);
  return text;
}

std::string conditions(const LutCheckReport& report) {
  std::string places =
      fmt::format("{} pairs dense in the lobe, incidence 0, 15, .. 75 deg", report.grid);
  if (report.check) {
    places += fmt::format(",\n  and {} pairs at the table's texels and between them",
                          report.check->at_texels);
  }
  std::string text = fmt::format("device: {}\n", report.device);
  if (report.samples_path) {
    text += fmt::format("directions: the {} samples of {} up to {:g} deg,\n  {}\n", report.samples,
                        *report.samples_path, report.max_theta_deg, places);
  } else {
    text += fmt::format("directions: {}\n  no samples: {}\n", places, report.no_samples);
  }
  return text;
}

std::string error_row(const LutCheckReport& report, std::string_view what,
                      const trade::EvaluatorError& error) {
  const auto& [theta_i, theta_o, channel] = error.where;
  return fmt::format("  {:<34} {:>9.2e}   {:>4.1f}, {:>4.1f} {:<8} {:>12.3e}\n", what,
                     error.largest, theta_i, theta_o, report.material.channels[channel], error.rms);
}

std::string percent(double share) {
  return share < 1 ? fmt::format("{:.3g}", 100 * share) : fmt::format("{:.0f}", 100 * share);
}

std::string rms_row(std::string_view what, const std::optional<double>& rms) {
  return fmt::format("  {:<34} {:>9}   {:<19} {:>12}\n", what, "", "",
                     rms ? fmt::format("{:.3e}", *rms) : "not fitted");
}

std::string errors(const LutCheckReport& report) {
  const trade::TableCheck& check = *report.check;
  std::string text = fmt::format("\n  {:<34} {:>9}   {:<19} {:>12}\n", "difference from the model",
                                 "of peak", "at theta_i, theta_o", "rms in 1/sr");
  if (check.analytic) text += error_row(report, "shader without a table", *check.analytic);
  text += error_row(report, "table, predicted", check.predicted);
  text += error_row(report, "table, predicted, weights of 1/256", check.predicted_quantised);
  if (check.measured) text += error_row(report, "shader with the table, measured", *check.measured);
  text += rms_row(report.samples_path ? "fit: measured less model" : "fit, by the material's file",
                  report.fit.residual);
  text += rms_row("parameters' standard deviation", report.fit.uncertainty);
  return text +
         "  of peak: of the specular lobe's, f_r; rms: of f_r cos_i, as the metric cosine-l2\n";
}

std::optional<double> share_of_residual(const LutCheckReport& report) {
  if (!report.check || !report.fit.residual || !(*report.fit.residual > 0)) return std::nullopt;
  return trade::worst_error(*report.check).rms / *report.fit.residual;
}

std::string_view name_of(trade::ResidualUse use) {
  switch (use) {
    case trade::ResidualUse::limits:
      return "limits";
    case trade::ResidualUse::unknown:
      return "unknown";
    case trade::ResidualUse::over_other_directions:
      return "over other directions";
    case trade::ResidualUse::below_float:
      return "below float arithmetic";
  }
  return {};
}

std::string weaker_part(const LutCheckReport& report) {
  const auto share = share_of_residual(report);
  if (!share) return "There is no fit's residual to set the table's error beside.\n";
  std::string text =
      fmt::format("Table error is {} % of the fit's residual: the {} is the weaker part.\n",
                  percent(*share), *share < 1 ? "model" : "table");
  if (report.residual_use == trade::ResidualUse::over_other_directions) {
    text +=
        "  That residual is over the fit's samples and the table's error is over the grid: with "
        "other\n"
        "  directions the two are not strictly comparable; --samples TABLE sets them side by "
        "side.\n";
  }
  return text;
}

std::string verdict(const LutCheckReport& report) {
  const double largest = trade::worst_error(*report.check).largest;
  const bool is_measured = largest > trade::predicted_error(*report.check).largest;
  return "\n" + weaker_part(report) +
         fmt::format("At most {:.2e} of the peak, {}: {} the tolerance of {:.2e}{}.\n", largest,
                     is_measured ? "measured" : "predicted",
                     within_tolerance(report) ? "within" : "PAST", report.limits.largest,
                     report.default_tolerance ? " (half a step of 8 bits)" : "");
}

/// "lobe" where the reach is that; else the number.
std::string reach_option(const lut::Layout& layout) {
  if (layout.reach == 1) return "full";
  return layout.reach == lut::lobe_reach(layout) ? "lobe" : fmt::format("{}", layout.reach);
}

/// The command that bakes the table; it says nothing of the filter, which is the shader's.
std::string bake_command(const LutCheckReport& report, const lut::Layout& layout) {
  return fmt::format(
      "gonio lut bake {} --table {} --size {} --coordinate {} --reach {} --format {} -o table.exr",
      shell_word(report.path), lut::name_of(layout.kind), texels_of(layout),
      lut::name_of(layout.coordinate), reach_option(layout), lut::name_of(layout.storage));
}

std::string limits(const LutCheckReport& report) {
  return fmt::format("{:.3g} of the peak{}", report.limits.largest,
                     report.limits.rms ? " and 1 % of the fit's residual" : "");
}

/// Why the tolerance alone decides, if it does.
std::string_view residual_note(trade::ResidualUse use) {
  switch (use) {
    case trade::ResidualUse::limits:
    case trade::ResidualUse::unknown:
      return "";
    case trade::ResidualUse::over_other_directions:
      return "The tolerance alone decides: there are no samples to compare with the fit's residual "
             "on.\n";
    case trade::ResidualUse::below_float:
      return "The tolerance alone decides: 1 % of the fit's residual is less than float arithmetic "
             "costs.\n";
  }
  return "";
}

std::string passed_over(const LutCheckReport& report) {
  std::string text;
  for (const trade::TableCheck& check : report.passed_over) {
    const lut::Layout& layout = check.table.layout;
    text +=
        fmt::format("Passed over: {}, {} texels of {}, as measured {:.2e} of the peak{}\n",
                    lut::name_of(layout.kind), texels_of(layout), lut::name_of(layout.storage),
                    trade::worst_error(check).largest,
                    report.limits.rms
                        ? fmt::format(", {} % of the residual",
                                      percent(trade::worst_error(check).rms / *report.fit.residual))
                        : "");
  }
  return text;
}

std::string no_table(const LutCheckReport& report) {
  const std::string text = fmt::format("No table of up to {} KiB stays within {}:\n",
                                       trade::most_bytes >> 10, limits(report));
  if (!report.passed_over.empty())
    return text +
           "those predicted to do so do not as the device reads them. Compute the lobe without a "
           "table.\n";
  if (report.some_keep_tolerance)
    return text +
           "1 % of the residual is what none keeps. Compute the lobe without a table, or choose "
           "one by\n--tolerance alone with --table.\n";
  return text +
         "the tolerance is what none keeps. Compute the lobe without a table, or allow more by "
         "--tolerance.\n";
}

std::string recommended_row(const LutCheckReport& report, const trade::GoodTable& good) {
  const auto& [layout, filter] = good.table;
  return fmt::format(
      "  {:>8}  {:<17} {:>9}  {:<11} {:>7.3g}  {:<7} {:<7} {:>9.2e} {:>12}\n", good.bytes,
      lut::name_of(layout.kind), texels_of(layout), lut::name_of(layout.coordinate), layout.reach,
      lut::name_of(layout.storage), lut::name_of(filter), good.error.largest,
      report.limits.rms ? percent(good.error.rms / *report.fit.residual) + " %" : "-");
}

std::string recommendation(const LutCheckReport& report) {
  const auto& tables = *report.recommended;
  std::string text = fmt::format("\n{}", residual_note(report.residual_use));
  if (tables.empty()) return text + no_table(report) + passed_over(report);
  text += fmt::format(
      "Smallest tables within {},\npredicted with exact weights and with those of 1/256:\n"
      "  {:>8}  {:<17} {:>9}  {:<11} {:>7}  {:<7} {:<7} {:>9} {:>12}\n",
      limits(report), "bytes", "table", "texels", "coordinate", "reach", "format", "filter",
      "of peak", "of residual");
  for (const trade::GoodTable& good : tables) text += recommended_row(report, good);
  for (const lut::Storage storage : lut::all_storages) {
    const bool is_there = std::any_of(tables.begin(), tables.end(), [&](const auto& good) {
      return good.table.layout.storage == storage;
    });
    if (!is_there) text += fmt::format("  {:>8}  of {}\n", "none", lut::name_of(storage));
  }
  return text + passed_over(report) +
         fmt::format("To bake the first:\n  {}\n",
                     bake_command(report, tables.front().table.layout));
}

ordered_json json_of(const LutCheckReport& report, const trade::EvaluatorError& error) {
  return {{"largest_of_peak", error.largest},
          {"theta_i_deg", error.where.theta_i_deg},
          {"theta_o_deg", error.where.theta_o_deg},
          {"channel", report.material.channels[error.where.channel]},
          {"rms", error.rms}};
}

ordered_json json_of(const LutCheckReport& report,
                     const std::optional<trade::EvaluatorError>& error) {
  return error ? json_of(report, *error) : ordered_json();
}

ordered_json json_of(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json();
}

ordered_json json_of(const trade::TableChoice& table) {
  const lut::Layout& layout = table.layout;
  return {{"table", lut::name_of(layout.kind)},
          {"width", layout.width},
          {"height", layout.height},
          {"coordinate", lut::name_of(layout.coordinate)},
          {"reach", layout.reach},
          {"format", lut::name_of(layout.storage)},
          {"filter", lut::name_of(table.filter)},
          {"bytes", trade::size_of(layout)}};
}

ordered_json recommended_json(const LutCheckReport& report) {
  ordered_json tables = ordered_json::array();
  for (const trade::GoodTable& good : *report.recommended) {
    ordered_json table = json_of(good.table);
    table["predicted"] = json_of(report, good.error);
    table["command"] = bake_command(report, good.table.layout);
    tables.push_back(table);
  }
  return tables;
}

}  // namespace

bool within_tolerance(const LutCheckReport& report) {
  return report.check && trade::worst_error(*report.check).largest <= report.limits.largest;
}

std::string text_of(const LutCheckReport& report) {
  std::string text = headline(report) + conditions(report);
  if (report.check) text += errors(report) + verdict(report);
  if (report.recommended) text += recommendation(report);
  return text;
}

ordered_json json_of(const LutCheckReport& report) {
  ordered_json json{
      {"material", report.material.name},
      {"model", report.material.model},
      {"device", report.device},
      {"directions",
       {{"table", report.samples_path ? ordered_json(*report.samples_path) : ordered_json()},
        {"samples", report.samples},
        {"grid", report.grid},
        {"max_theta_deg", report.max_theta_deg}}},
      {"fit",
       {{"residual", json_of(report.fit.residual)},
        {"uncertainty", json_of(report.fit.uncertainty)},
        {"residual_use", name_of(report.residual_use)}}},
      {"tolerance", report.limits.largest},
      {"within_tolerance", within_tolerance(report)}};
  if (report.check) {
    const trade::TableCheck& check = *report.check;
    json["table"] = json_of(check.table);
    json["table"]["file"] =
        report.lut_path.empty() ? ordered_json() : ordered_json(report.lut_path);
    json["directions"]["at_texels"] = check.at_texels;
    json["errors"] = {{"analytic", json_of(report, check.analytic)},
                      {"predicted", json_of(report, check.predicted)},
                      {"predicted_quantised", json_of(report, check.predicted_quantised)},
                      {"measured", json_of(report, check.measured)}};
    json["share_of_residual"] = json_of(share_of_residual(report));
  }
  if (report.recommended) {
    json["recommended"] = recommended_json(report);
    json["passed_over"] = ordered_json::array();
    for (const trade::TableCheck& check : report.passed_over) {
      ordered_json table = json_of(check.table);
      table["measured"] = json_of(report, check.measured);
      json["passed_over"].push_back(table);
    }
  }
  return json;
}

}  // namespace gonio::app
