#include "fit/compression.h"

#include <Eigen/Householder>
#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio::fit {
namespace {

/// Rotates the first `rows` rows of [A | Y] so that A, its first `columns` columns, becomes upper
/// triangular (Householder). Returns the norm of what each column of Y holds below the triangle;
/// everything below the triangle is used up.
Eigen::VectorXd triangularise(Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns,
                              Eigen::VectorXd& workspace) {
  for (Eigen::Index k = 0; k < std::min(columns, rows); ++k) {
    double tau = 0;
    double diagonal = 0;
    auto column = matrix.col(k).segment(k, rows - k);
    column.makeHouseholderInPlace(tau, diagonal);
    const Eigen::Index rest = matrix.cols() - k - 1;
    if (rest > 0) {
      matrix.block(k, k + 1, rows - k, rest)
          .applyHouseholderOnTheLeft(column.tail(rows - k - 1), tau, workspace.data());
    }
    matrix(k, k) = diagonal;
    column.tail(rows - k - 1).setZero();
  }
  const Eigen::Index below = std::max<Eigen::Index>(rows - columns, 0);
  return matrix.block(std::min(columns, rows), columns, below, matrix.cols() - columns)
      .colwise()
      .norm()
      .transpose();
}

/// A triangular system that chunks are folded into: the triangle stands in the first rows, and
/// a chunk's rows below it.
class Folding {
 public:
  Folding(std::size_t columns, std::size_t right_hand_sides)
      : columns_(Eigen::Index(columns)),
        matrix_(Eigen::MatrixXd::Zero(columns_ + Eigen::Index(chunk_rows),
                                      columns_ + Eigen::Index(right_hand_sides))),
        workspace_(matrix_.cols()),
        unreachable_(Eigen::VectorXd::Zero(Eigen::Index(right_hand_sides))) {}

  /// Where the next chunk's rows [A | Y] are to be written.
  auto incoming(std::size_t rows) {
    return matrix_.block(columns_, 0, Eigen::Index(rows), matrix_.cols());
  }
  auto incoming_columns() { return matrix_.block(columns_, 0, Eigen::Index(chunk_rows), columns_); }

  void fold(std::size_t rows) {
    const Eigen::VectorXd tail =
        triangularise(matrix_, columns_ + Eigen::Index(rows), columns_, workspace_);
    for (Eigen::Index c = 0; c < tail.size(); ++c) {
      unreachable_[c] = std::hypot(unreachable_[c], tail[c]);
    }
  }

  /// Folds another result in.
  void fold(const Eigen::MatrixXd& factor, const Eigen::MatrixXd& projected,
            const Eigen::VectorXd& unreachable) {
    auto rows = incoming(std::size_t(columns_));
    rows.leftCols(columns_) = factor;
    rows.rightCols(projected.cols()) = projected;
    fold(std::size_t(columns_));
    for (Eigen::Index c = 0; c < unreachable.size(); ++c) {
      unreachable_[c] = std::hypot(unreachable_[c], unreachable[c]);
    }
  }

  Eigen::MatrixXd factor() const { return matrix_.topLeftCorner(columns_, columns_); }
  Eigen::MatrixXd projected() const {
    return matrix_.topRightCorner(columns_, unreachable_.size());
  }
  const Eigen::VectorXd& unreachable() const { return unreachable_; }

 private:
  Eigen::Index columns_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd unreachable_;
};

/// One system for all channels where they share the factors, else one per channel.
std::vector<Folding> make_systems(const WeightedSamples& samples, std::size_t columns) {
  return samples.shared_factors()
             ? std::vector<Folding>{Folding(columns, samples.channel_count())}
             : std::vector<Folding>(samples.channel_count(), Folding(columns, 1));
}

void fold_chunk(const SampleChunk& chunk, const BatchModel& model, std::span<const double> shape,
                bool with_derivatives, std::vector<Folding>& systems) {
  const auto rows = Eigen::Index(chunk.directions.count);
  const auto columns = Eigen::Index(model.column_count(with_derivatives));
  model.evaluate(chunk.directions, shape, with_derivatives, systems.front().incoming_columns());
  for (std::size_t s = 1; s < systems.size(); ++s) {
    systems[s].incoming(std::size_t(rows)).leftCols(columns) =
        systems.front().incoming(std::size_t(rows)).leftCols(columns);
  }
  const Eigen::Index sides = systems.size() == 1 ? chunk.values.cols() : 1;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    auto incoming = systems[s].incoming(std::size_t(rows));
    const auto factor = chunk.factors.col(Eigen::Index(s)).head(rows);
    incoming.leftCols(columns).array().colwise() *= factor.array();
    incoming.rightCols(sides) = chunk.values.middleCols(Eigen::Index(s), sides).topRows(rows);
    incoming.rightCols(sides).array().colwise() *= factor.array();
    systems[s].fold(std::size_t(rows));
  }
}

}  // namespace

Compressed compress(const WeightedSamples& samples, const BatchModel& model,
                    std::span<const double> shape, bool with_derivatives,
                    const PassOptions& options) {
  const std::size_t columns = model.column_count(with_derivatives);
  std::vector<std::vector<Folding>> parts = chunk_pass(
      samples, options, [&] { return make_systems(samples, columns); },
      [&](const SampleChunk& chunk, std::vector<Folding>& systems) {
        fold_chunk(chunk, model, shape, with_derivatives, systems);
      });
  std::vector<Folding> total = std::move(parts.front());
  for (std::size_t p = 1; p < parts.size(); ++p) {
    for (std::size_t s = 0; s < total.size(); ++s) {
      const Folding& part = parts[p][s];
      total[s].fold(part.factor(), part.projected(), part.unreachable());
    }
  }

  Compressed compressed;
  compressed.projected.resize(Eigen::Index(columns), Eigen::Index(samples.channel_count()));
  compressed.unreachable.resize(Eigen::Index(samples.channel_count()));
  Eigen::Index channel = 0;
  for (const Folding& system : total) {
    const Eigen::MatrixXd projected = system.projected();
    compressed.factors.push_back(system.factor());
    compressed.projected.middleCols(channel, projected.cols()) = projected;
    compressed.unreachable.segment(channel, projected.cols()) = system.unreachable();
    channel += projected.cols();
  }
  return compressed;
}

}  // namespace gonio::fit
