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

using Evaluate = void (*)(const DirectionChunk&, const double*, const Columns&);
struct BatchEntry {
  Evaluate values;
  Evaluate jets;
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
                     jets_of<std::tuple_element_t<I, brdf::EvaluatedTerms>>()}...};
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

BatchModel::BatchModel(const brdf::Model& model) : model_(&model) {
  std::size_t first_amplitude = 0;
  std::size_t first_shape = 0;
  for (const brdf::TermEntry* term : model.terms()) {
    for (std::size_t k = 0; k < term->amplitudes.size(); ++k) {
      for (std::size_t j = 0; j < term->shape.size(); ++j) {
        derivatives_.push_back({first_amplitude + k, first_shape + j});
      }
    }
    first_amplitude += term->amplitudes.size();
    first_shape += term->shape.size();
  }
}

void BatchModel::evaluate(const DirectionChunk& chunk, std::span<const double> shape,
                          bool with_derivatives, Eigen::Ref<Eigen::MatrixXd> columns) const {
  Columns out{columns.data(),
              columns.data() + Eigen::Index(amplitude_count()) * columns.outerStride(),
              columns.outerStride()};
  const double* theta = shape.data();
  for (const brdf::TermEntry* term : model_->terms()) {
    const BatchEntry& entry = batch_entries[term->index];
    (with_derivatives ? entry.jets : entry.values)(chunk, theta, out);
    theta += term->shape.size();
    out.values += Eigen::Index(term->amplitudes.size()) * out.stride;
    out.derivatives += Eigen::Index(term->amplitudes.size() * term->shape.size()) * out.stride;
  }
}

}  // namespace gonio::fit
