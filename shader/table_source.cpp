#include "shader/table_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shader/literal.h"

namespace gonio::shader {
namespace {

using brdf::TermKind;
using lut::Coordinate;
using lut::TableKind;

/// The lobes from their numerators, and strauss from its terms.
std::vector<TermSource> make_lobe_sources() {
  std::vector<TermSource> sources;
  const auto add_ward = [&](std::string_view term, std::string_view term_aniso,
                            std::string_view name,
                            const std::vector<std::string_view>& directions) {
    sources.push_back({term, TermKind::specular, name, {"alpha", "alpha"}, directions, {"rho_s"}});
    sources.push_back(
        {term_aniso, TermKind::specular, name, {"alpha_x", "alpha_y"}, directions, {"rho_s"}});
  };
  add_ward("ward", "ward-aniso", "ward_lobe", {"wi", "wo"});
  add_ward("ward-duer", "ward-duer-aniso", "ward_duer_lobe", {"wi", "wo"});
  add_ward("ward-gmd", "ward-gmd-aniso", "ward_gmd_lobe", {"h"});
  sources.push_back({"blinn-phong", TermKind::specular, "", {}, {}, {"ks"}});
  return sources;
}

std::vector<TermSource> make_sources_of_j() {
  std::vector<TermSource> sources;
  for (const std::string_view term : {"strauss", "strauss-listing"}) {
    sources.push_back({term,
                       TermKind::whole,
                       "strauss_by_j",
                       {"s", "m", "one_minus_s", "one_minus_m", "one_minus_t"},
                       {"wi", "wo"},
                       {"c", ""}});
  }
  return sources;
}

std::vector<TermSource> make_sources_of_shares() {
  const std::vector<std::string_view> shape{"m", "one_minus_s", "one_minus_m"};
  return {{"strauss", TermKind::whole, "strauss_by_shares", shape, {"wi", "wo"}, {"c", ""}},
          {"strauss-listing",
           TermKind::whole,
           "strauss_listing_by_shares",
           shape,
           {"wi", "wo"},
           {"c", ""}}};
}

const std::vector<TermSource>& sources_of(TableKind kind) {
  static const std::vector<TermSource> lobes = make_lobe_sources();
  static const std::vector<TermSource> of_j = make_sources_of_j();
  static const std::vector<TermSource> of_shares = make_sources_of_shares();
  if (kind == TableKind::strauss_j) return of_j;
  return kind == TableKind::strauss_terms ? of_shares : lobes;
}

/// The HLSL of a coordinate is gonio_NAME in NAME.hlsl.
std::string_view source_of(Coordinate coordinate) {
  switch (coordinate) {
    case Coordinate::listing:
      return "table_listing";
    case Coordinate::cosine:
      return "table_cosine";
    case Coordinate::sqrt:
      return "table_sqrt";
    case Coordinate::fourth_root:
      break;
  }
  return "table_fourth_root";
}

/// The texture coordinate of a distance from the steepest place, for an axis of `size` texels.
std::string coordinate_of(const lut::Layout& layout, const std::string& distance, int size) {
  if (layout.coordinate == Coordinate::listing)
    return fmt::format("gonio_table_listing({})", distance);
  return fmt::format("gonio_{}({}, {}, {})", source_of(layout.coordinate), distance,
                     literal(1 / layout.reach), literal(size));
}

/// 1/alpha^2 of an anisotropic lobe where the half vector is.
std::string inverse_alpha2(const TableTerm& term) {
  const auto of = [&](std::size_t i) { return literal(1 / (term.shape[i] * term.shape[i])); };
  if (!term.entry.description.anisotropic) return of(0);
  return fmt::format("gonio_at_azimuth({}, {}, {})", of(0), of(1), term.half_vector);
}

/// The second texture coordinate of a lobe.
std::string row_of(const lut::Layout& layout, const TableTerm& term) {
  if (!(has_rows(layout) && term.entry.description.anisotropic)) {
    return literal(lut::row_coordinate(layout, term.shape[0]));
  }
  return fmt::format("gonio_table_row(1.0 / sqrt({}), {}, {}, {})", inverse_alpha2(term),
                     literal(1 / layout.lowest), literal(std::log(layout.highest / layout.lowest)),
                     literal(layout.height));
}

/// What strauss-j is read at for a direction.
std::string distance_of(const lut::Layout& layout, std::string_view direction) {
  return layout.of_cosine ? fmt::format("gonio_versine({})", direction)
                          : fmt::format("{}.z", direction);
}

/// The texture coordinates that a term is read at.
struct Place {
  std::string u;
  std::string v;
};

Place place_of(const lut::Layout& layout, const TableTerm& term) {
  switch (layout.kind) {
    case TableKind::strauss_j:
      return {coordinate_of(layout, distance_of(layout, "wi"), layout.width),
              coordinate_of(layout, distance_of(layout, "wo"), layout.height)};
    case TableKind::strauss_terms:
      return {literal(lut::texture_coordinate(layout, layout.width, term.shape[0])),
              literal(lut::texture_coordinate(layout, layout.height, term.shape[1]))};
    default:
      break;
  }
  const std::string versine = fmt::format("gonio_half_vector_versine({})", term.half_vector);
  return {coordinate_of(layout, versine, layout.width), row_of(layout, term)};
}

std::size_t components_of(TableKind kind) {
  return static_cast<std::size_t>(lut::channels_of(kind));
}

/// The texture's value at the coordinates uv, decoded.
std::string decoded(const TableText& table, const std::string& uv) {
  const std::size_t channels = components_of(table.layout.kind);
  std::vector<double> scale;
  for (std::size_t c = 0; c < channels; ++c) {
    scale.push_back(double(table.decoding[c].scale));
  }
  const bool is_plain = std::all_of(scale.begin(), scale.end(), [](double s) { return s == 1; });
  const std::string texel =
      fmt::format("{}({}).{}", table.function, uv, std::string_view("xy").substr(0, channels));
  return is_plain ? texel : fmt::format("{} * {}", value_of(scale), texel);
}

}  // namespace

const TermSource* table_source(const brdf::TermEntry& term, TableKind kind) {
  if (!lut::is_served(term.description, kind)) return nullptr;
  const std::vector<TermSource>& sources = sources_of(kind);
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const TermSource& source) {
    return source.term == term.description.name && source.kind == term.description.kind;
  });
  if (found == sources.end()) {
    throw std::logic_error(
        fmt::format("the term '{}' has no HLSL source that reads the table {}; add it to "
                    "shader/hlsl and to the lists in shader/table_source.cpp",
                    term.description.name, lut::name_of(kind)));
  }
  return &*found;
}

bool takes_half_vector(TableKind kind) { return !is_strauss(kind); }

std::string table_reading(const TableText& table, const TableTerm& term,
                          const std::string& variable) {
  const Place place = place_of(table.layout, term);
  const std::string uv = variable + "_uv";
  std::string value = decoded(table, uv);
  if (table.layout.kind == TableKind::ward_exponent) {
    value = fmt::format("gonio_table_decay({}, {}, {})", value, inverse_alpha2(term),
                        literal(double(lut::end_of_exponent(table.layout))));
  }
  return fmt::format("  float2 {0} = float2({1},\n{2:{3}}{4});\n  {5} {6} = {7};\n", uv, place.u,
                     "", std::string_view("  float2  = float2(").size() + uv.size(), place.v,
                     type_of(components_of(table.layout.kind)), variable, value);
}

std::vector<std::string_view> table_files(const lut::Layout& layout,
                                          std::span<const brdf::TermEntry* const> served) {
  if (layout.kind == TableKind::strauss_terms) return {};
  std::vector<std::string_view> files{source_of(layout.coordinate)};
  if (takes_half_vector(layout.kind)) {
    files.emplace_back("half_vector_versine");
  } else if (layout.of_cosine) {
    files.emplace_back("versine");
  }
  if (layout.kind == TableKind::ward_exponent) files.emplace_back("table_decay");
  const bool has_azimuth = std::any_of(
      served.begin(), served.end(), [](const auto* term) { return term->description.anisotropic; });
  if (has_azimuth && (has_rows(layout) || layout.kind == TableKind::ward_exponent)) {
    files.emplace_back("at_azimuth");
    if (has_rows(layout)) files.emplace_back("table_row");
  }
  return files;
}

std::string table_signature(const TableText& table) {
  return fmt::format("float4 {}(float2 uv)", table.function);
}

std::vector<std::string> table_comment(const TableText& table) {
  const lut::Layout& layout = table.layout;
  const std::string_view channels =
      components_of(layout.kind) == 1 ? "channel in .x" : "channels in .x and .y";
  return {
      fmt::format("is for the shader around this one to define: the texture {}, over the",
                  lut::name_of(layout.kind)),
      fmt::format("coordinate {}, of {} x {} texels of the format {}, at uv, which is 0 to 1",
                  lut::name_of(layout.coordinate), layout.width, layout.height,
                  lut::name_of(layout.storage)),
      fmt::format("from edge to edge; its {}. Clamp at the edges; no mipmaps. Filter", channels),
      "linearly, or take the nearest texel, whose error is larger."};
}

}  // namespace gonio::shader
