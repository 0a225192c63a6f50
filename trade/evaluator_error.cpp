#include "trade/evaluator_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace gonio::trade {
namespace {

double degrees_of(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * (180 / std::numbers::pi);
}

}  // namespace

ErrorSum::ErrorSum(const Reference& reference) : reference_(&reference) {
  radiance_.weights = std::accumulate(reference.weights.begin(), reference.weights.end(), 0.0);
}

void ErrorSum::add(std::size_t pair, std::span<const double> f_r) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto& [wi, wo] = reference_->pairs[pair];
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    const std::size_t k = pair * f_r.size() + c;
    const double expected = reference_->f_r[k];
    const double apart = std::isfinite(f_r[c]) ? std::abs(f_r[c] - expected) : infinity;
    const double share = apart / reference_->gauge.at(c, expected);
    if (share > error_.largest) {
      error_.largest = share;
      error_.where = {degrees_of(wi.z), degrees_of(wo.z), c};
    }
    const double weight = reference_->weights[k];
    if (weight > 0) radiance_.squares += apart * wi.z * apart * wi.z * weight;
  }
}

EvaluatorError ErrorSum::error() const {
  EvaluatorError error = error_;
  error.rms = radiance_.root();
  return error;
}

EvaluatorError error_of(const Reference& reference, std::span<const double> f_r) {
  ErrorSum sum(reference);
  for (std::size_t pair = 0; pair < reference.pairs.size(); ++pair) {
    sum.add(pair, f_r.subspan(pair * reference.channels, reference.channels));
  }
  return sum.error();
}

EvaluatorError worse_of(const EvaluatorError& a, const EvaluatorError& b) {
  EvaluatorError worse = a.largest >= b.largest ? a : b;
  worse.rms = std::max(a.rms, b.rms);
  return worse;
}

}  // namespace gonio::trade
