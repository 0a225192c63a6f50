// Which HLSL function evaluates a term, and with which arguments.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/model.h"

namespace gonio::shader {

/// The function gonio_NAME in NAME.hlsl. It gives the term's basis functions above the horizon, as
/// float, float2 or float3.
struct TermSource {
  std::string_view term;
  brdf::TermKind kind;
  std::string_view name;
  /// Its first arguments: the name of a shape parameter p, or one_minus_p.
  std::vector<std::string_view> shape;
  /// Its further arguments, of h, wi, wo; h is the half vector in the frame of the tangent.
  std::vector<std::string_view> directions;
  /// What the coefficient of each basis function is called; empty for the part that is always
  /// multiplied by 1.
  std::vector<std::string_view> coefficients;
};

/// The source of the term, whatever its frame. Throws std::logic_error for a term that has none.
const TermSource& term_source(const brdf::TermEntry& term);

/// A shape argument as the function source declares it: a float, or a float2.
struct ShapeConstant {
  std::string name;
  std::vector<double> components;
  std::string meaning;
};

/// The constants that evaluating the term by `source` takes: the arguments of `shape`, each once,
/// and with a free frame cos_psi and sin_psi, in two parts (turned.hlsl). `values`: as term.shape.
/// `suffix`: what the names of the term's parameters end in.
std::vector<ShapeConstant> shape_constants(const brdf::TermEntry& term, const TermSource& source,
                                           std::span<const double> values, std::string_view suffix);

/// Whether the term's tangent has an angle of its own.
bool has_tangent_angle(const brdf::TermEntry& term);

}  // namespace gonio::shader
