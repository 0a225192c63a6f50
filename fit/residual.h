// The residual of one value under a metric, and how it changes with the model's value. Scalar S:
// double, or brdf::Pack for four values at once.
#pragma once

#include <cmath>

#include "brdf/scalar.h"
#include "fit/options.h"

namespace gonio::fit {

/// Whether the residual is factor * (model - f), with a factor that does not depend on the model.
inline bool is_linear(Metric metric) {
  return metric != Metric::log && metric != Metric::cube_root;
}

template <class S>
struct Residual {
  S value;
  S slope;  // d value / d model
};

/// factor * (model - f).
struct LinearResidual {
  template <class S>
  static Residual<S> of(const S& f, const S& model, const S& /*cos_i*/, const S& factor) {
    return {factor * (model - f), factor};
  }
};

/// Of ln(1 + max(0, f_r cos_i)). `factor` is 1, or 0 for a value that was not measured.
struct LogResidual {
  template <class S>
  static Residual<S> of(const S& f, const S& model, const S& cos_i, const S& factor) {
    using brdf::larger;
    using std::log;
    const S seen = S(1) + larger(S(0), S(f * cos_i));
    const S expected = S(1) + larger(S(0), S(model * cos_i));
    return {factor * log(expected / seen), factor * cos_i / expected};
  }
};

/// Of cbrt(max(0, f_r cos_i)). The slope is infinite where the model is 0; it is that of 1e-12/sr
/// there, less than any instrument sees.
struct CubeRootResidual {
  template <class S>
  static Residual<S> of(const S& f, const S& model, const S& cos_i, const S& factor) {
    using brdf::larger;
    using std::cbrt;
    const S seen = cbrt(larger(S(0), S(f * cos_i)));
    const S expected = cbrt(larger(S(0), S(model * cos_i)));
    const S least = larger(S(1e-8), S(expected * expected));
    return {factor * (expected - seen), factor * cos_i / (S(3) * least)};
  }
};

/// Calls function(R{}) with the metric's residual R.
template <class Function>
decltype(auto) with_residual(Metric metric, const Function& function) {
  switch (metric) {
    case Metric::log:
      return function(LogResidual{});
    case Metric::cube_root:
      return function(CubeRootResidual{});
    default:
      return function(LinearResidual{});
  }
}

}  // namespace gonio::fit
