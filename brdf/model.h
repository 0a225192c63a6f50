// A model: a sum of terms, named `diffuse`, `specular` or `diffuse+specular`.
//
// f_r of channel c = sum over k of amplitudes[k][c] * basis_k(shape; wi, wo), in 1/sr. The
// amplitudes differ per channel, the shape is shared by all channels.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/direction.h"
#include "brdf/parameter.h"
#include "brdf/term.h"

namespace gonio::brdf {

/// A term of the list, reachable at run time.
struct TermEntry {
  TermDescription description;
  std::span<const Parameter> amplitudes;
  std::span<const Parameter> shape;
  /// The position in `Terms`, for tables that other rooms build over the same list.
  std::size_t index;
  /// Writes the basis values (as many as amplitudes) for the given shape.
  void (*basis)(const double* shape, const Direction<double>& wi, const Direction<double>& wo,
                double* values);
};

/// Every term there is, in the order of the list.
std::span<const TermEntry> all_terms();

/// A parameter of a model: the descriptor, under the name that it has in this model.
struct ModelParameter {
  std::string name;
  Parameter descriptor;
  std::size_t term;
};

/// An immutable composition of terms.
class Model {
 public:
  /// Parses `lambert`, `lambert+ward-aniso` or a bare specular name, which brings its author's
  /// diffuse term. Throws std::invalid_argument that lists what there is.
  explicit Model(std::string_view name);

  /// The canonical name, with the diffuse term spelled out.
  const std::string& name() const { return name_; }
  std::span<const TermEntry* const> terms() const { return terms_; }
  /// One value per channel each.
  std::span<const ModelParameter> amplitudes() const { return amplitudes_; }
  /// One value each, shared by all channels.
  std::span<const ModelParameter> shape() const { return shape_; }

  /// Writes the value of each amplitude's basis function; `shape` as in shape(), `values` as in
  /// amplitudes(). All are 0 below the horizon.
  void basis(std::span<const double> shape, const Direction<double>& wi,
             const Direction<double>& wo, std::span<double> values) const;

  /// f_r in 1/sr for one channel's amplitudes. Finite for any unit directions and any parameters
  /// within their bounds: a result too large for double saturates.
  double evaluate(std::span<const double> amplitudes, std::span<const double> shape,
                  const Direction<double>& wi, const Direction<double>& wo) const;

 private:
  std::string name_;
  std::vector<const TermEntry*> terms_;
  std::vector<ModelParameter> amplitudes_;
  std::vector<ModelParameter> shape_;
};

/// The canonical name of every model whose terms belong together by their authors: each diffuse
/// term alone, and each specular term with its own diffuse.
std::vector<std::string> model_names();

}  // namespace gonio::brdf
