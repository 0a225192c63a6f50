#include "lut/layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "brdf/ward.h"

namespace gonio::lut {
namespace {

/// The item of that name in a list of things that name_of() names.
template <class List>
auto named(const List& list, std::string_view name, std::string_view what) {
  std::vector<std::string_view> names;
  for (const auto item : list) {
    if (name_of(item) == name) return item;
    names.push_back(name_of(item));
  }
  throw std::invalid_argument(
      fmt::format("unknown {} '{}', expected {}", what, name, fmt::join(names, ", ")));
}

bool is_ward(TableKind kind) {
  return kind == TableKind::ward_exponent || kind == TableKind::ward_lobe;
}

[[noreturn]] void refuse(const Layout& layout, const std::string& problem) {
  throw std::invalid_argument(fmt::format("{}: {}", name_of(layout.kind), problem));
}

bool is_size(int size) { return size >= least_size && size <= largest_size; }

void check_size(const Layout& layout) {
  if (!is_size(layout.width)) {
    refuse(layout, fmt::format("found a width of {} texels, expected {} to {}", layout.width,
                               least_size, largest_size));
  }
  if (layout.kind == TableKind::ward_exponent && layout.height != 1) {
    refuse(layout, fmt::format("found a height of {} texels, expected 1: the exponent has one "
                               "axis; ward-lobe has two",
                               layout.height));
  }
  const bool one_row = layout.height == 1 && !is_strauss(layout.kind);
  if (!one_row && !is_size(layout.height)) {
    refuse(layout, fmt::format("found a height of {} texels, expected {}{} to {}", layout.height,
                               is_strauss(layout.kind) ? "" : "1 or ", least_size, largest_size));
  }
}

void check_axis(const Layout& layout) {
  if (!(layout.reach > 0 && layout.reach <= 1)) {
    refuse(layout,
           fmt::format("found a reach of {}, expected above 0 and at most 1", layout.reach));
  }
  const bool whole_axis = is_strauss(layout.kind) || layout.coordinate == Coordinate::listing;
  if (whole_axis && layout.reach != 1) {
    refuse(layout, fmt::format("found a reach of {}, expected 1 (full): this table runs over the "
                               "whole axis",
                               layout.reach));
  }
  if (layout.kind == TableKind::strauss_terms && layout.coordinate != Coordinate::cosine) {
    refuse(layout, fmt::format("found the coordinate {}, expected cosine: the axes are s and m "
                               "themselves",
                               name_of(layout.coordinate)));
  }
  if (layout.coordinate != Coordinate::listing) return;
  if (layout.kind != TableKind::ward_exponent) {
    refuse(layout,
           "found the coordinate listing, expected cosine, sqrt or fourth-root: the published "
           "table is of ward-exponent only");
  }
  if (layout.storage != Storage::r32f && layout.storage != Storage::r16f) {
    refuse(layout, fmt::format("found the storage {} with the coordinate listing, expected r32f "
                               "or r16f: its texels fall to -5e14",
                               name_of(layout.storage)));
  }
}

struct Bounds {
  std::string_view name;
  double lower, upper;
};

Bounds bounds_of(TableKind kind) {
  if (is_ward(kind)) {
    const brdf::Parameter alpha = brdf::ward_roughness("alpha", {});
    return {alpha.name, alpha.lower, alpha.upper};
  }
  const brdf::Parameter exponent = brdf::cosine_exponent("exponent", {}, {});
  return {exponent.name, exponent.lower, exponent.upper};
}

void check_half_float(const Layout& layout) {
  if (layout.storage != Storage::r16f) return;
  if (layout.highest <= most_alphas_of_half * layout.lowest) return;
  refuse(layout,
         fmt::format("found alpha from {} to {} for the storage r16f, expected alphas within "
                     "a factor of {}; r32f serves any",
                     layout.lowest, layout.highest, most_alphas_of_half));
}

void check_parameters(const Layout& layout) {
  if (is_strauss(layout.kind)) {
    if (!(layout.transparency >= 0 && layout.transparency <= 1)) {
      refuse(layout, fmt::format("found t = {}, expected 0 to 1", layout.transparency));
    }
    return;
  }
  const Bounds bounds = bounds_of(layout.kind);
  const bool in_bounds = layout.lowest >= bounds.lower && layout.highest <= bounds.upper;
  if (!(in_bounds && layout.lowest <= layout.highest)) {
    refuse(layout,
           fmt::format("found {} from {} to {}, expected a range within {} to {}", bounds.name,
                       layout.lowest, layout.highest, bounds.lower, bounds.upper));
  }
  if (layout.kind == TableKind::ward_exponent) {
    check_half_float(layout);
    return;
  }
  const bool one_value = layout.lowest == layout.highest;
  if (layout.height == 1 && !one_value) {
    refuse(layout,
           fmt::format("found a height of 1 texel for {} from {} to {}, expected at least "
                       "{} rows, or one {}",
                       bounds.name, layout.lowest, layout.highest, least_size, bounds.name));
  }
  if (layout.height > 1 && (one_value || layout.lowest <= 0)) {
    refuse(layout, fmt::format("found {} from {} to {} for {} rows, expected a range above 0, or "
                               "a height of 1 texel",
                               bounds.name, layout.lowest, layout.highest, layout.height));
  }
}

/// What a term gives to be read from a table; the term's shape parameters may be served by rows.
enum class Family { none, ward, blinn_phong, strauss };

Family family_of(const brdf::TermDescription& term) {
  constexpr std::array ward{"ward",     "ward-aniso",    "ward-duer", "ward-duer-aniso",
                            "ward-gmd", "ward-gmd-aniso"};
  if (std::find(ward.begin(), ward.end(), term.name) != ward.end()) return Family::ward;
  if (term.name == "blinn-phong") return Family::blinn_phong;
  if (term.name == "strauss" || term.name == "strauss-listing") return Family::strauss;
  return Family::none;
}

Family family_of(TableKind kind) {
  if (is_ward(kind)) return Family::ward;
  return is_strauss(kind) ? Family::strauss : Family::blinn_phong;
}

void take_shape_of(const brdf::BoundModel& model, Layout& layout) {
  std::optional<double> lowest;
  std::optional<double> highest;
  std::size_t first = 0;
  for (const brdf::TermEntry* term : model.model().terms()) {
    const std::span<const double> shape = model.shape().subspan(first, term->shape.size());
    first += shape.size();
    if (!is_served(term->description, layout.kind)) continue;
    if (is_strauss(layout.kind)) {
      layout.of_cosine = term->description.name == "strauss-listing";
      layout.transparency = shape[2];
      return;
    }
    // One value, or those along x and y: the tangent's angle is no row.
    for (const double value : shape.first(term->description.anisotropic ? 2 : 1)) {
      lowest = std::min(lowest.value_or(value), value);
      highest = std::max(highest.value_or(value), value);
    }
  }
  layout.lowest = lowest.value();
  layout.highest = highest.value();
}

void check_has_table(const brdf::Model& model, TableKind kind) {
  const std::vector<TableKind> tables = tables_for(model);
  if (std::find(tables.begin(), tables.end(), kind) != tables.end()) return;
  if (tables.empty()) {
    throw std::invalid_argument(
        fmt::format("the model {} has no table; ward, ward-duer, ward-gmd (also -aniso), "
                    "blinn-phong, strauss and strauss-listing have",
                    model.name()));
  }
  std::vector<std::string_view> names;
  for (const TableKind table : tables) names.push_back(name_of(table));
  throw std::invalid_argument(fmt::format("found the table {} for the model {}: expected {}",
                                          name_of(kind), model.name(), fmt::join(names, " or ")));
}

}  // namespace

bool is_strauss(TableKind kind) {
  return kind == TableKind::strauss_j || kind == TableKind::strauss_terms;
}

int channels_of(TableKind kind) { return is_strauss(kind) ? 2 : 1; }

std::string_view parameter_of(TableKind kind) { return bounds_of(kind).name; }

std::string_view name_of(TableKind kind) {
  switch (kind) {
    case TableKind::ward_exponent:
      return "ward-exponent";
    case TableKind::ward_lobe:
      return "ward-lobe";
    case TableKind::blinn_phong_power:
      return "blinn-phong-power";
    case TableKind::strauss_j:
      return "strauss-j";
    case TableKind::strauss_terms:
      return "strauss-terms";
  }
  return {};
}

std::string_view name_of(Coordinate coordinate) {
  switch (coordinate) {
    case Coordinate::listing:
      return "listing";
    case Coordinate::cosine:
      return "cosine";
    case Coordinate::sqrt:
      return "sqrt";
    case Coordinate::fourth_root:
      return "fourth-root";
  }
  return {};
}

TableKind table_kind_named(std::string_view name) { return named(all_table_kinds, name, "table"); }

Coordinate coordinate_named(std::string_view name) {
  return named(all_coordinates, name, "coordinate");
}

Storage storage_named(std::string_view name) { return named(all_storages, name, "storage"); }

Filter filter_named(std::string_view name) { return named(all_filters, name, "filter"); }

void check(const Layout& layout) {
  check_size(layout);
  // First: the reach may have been found from them.
  check_parameters(layout);
  check_axis(layout);
}

bool has_rows(const Layout& layout) { return !is_strauss(layout.kind) && layout.height > 1; }

bool serves_any_alpha(const Layout& layout) {
  return layout.kind == TableKind::ward_exponent && layout.reach == 1 &&
         layout.storage == Storage::r32f;
}

double lobe_reach(const Layout& layout) {
  if (is_strauss(layout.kind)) return 1;
  if (layout.kind == TableKind::blinn_phong_power) {
    return layout.lowest > 0 ? -std::expm1(-negligible_decay / layout.lowest) : 1;
  }
  const double tangent2 = negligible_decay * layout.highest * layout.highest;
  const double cosine = 1 / std::sqrt(1 + tangent2);
  return tangent2 / (1 + tangent2) / (1 + cosine);
}

template <class T>
T texture_coordinate(const Layout& layout, int size, T w) {
  if (layout.coordinate == Coordinate::listing) return T(1) - w / T(2);
  T c = std::max(w / static_cast<T>(layout.reach), T(0));
  if (layout.coordinate == Coordinate::sqrt) c = std::sqrt(c);
  if (layout.coordinate == Coordinate::fourth_root) c = std::sqrt(std::sqrt(c));
  return (c * static_cast<T>(size - 1) + T(0.5)) / static_cast<T>(size);
}

template float texture_coordinate(const Layout&, int, float);
template double texture_coordinate(const Layout&, int, double);

double distance_at(const Layout& layout, double c) {
  switch (layout.coordinate) {
    case Coordinate::listing:
      return 2 * (1 - c);
    case Coordinate::cosine:
      return layout.reach * c;
    case Coordinate::sqrt:
      return layout.reach * c * c;
    case Coordinate::fourth_root:
      return layout.reach * (c * c) * (c * c);
  }
  return 0;
}

template <class T>
T row_coordinate(const Layout& layout, T parameter) {
  if (layout.height == 1) return T(0.5);
  const T lowest = static_cast<T>(layout.lowest);
  const T scale = static_cast<T>(1 / std::log(layout.highest / layout.lowest));
  const T share = parameter > lowest ? std::log(parameter / lowest) * scale : T(0);
  const T rows = static_cast<T>(layout.height);
  return (std::min(share, T(1)) * (rows - T(1)) + T(0.5)) / rows;
}

template float row_coordinate(const Layout&, float);
template double row_coordinate(const Layout&, double);

bool is_served(const brdf::TermDescription& term, TableKind kind) {
  return family_of(term) == family_of(kind);
}

std::vector<TableKind> tables_for(const brdf::Model& model) {
  std::vector<TableKind> tables;
  for (const TableKind kind : all_table_kinds) {
    const auto serves = [&](const brdf::TermEntry* t) { return is_served(t->description, kind); };
    if (std::any_of(model.terms().begin(), model.terms().end(), serves)) tables.push_back(kind);
  }
  return tables;
}

int rows_for(const Layout& layout) {
  if (is_strauss(layout.kind)) return layout.width;
  const bool is_range = layout.lowest < layout.highest;
  return is_range && layout.kind != TableKind::ward_exponent ? rows_of_a_range : 1;
}

Layout layout_for(const brdf::BoundModel& model, TableKind kind) {
  check_has_table(model.model(), kind);
  Layout layout;
  layout.kind = kind;
  take_shape_of(model, layout);
  layout.height = rows_for(layout);
  return layout;
}

}  // namespace gonio::lut
