// Which HLSL evaluates a term by a look-up table, and the text that reads the table.
//
// The text reads it through a function `float4 NAME(float2 uv)` that the user of the text defines.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lut/table.h"
#include "shader/term_source.h"

namespace gonio::shader {

/// The function that gives the term's basis functions from what the table holds, which is its
/// first argument, before those of `shape`. An empty name: the table's value is the basis function.
/// Null if the table does not serve the term. Throws std::logic_error for a term that has no such
/// function.
const TermSource* table_source(const brdf::TermEntry& term, lut::TableKind kind);

/// A table in a shader.
struct TableText {
  const lut::Layout& layout;
  const std::array<lut::Decoding, lut::most_channels>& decoding;
  std::string function;  // that reads it
};

/// A term that is read from a table.
struct TableTerm {
  const brdf::TermEntry& entry;
  std::span<const double> shape;
  std::string half_vector;  // in the frame of the term's tangent: the name of the variable
};

/// The statements that set `variable`, which they declare, to the values of the table for wi, wo or
/// the half vector: a float, or for strauss a float2.
std::string table_reading(const TableText& table, const TableTerm& term,
                          const std::string& variable);

/// Whether the reading takes the half vector: for all but strauss.
bool takes_half_vector(lut::TableKind kind);

/// The files of shader/hlsl that the reading of any of these terms needs.
std::vector<std::string_view> table_files(const lut::Layout& layout,
                                          std::span<const brdf::TermEntry* const> served);

/// The function that reads the table, in HLSL: float4 NAME(float2 uv).
std::string table_signature(const TableText& table);

/// What the user of the text has to know of it: lines without comment signs.
std::vector<std::string> table_comment(const TableText& table);

}  // namespace gonio::shader
