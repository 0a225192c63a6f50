#include "bench/material_functions.h"

#include <fmt/format.h>

#include <utility>

#include "bench/material_shader.h"
#include "bench/typical_material.h"
#include "lut/layout.h"
#include "lut/table.h"
#include "shader/compose.h"

namespace gonio::bench {
namespace {

/// The texels do not matter to the text.
lut::Table table_without_texels(lut::Layout layout, lut::Coordinate coordinate) {
  layout.coordinate = coordinate;
  lut::Table table;
  table.layout = layout;
  table.decoding = lut::decoding_of(layout);
  return table;
}

/// strauss-terms has parameters on its axes, and no coordinate.
std::vector<lut::Coordinate> coordinates_of(lut::TableKind kind) {
  if (kind == lut::TableKind::strauss_terms) return {lut::Coordinate::cosine};
  return {lut::Coordinate::cosine, lut::Coordinate::sqrt};
}

}  // namespace

std::vector<MaterialFunction> material_functions(const brdf::Model& model,
                                                 const std::vector<std::string>& header) {
  constexpr auto hlsl = shader::Language::hlsl;
  const shader::SourceText text{.name = std::string(material_name), .header = header};
  const brdf::BoundModel material = typical_material(model);
  std::vector<MaterialFunction> functions{
      {"analytic", false, function_source(material, hlsl, text)}};
  for (const lut::TableKind kind : lut::tables_for(model)) {
    const lut::Layout layout = layout_for(material, kind);
    for (const lut::Coordinate coordinate : coordinates_of(kind)) {
      const lut::Table table = table_without_texels(layout, coordinate);
      std::string function = function_source(material, table, hlsl, text);
      functions.push_back({fmt::format("{}, {}", lut::name_of(kind), lut::name_of(coordinate)),
                           true, std::move(function)});
    }
  }
  return functions;
}

}  // namespace gonio::bench
