// The minimum of the plain problem (plain_problem.h), by Ceres the way its manual shows: a block of
// automatic derivatives and a loss of Ceres' own for every value.
#pragma once

#include <vector>

#include "fit/options.h"
#include "tests/plain_problem.h"

namespace gonio::tests {

struct PlainMinimum {
  double cost;
  PlainParameters parameters;
  bool converged;
};

/// From the given parameters, of which psi stays.
PlainMinimum plain_minimum(const std::vector<PlainValue>& values, fit::Metric metric,
                           fit::Loss loss, double scale, const PlainParameters& start);

}  // namespace gonio::tests
