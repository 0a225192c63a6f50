// How far an evaluator is from the model: the two errors that trade/reference.h describes.
#pragma once

#include <cstddef>
#include <span>

#include "trade/mean_square.h"
#include "trade/reference.h"

namespace gonio::trade {

struct ErrorPlace {
  double theta_i_deg = 0;
  double theta_o_deg = 0;
  std::size_t channel = 0;
};

struct EvaluatorError {
  double largest = 0;  // as a fraction of the lobe's peak
  ErrorPlace where = {};
  double rms = 0;  // of f_r cos_i, in 1/sr
};

/// The error pair by pair, for those who need not see them all.
class ErrorSum {
 public:
  /// The reference must outlive it.
  explicit ErrorSum(const Reference& reference);

  /// The values `f_r` of the channels at a pair. One that is not finite has an infinite error.
  void add(std::size_t pair, std::span<const double> f_r);

  /// Over the pairs added so far: all the others count as without error, so that neither part of it
  /// is larger than over all of them.
  EvaluatorError error() const;

 private:
  const Reference* reference_;
  MeanSquare radiance_;  // with the weights of all pairs
  EvaluatorError error_;
};

/// Of the values `f_r`, [pair][channel].
EvaluatorError error_of(const Reference& reference, std::span<const double> f_r);

/// The larger of each: the largest error with its place, and the root mean square.
EvaluatorError worse_of(const EvaluatorError& a, const EvaluatorError& b);

}  // namespace gonio::trade
