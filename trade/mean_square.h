// A weighted root mean square.
#pragma once

#include <cmath>

namespace gonio::trade {

/// Sums of squares and of weights, which give it.
struct MeanSquare {
  double squares = 0;
  double weights = 0;

  void add(double value, double weight) {
    squares += value * value * weight;
    weights += weight;
  }
  /// 0 if nothing has a weight.
  double root() const { return weights > 0 ? std::sqrt(squares / weights) : 0; }
};

}  // namespace gonio::trade
