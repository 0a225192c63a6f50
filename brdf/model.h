// A model: a sum of terms, named `diffuse`, `specular`, `diffuse+specular` or
// `diffuse+specular+specular`, or a whole model of its own. The parameters of the second specular
// term bear the suffix `_2`.
//
// f_r of channel c = sum over b of coefficient_b(amplitudes of c) * basis_b(shape; wi, wo), in
// 1/sr. The amplitudes differ per channel, the shape is shared by all channels. Mostly the
// coefficients are the amplitudes.
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
  /// The position in `EvaluatedTerms`, for tables that other rooms build over the same list.
  std::size_t index;
  std::size_t basis_size;
  /// Writes the values of the basis functions for the given shape.
  void (*basis)(const double* shape, const Direction<double>& wi, const Direction<double>& wo,
                double* values);
  /// Writes the coefficients of the basis functions for the amplitudes of a channel.
  void (*coefficients)(const double* amplitudes, double* coefficients);
  /// Writes the shape of another material with the same f_r, for amplitudes that all channels share
  /// (term.h); null where there is none.
  void (*twin)(const double* shape, const double* amplitudes, double* other_shape);
};

/// Every term that users can name, in the order of the list. A term that stands for a whole model
/// may bear the name of a specular one, which is meant within a sum.
std::span<const TermEntry> all_terms();

/// True if the term is not 0 where all its amplitudes are: it has a part that no amplitude scales.
bool has_fixed_part(const TermEntry& term);

/// Where the tangent of the anisotropic terms points: along x of the table, or at an angle psi to
/// it that is a parameter of each such term (free_frame.h).
enum class Frame { of_table, free };

/// No model has more basis functions.
inline constexpr std::size_t most_basis_functions = 8;

/// What the names of the second specular term's parameters end in.
inline constexpr std::string_view second_lobe_suffix = "_2";

/// A parameter of a model: the descriptor, under the name that it has in this model.
struct ModelParameter {
  std::string name;
  Parameter descriptor;
  std::size_t term;
};

/// An immutable composition of terms.
class Model {
 public:
  /// Parses `lambert`, `lambert+ward-aniso`, `lambert+ward+ward-aniso`, `strauss` or a bare
  /// specular name, which brings its author's diffuse term. The frame makes no difference to a
  /// model without anisotropic terms. Throws std::invalid_argument that lists what there is.
  explicit Model(std::string_view name, Frame frame = Frame::of_table);

  /// The canonical name, with the diffuse term spelled out; the same for either frame.
  const std::string& name() const { return name_; }
  /// Whether a term has a tangent.
  bool is_anisotropic() const;
  /// Whether each tangent has its own angle psi: true of anisotropic models with Frame::free.
  bool has_free_frame() const { return frame_ == Frame::free && is_anisotropic(); }
  std::span<const TermEntry* const> terms() const { return terms_; }
  /// One value per channel each.
  std::span<const ModelParameter> amplitudes() const { return amplitudes_; }
  /// One value each, shared by all channels.
  std::span<const ModelParameter> shape() const { return shape_; }

  /// How many basis functions there are, over all terms.
  std::size_t basis_size() const { return basis_terms_.size(); }
  /// The term that each basis function belongs to.
  std::span<const std::size_t> basis_terms() const { return basis_terms_; }
  /// How the coefficients of the basis functions depend on the amplitudes: the least simple of the
  /// terms' ways.
  Coefficients coefficients_kind() const;

  /// Writes the value of each basis function; `shape` as in shape(). All are finite, at least 0,
  /// and 0 below the horizon.
  void basis(std::span<const double> shape, const Direction<double>& wi,
             const Direction<double>& wo, std::span<double> values) const;

  /// Writes the coefficient of each basis function for one channel's amplitudes, as in
  /// amplitudes().
  void coefficients(std::span<const double> amplitudes, std::span<double> coefficients) const;

  /// f_r in 1/sr for one channel's amplitudes. Finite for any unit directions and any parameters
  /// within their bounds: a result too large for double saturates.
  double evaluate(std::span<const double> amplitudes, std::span<const double> shape,
                  const Direction<double>& wi, const Direction<double>& wo) const;

 private:
  Frame frame_;
  std::string name_;
  std::vector<const TermEntry*> terms_;
  std::vector<ModelParameter> amplitudes_;
  std::vector<ModelParameter> shape_;
  std::vector<std::size_t> basis_terms_;
};

/// The canonical name of every model whose terms belong together by their authors: each diffuse
/// term alone, each specular term with its own diffuse, and the whole models.
std::vector<std::string> model_names();

}  // namespace gonio::brdf
