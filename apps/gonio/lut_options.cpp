#include "apps/gonio/lut_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "apps/gonio/command.h"

namespace gonio::app {
namespace {

using lut::Layout;
using lut::TableKind;

/// The largest and smallest roughness of the models: what a table over all angles serves.
constexpr std::pair<double, double> any_alpha{1e-4, 10};

template <class List>
std::string names_in(const List& list) {
  std::vector<std::string_view> names;
  for (const auto item : list) names.push_back(lut::name_of(item));
  return fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void refuse(std::string_view option, std::string_view found,
                         std::string_view expected) {
  throw std::invalid_argument(fmt::format("{}: found '{}', expected {}", option, found, expected));
}

/// The number of a part of an option's text.
double number_in(std::string_view option, std::string_view part, std::string_view text,
                 std::string_view expected) {
  const std::optional<double> number = parse_number(part);
  if (!number || !std::isfinite(*number)) refuse(option, text, expected);
  return *number;
}

double number_in(std::string_view option, std::string_view text, std::string_view expected) {
  return number_in(option, text, text, expected);
}

/// LO or LO:HI.
std::pair<double, double> range_in(std::string_view option, const std::string& text) {
  constexpr std::string_view expected = "a number or LOWEST:HIGHEST";
  const std::size_t colon = text.find(':');
  const double lowest = number_in(option, std::string_view(text).substr(0, colon), text, expected);
  if (colon == std::string::npos) return {lowest, lowest};
  return {lowest, number_in(option, std::string_view(text).substr(colon + 1), text, expected)};
}

int texels_in(std::string_view number, const std::string& size) {
  const std::string expected =
      fmt::format("N or NxM, each a whole number of {} to {} texels (M: or 1)", lut::least_size,
                  lut::largest_size);
  const double texels = number_in("--size", number, size, expected);
  // The layout says whether so many are possible.
  if (texels != std::floor(texels) || texels < 1 || texels > lut::largest_size) {
    refuse("--size", size, expected);
  }
  return static_cast<int>(texels);
}

void apply_size(const std::string& size, Layout& layout) {
  if (size.empty()) return;
  const std::size_t cross = size.find('x');
  layout.width = texels_in(std::string_view(size).substr(0, cross), size);
  if (cross != std::string::npos) {
    layout.height = texels_in(std::string_view(size).substr(cross + 1), size);
  } else if (is_strauss(layout.kind)) {
    layout.height = layout.width;
  }
}

void apply_reach(const std::string& reach, bool has_parameters, Layout& layout) {
  const bool is_whole = layout.coordinate == lut::Coordinate::listing || !has_parameters;
  if (reach == "full" || (reach.empty() && is_whole)) return;
  if (reach.empty() || reach == "lobe") {
    if (!has_parameters) {
      throw std::invalid_argument(
          "--reach lobe: the lobe is not known, expected a material or --alpha");
    }
    layout.reach = lut::lobe_reach(layout);
    return;
  }
  layout.reach =
      number_in("--reach", reach, "full, lobe, or the largest 1 - n.h, above 0 and at most 1");
}

/// The option that says which lobes a table serves, as given.
struct LobeOption {
  std::string_view name;
  const std::string& given;
};

LobeOption option_of_lobes(const LutOptions& options, TableKind kind) {
  if (kind == TableKind::blinn_phong_power) return {"--exponent", options.exponent};
  return {"--alpha", options.alpha};
}

/// The range of --alpha or --exponent; nothing if it is not given.
std::optional<std::pair<double, double>> range_of_lobes(const LutOptions& options, TableKind kind) {
  const auto& [option, given] = option_of_lobes(options, kind);
  if (!given.empty()) return range_in(option, given);
  const bool is_any_alpha =
      kind == TableKind::ward_exponent && (options.format.empty() || options.format == "r32f");
  if (is_any_alpha || is_strauss(kind)) return std::nullopt;
  throw std::invalid_argument(
      fmt::format("{} is missing: {}{} serves given values only; or name a material", option,
                  lut::name_of(kind),
                  kind == TableKind::ward_exponent ? " in " + options.format : std::string()));
}

/// Lets a material's table serve the range of --alpha or --exponent, if it is given.
void widen(const LutOptions& options, Layout& layout) {
  const auto& [option, given] = option_of_lobes(options, layout.kind);
  if (given.empty()) return;
  const auto [lowest, highest] = range_in(option, given);
  if (!(lowest <= layout.lowest && layout.highest <= highest)) {
    refuse(
        option, given,
        layout.lowest == layout.highest
            ? fmt::format("a range with the material's {}", layout.lowest)
            : fmt::format("a range with the material's {} to {}", layout.lowest, layout.highest));
  }
  layout.lowest = lowest;
  layout.highest = highest;
  layout.height = lut::rows_for(layout);
}

void refuse_unused(const LutOptions& options, TableKind kind) {
  const bool is_power = kind == TableKind::blinn_phong_power;
  const bool is_ward = !is_power && !is_strauss(kind);
  const auto check = [&](std::string_view option, const std::string& given, bool is_used) {
    if (given.empty() || is_used) return;
    throw std::invalid_argument(
        fmt::format("{} {}: {} does not depend on it", option, given, lut::name_of(kind)));
  };
  check("--alpha", options.alpha, is_ward);
  check("--exponent", options.exponent, is_power);
  check("--t", options.transparency, kind == TableKind::strauss_terms);
  check("--model", options.model, kind == TableKind::strauss_j);
}

void refuse_beside_material(const LutOptions& options) {
  const auto check = [](std::string_view option, const std::string& given) {
    if (given.empty()) return;
    throw std::invalid_argument(
        fmt::format("{} {}: the material says it, expected no such option", option, given));
  };
  check("--t", options.transparency);
  check("--model", options.model);
}

/// The layout for the parameters on the command line.
Layout layout_without_material(const LutOptions& options) {
  if (options.table.empty()) {
    throw std::invalid_argument(fmt::format("which table? expected a material, or --table {}",
                                            names_in(lut::all_table_kinds)));
  }
  Layout layout;
  layout.kind = lut::table_kind_named(options.table);
  refuse_unused(options, layout.kind);
  std::tie(layout.lowest, layout.highest) =
      range_of_lobes(options, layout.kind)
          .value_or(is_strauss(layout.kind) ? std::pair{1.0, 1.0} : any_alpha);
  if (!options.transparency.empty()) {
    layout.transparency = number_in("--t", options.transparency, "a number of 0 to 1");
  }
  if (!options.model.empty() && options.model != "strauss" && options.model != "strauss-listing") {
    refuse("--model", options.model, "strauss or strauss-listing");
  }
  layout.of_cosine = options.model == "strauss-listing";
  layout.height = lut::rows_for(layout);
  return layout;
}

Layout layout_of_material(const LutOptions& options, const brdf::BoundModel& model) {
  refuse_beside_material(options);
  const std::vector<TableKind> tables = lut::tables_for(model.model());
  const TableKind first = tables.empty() ? TableKind::ward_exponent : tables.front();
  const TableKind kind = options.table.empty() ? first : lut::table_kind_named(options.table);
  Layout layout = lut::layout_for(model, kind);
  refuse_unused(options, kind);
  widen(options, layout);
  return layout;
}

/// Of a range of lobes the narrowest needs its texels close to the peak; strauss-j is steep at the
/// horizon.
lut::Coordinate coordinate_in(const LutOptions& options, const Layout& layout) {
  if (!options.coordinate.empty()) return lut::coordinate_named(options.coordinate);
  if (layout.kind == TableKind::strauss_j) return lut::Coordinate::sqrt;
  return layout.lowest < layout.highest ? lut::Coordinate::fourth_root : lut::Coordinate::cosine;
}

/// An empty text stands for an option that is not given, and so cannot be given.
CLI::Option* add_text_option(CLI::App& command, const std::string& name, std::string& text,
                             const std::string& description) {
  const auto problem = [](const std::string& given) -> std::string {
    return given.empty() ? "found nothing, expected a value" : "";
  };
  return command.add_option(name, text, description)->check(CLI::Validator(problem, ""));
}

}  // namespace

void add_lut_options(CLI::App& command, LutOptions& options) {
  add_text_option(command, "--table", options.table, names_in(lut::all_table_kinds))
      ->type_name("TABLE");
  add_text_option(command, "--size", options.size,
                  fmt::format("Texels, {} to {} along each axis; without M as many rows as the "
                              "parameters need (default 512)",
                              lut::least_size, lut::largest_size))
      ->type_name("N[xM]");
  add_text_option(command, "--coordinate", options.coordinate,
                  fmt::format("{} (default: cosine for one alpha or exponent, fourth-root for a "
                              "range or any alpha, sqrt for strauss-j)",
                              names_in(lut::all_coordinates)))
      ->type_name("NAME");
  add_text_option(command, "--reach", options.reach,
                  "The largest 1 - n.h: full (1), lobe (as far as the widest lobe served is not "
                  "0, the default where it is known), or a number")
      ->type_name("REACH");
  add_text_option(command, "--format", options.format,
                  fmt::format("{} (default r32f)", names_in(lut::all_storages)))
      ->type_name("FORMAT");
  add_text_option(command, "--alpha", options.alpha,
                  "The roughness that a ward table serves, or a range (default the material's)")
      ->type_name("LO[:HI]");
  add_text_option(command, "--exponent", options.exponent,
                  "The exponent that blinn-phong-power serves, or a range (default the material's)")
      ->type_name("LO[:HI]");
}

void add_lut_parameter_options(CLI::App& command, LutOptions& options) {
  add_text_option(command, "--t", options.transparency, "The t of strauss-terms (default 0)")
      ->type_name("T");
  add_text_option(command, "--model", options.model, "strauss or strauss-listing, for strauss-j")
      ->type_name("MODEL");
}

lut::Layout layout_from(const LutOptions& options, const brdf::BoundModel* model) {
  Layout layout =
      model != nullptr ? layout_of_material(options, *model) : layout_without_material(options);
  layout.coordinate = coordinate_in(options, layout);
  if (!options.format.empty()) layout.storage = lut::storage_named(options.format);
  apply_size(options.size, layout);
  const bool knows_lobe = model != nullptr || !options.alpha.empty() || !options.exponent.empty() ||
                          is_strauss(layout.kind);
  apply_reach(options.reach, knows_lobe, layout);
  lut::check(layout);
  return layout;
}

}  // namespace gonio::app
