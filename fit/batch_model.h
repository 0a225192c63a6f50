// A model's basis functions, and their derivatives by the shape, for many directions at once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "brdf/model.h"
#include "brdf/pack.h"

namespace gonio::fit {

/// Rows that are evaluated and compressed at a time: small enough for the first-level caches.
inline constexpr std::size_t chunk_rows = 512;
/// The rows that matrices of a chunk have: columns a page apart would compete for the same lines of
/// the cache.
inline constexpr Eigen::Index column_stride = Eigen::Index(chunk_rows) + 8;

/// Up to chunk_rows pairs of directions. Whole packs are evaluated: the rows from count on to the
/// end of the last pack hold directions too.
struct DirectionChunk {
  std::size_t count = 0;
  alignas(64) std::array<double, chunk_rows> wi_x, wi_y, wi_z, wo_x, wo_y, wo_z;

  brdf::Direction<brdf::Pack> wi(std::size_t first) const {
    return {brdf::Pack::load(&wi_x[first]), brdf::Pack::load(&wi_y[first]),
            brdf::Pack::load(&wi_z[first])};
  }
  brdf::Direction<brdf::Pack> wo(std::size_t first) const {
    return {brdf::Pack::load(&wo_x[first]), brdf::Pack::load(&wo_y[first]),
            brdf::Pack::load(&wo_z[first])};
  }
  /// Completes the last pack with the surface normal.
  void pad();
};

/// Evaluates into columns: first the basis functions of the model, then each derivative
/// d basis[function] / d shape[parameter] that is not zero by construction.
class BatchModel {
 public:
  /// What a derivative column holds.
  struct Derivative {
    std::size_t basis;
    std::size_t shape;
  };

  explicit BatchModel(const brdf::Model& model);

  const brdf::Model& model() const { return *model_; }
  std::size_t basis_size() const { return model_->basis_size(); }
  std::size_t amplitude_count() const { return model_->amplitudes().size(); }
  std::size_t shape_count() const { return model_->shape().size(); }
  std::span<const Derivative> derivatives() const { return derivatives_; }
  std::size_t column_count(bool with_derivatives) const {
    return basis_size() + (with_derivatives ? derivatives_.size() : 0);
  }

  /// Writes the first chunk.count rows, and those of its padding, of the first column_count()
  /// columns of `columns`, which has to have column_stride rows.
  void evaluate(const DirectionChunk& chunk, std::span<const double> shape, bool with_derivatives,
                Eigen::Ref<Eigen::MatrixXd> columns) const;

  /// How the coefficients of the basis functions depend on the amplitudes.
  brdf::Coefficients coefficients_kind() const { return coefficients_kind_; }
  /// The coefficients of the basis functions, [basis, channel], for amplitudes [amplitude,
  /// channel].
  Eigen::MatrixXd coefficients(const Eigen::MatrixXd& amplitudes) const;
  /// d coefficient / d amplitude, [basis, amplitude], at the amplitudes of a channel.
  Eigen::MatrixXd coefficient_jacobian(const Eigen::VectorXd& amplitudes) const;

 private:
  const brdf::Model* model_;
  std::vector<Derivative> derivatives_;
  brdf::Coefficients coefficients_kind_;
};

}  // namespace gonio::fit
