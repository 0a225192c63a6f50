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

double number_in(std::string_view option, std::string_view text, std::string_view expected) {
  const std::optional<double> number = parse_number(text);
  if (!number || !std::isfinite(*number)) refuse(option, text, expected);
  return *number;
}

/// LO or LO:HI.
std::pair<double, double> range_in(std::string_view option, const std::string& text) {
  constexpr std::string_view expected = "a number or LOWEST:HIGHEST";
  const std::size_t colon = text.find(':');
  const double lowest = number_in(option, std::string_view(text).substr(0, colon), expected);
  if (colon == std::string::npos) return {lowest, lowest};
  return {lowest, number_in(option, std::string_view(text).substr(colon + 1), expected)};
}

int texels_in(std::string_view number, const std::string& size) {
  const std::string expected =
      fmt::format("N or NxM, each a whole number of {} to {} texels (M: or 1)", lut::least_size,
                  lut::largest_size);
  const double texels = number_in("--size", number, expected);
  // The layout says whether so many are possible.
  if (texels != std::floor(texels) || texels < 1 || texels > lut::largest_size) {
    refuse("--size", size, expected);
  }
  return static_cast<int>(texels);
}

bool is_strauss(TableKind kind) {
  return kind == TableKind::strauss_j || kind == TableKind::strauss_terms;
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

/// The range of --alpha or --exponent; nothing if it is not given.
std::optional<std::pair<double, double>> range_of_lobes(const LutOptions& options, TableKind kind) {
  const bool of_exponent = kind == TableKind::blinn_phong_power;
  const std::string_view option = of_exponent ? "--exponent" : "--alpha";
  const std::string& given = of_exponent ? options.exponent : options.alpha;
  if (!given.empty()) return range_in(option, given);
  const bool serves_any =
      kind == TableKind::ward_exponent &&
      (options.format.empty() || options.format == "r32f" || options.format == "r16f");
  if (serves_any || is_strauss(kind)) return std::nullopt;
  throw std::invalid_argument(
      fmt::format("{} is missing: {}{} serves given values only; or name a material", option,
                  lut::name_of(kind),
                  kind == TableKind::ward_exponent ? " in " + options.format : std::string()));
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
  check("--alpha", options.alpha);
  check("--exponent", options.exponent);
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
  if (is_strauss(layout.kind)) layout.height = layout.width;
  const bool has_rows = layout.kind != TableKind::ward_exponent && layout.lowest < layout.highest;
  if (has_rows) layout.height = lut::rows_of_a_range;
  return layout;
}

Layout layout_of_material(const LutOptions& options, const brdf::BoundModel& model) {
  refuse_beside_material(options);
  if (!options.table.empty()) {
    return lut::layout_for(model, lut::table_kind_named(options.table));
  }
  const std::vector<TableKind> tables = lut::tables_for(model.model());
  return lut::layout_for(model, tables.empty() ? TableKind::ward_exponent : tables.front());
}

}  // namespace

void add_lut_options(CLI::App& command, LutOptions& options) {
  command.add_option("--table", options.table, names_in(lut::all_table_kinds))->type_name("TABLE");
  command
      .add_option("--size", options.size,
                  fmt::format("Texels, {} to {} along each axis; without M as many rows as the "
                              "parameters need (default 512)",
                              lut::least_size, lut::largest_size))
      ->type_name("N[xM]");
  command
      .add_option("--coordinate", options.coordinate,
                  fmt::format("{} (default cosine)", names_in(lut::all_coordinates)))
      ->type_name("NAME");
  command
      .add_option("--reach", options.reach,
                  "The largest 1 - n.h: full (1), lobe (as far as the widest lobe served is not "
                  "0, the default where it is known), or a number")
      ->type_name("REACH");
  command
      .add_option("--format", options.format,
                  fmt::format("{} (default r32f)", names_in(lut::all_storages)))
      ->type_name("FORMAT");
}

void add_lut_parameter_options(CLI::App& command, LutOptions& options) {
  command
      .add_option("--alpha", options.alpha, "The roughness that a ward table serves, or a range")
      ->type_name("LO[:HI]");
  command
      .add_option("--exponent", options.exponent,
                  "The exponent that blinn-phong-power serves, or a range")
      ->type_name("LO[:HI]");
  command.add_option("--t", options.transparency, "The t of strauss-terms (default 0)")
      ->type_name("T");
  command.add_option("--model", options.model, "strauss or strauss-listing, for strauss-j")
      ->type_name("MODEL");
}

lut::Layout layout_from(const LutOptions& options, const brdf::BoundModel* model) {
  Layout layout =
      model != nullptr ? layout_of_material(options, *model) : layout_without_material(options);
  if (!options.coordinate.empty()) layout.coordinate = lut::coordinate_named(options.coordinate);
  if (!options.format.empty()) layout.storage = lut::storage_named(options.format);
  apply_size(options.size, layout);
  const bool knows_lobe = model != nullptr || !options.alpha.empty() || !options.exponent.empty() ||
                          is_strauss(layout.kind);
  apply_reach(options.reach, knows_lobe, layout);
  lut::check(layout);
  return layout;
}

}  // namespace gonio::app
