#include "fit/batch_model.h"

#include <ceres/jet.h>

#include <tuple>
#include <utility>

#include "brdf/terms.h"
#include "fit/pack_jet.h"

namespace gonio::fit {
namespace {

using brdf::Pack;

/// Where a term's columns go: basis[k] at values + k * stride, the derivative of basis[k] by
/// shape[j] at derivatives + (k * P + j) * stride.
struct Columns {
  double* values;
  double* derivatives;
  Eigen::Index stride;
};

template <brdf::Term T>
GONIO_FOR_EACH_CPU void evaluate_values(const DirectionChunk& chunk, const double* shape,
                                        const Columns& out) {
  std::array<Pack, T::shape.size()> theta;
  std::copy_n(shape, theta.size(), theta.begin());
  for (std::size_t i = 0; i < chunk.count; i += Pack::size) {
    const auto basis = T::template basis<Pack, Pack>(theta, chunk.wi(i), chunk.wo(i));
    for (std::size_t k = 0; k < basis.size(); ++k) {
      basis[k].store(out.values + Eigen::Index(k) * out.stride + Eigen::Index(i));
    }
  }
}

template <brdf::Term T>
GONIO_FOR_EACH_CPU void evaluate_jets(const DirectionChunk& chunk, const double* shape,
                                      const Columns& out) {
  constexpr std::size_t shape_count = T::shape.size();
  using Jet = ceres::Jet<Pack, int(shape_count)>;
  std::array<Jet, shape_count> theta;
  for (std::size_t j = 0; j < shape_count; ++j) theta[j] = Jet(Pack(shape[j]), int(j));
  for (std::size_t i = 0; i < chunk.count; i += Pack::size) {
    const auto basis = T::template basis<Jet, Pack>(theta, chunk.wi(i), chunk.wo(i));
    for (std::size_t k = 0; k < basis.size(); ++k) {
      basis[k].a.store(out.values + Eigen::Index(k) * out.stride + Eigen::Index(i));
      for (std::size_t j = 0; j < shape_count; ++j) {
        basis[k].v[Eigen::Index(j)].store(
            out.derivatives + Eigen::Index(k * shape_count + j) * out.stride + Eigen::Index(i));
      }
    }
  }
}

/// Writes d coefficient[b] / d amplitude[k] into jacobian[k * stride + b].
template <brdf::Term T>
void coefficient_jacobian_of(const double* amplitudes, double* jacobian, Eigen::Index stride) {
  constexpr std::size_t amplitude_count = T::amplitudes.size();
  using Jet = ceres::Jet<double, int(amplitude_count)>;
  std::array<Jet, amplitude_count> given;
  for (std::size_t k = 0; k < amplitude_count; ++k) given[k] = Jet(amplitudes[k], int(k));
  const auto coefficients = brdf::coefficients_of<T, Jet>(given);
  for (std::size_t k = 0; k < amplitude_count; ++k) {
    for (std::size_t b = 0; b < coefficients.size(); ++b) {
      jacobian[Eigen::Index(k) * stride + Eigen::Index(b)] = coefficients[b].v[Eigen::Index(k)];
    }
  }
}

using Evaluate = void (*)(const DirectionChunk&, const double*, const Columns&);
struct BatchEntry {
  Evaluate values;
  Evaluate jets;
  void (*coefficient_jacobian)(const double*, double*, Eigen::Index);
};

/// A term without a shape has no derivatives.
template <brdf::Term T>
constexpr Evaluate jets_of() {
  if constexpr (T::shape.size() == 0) {
    return &evaluate_values<T>;
  } else {
    return &evaluate_jets<T>;
  }
}

template <std::size_t... I>
constexpr std::array<BatchEntry, sizeof...(I)> make_entries(std::index_sequence<I...>) {
  return {BatchEntry{&evaluate_values<std::tuple_element_t<I, brdf::EvaluatedTerms>>,
                     jets_of<std::tuple_element_t<I, brdf::EvaluatedTerms>>(),
                     &coefficient_jacobian_of<std::tuple_element_t<I, brdf::EvaluatedTerms>>}...};
}

/// By TermEntry::index.
constexpr auto batch_entries =
    make_entries(std::make_index_sequence<std::tuple_size_v<brdf::EvaluatedTerms>>());

}  // namespace

void DirectionChunk::pad() {
  for (std::size_t i = count; i % Pack::size != 0; ++i) {
    wi_x[i] = wi_y[i] = wo_x[i] = wo_y[i] = 0;
    wi_z[i] = wo_z[i] = 1;
  }
}

BatchModel::BatchModel(const brdf::Model& model)
    : model_(&model), coefficients_kind_(model.coefficients_kind()) {
  std::size_t first_basis = 0;
  std::size_t first_shape = 0;
  for (const brdf::TermEntry* term : model.terms()) {
    for (std::size_t b = 0; b < term->basis_size; ++b) {
      for (std::size_t j = 0; j < term->shape.size(); ++j) {
        derivatives_.push_back({first_basis + b, first_shape + j});
      }
    }
    first_basis += term->basis_size;
    first_shape += term->shape.size();
  }
}

void BatchModel::evaluate(const DirectionChunk& chunk, std::span<const double> shape,
                          bool with_derivatives, Eigen::Ref<Eigen::MatrixXd> columns) const {
  Columns out{columns.data(), columns.data() + Eigen::Index(basis_size()) * columns.outerStride(),
              columns.outerStride()};
  const double* theta = shape.data();
  for (const brdf::TermEntry* term : model_->terms()) {
    const BatchEntry& entry = batch_entries[term->index];
    (with_derivatives ? entry.jets : entry.values)(chunk, theta, out);
    theta += term->shape.size();
    out.values += Eigen::Index(term->basis_size) * out.stride;
    out.derivatives += Eigen::Index(term->basis_size * term->shape.size()) * out.stride;
  }
}

Eigen::MatrixXd BatchModel::coefficients(const Eigen::MatrixXd& amplitudes) const {
  if (coefficients_kind_ == brdf::Coefficients::linear) return amplitudes;
  Eigen::MatrixXd coefficients(Eigen::Index(basis_size()), amplitudes.cols());
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    model_->coefficients({amplitudes.col(c).data(), amplitude_count()},
                         {coefficients.col(c).data(), basis_size()});
  }
  return coefficients;
}

Eigen::MatrixXd BatchModel::coefficient_jacobian(const Eigen::VectorXd& amplitudes) const {
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(Eigen::Index(basis_size()), Eigen::Index(amplitude_count()));
  Eigen::Index first_amplitude = 0;
  Eigen::Index first_basis = 0;
  for (const brdf::TermEntry* term : model_->terms()) {
    batch_entries[term->index].coefficient_jacobian(amplitudes.data() + first_amplitude,
                                                    &jacobian(first_basis, first_amplitude),
                                                    jacobian.outerStride());
    first_amplitude += Eigen::Index(term->amplitudes.size());
    first_basis += Eigen::Index(term->basis_size);
  }
  return jacobian;
}

}  // namespace gonio::fit
