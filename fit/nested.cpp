#include "fit/nested.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fit/scale.h"

namespace gonio::fit {
namespace {

/// The terms of `rich` that are the anisotropic relatives of `plain`'s, where all others are the
/// same; empty if `plain` is no special case of `rich`.
std::vector<std::size_t> richer_terms(const brdf::Model& plain, const brdf::Model& rich) {
  // Without anisotropy the tangent angle of a free frame means nothing, and the test does not hold.
  if (plain.terms().size() != rich.terms().size() || rich.has_free_frame()) return {};
  std::vector<std::size_t> terms;
  for (std::size_t t = 0; t < plain.terms().size(); ++t) {
    const std::string_view name = plain.terms()[t]->description.name;
    const std::string_view other = rich.terms()[t]->description.name;
    if (name == other) continue;
    if (std::string(name) + "-aniso" != other) return {};
    terms.push_back(t);
  }
  return terms;
}

/// Where the shape of a term stands among the unknowns.
std::size_t first_shape_unknown(const FitResult& result, std::size_t term) {
  const auto found = std::find_if(
      result.unknowns.begin(), result.unknowns.end(),
      [&](const Unknown& u) { return u.is_shape && result.model.shape()[u.index].term == term; });
  return std::size_t(found - result.unknowns.begin());
}

/// How far the shapes along x and y of each term are apart, ln(alpha_x / alpha_y) for a roughness,
/// and their covariance; none where one is not determined.
struct Contrasts {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;
};

std::optional<Contrasts> contrasts_of(const FitResult& rich,
                                      const std::vector<std::size_t>& terms) {
  const auto count = Eigen::Index(terms.size());
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(count, rich.uncertainty.covariance.cols());
  Contrasts contrasts{Eigen::VectorXd(count), {}};
  for (Eigen::Index t = 0; t < count; ++t) {
    const std::size_t x = first_shape_unknown(rich, terms[std::size_t(t)]);
    const std::size_t y = x + 1;
    if (!rich.uncertainty.stddev[x] || !rich.uncertainty.stddev[y]) return std::nullopt;
    const brdf::Scale scale = rich.model.shape()[rich.unknowns[x].index].descriptor.scale;
    const double along_x = rich.values[rich.unknowns[x]];
    const double along_y = rich.values[rich.unknowns[y]];
    contrasts.values[t] = to_variable(scale, along_x) - to_variable(scale, along_y);
    gradient(t, Eigen::Index(x)) = 1 / parameter_slope(scale, along_x);
    gradient(t, Eigen::Index(y)) = -1 / parameter_slope(scale, along_y);
  }
  contrasts.covariance = gradient * rich.uncertainty.covariance * gradient.transpose();
  return contrasts;
}

/// Of Wald's statistic for `count` conditions.
double p_value_of(double statistic, double count, double degrees_of_freedom) {
  using boost::math::cdf;
  using boost::math::complement;
  if (std::isinf(degrees_of_freedom)) {
    return cdf(complement(boost::math::chi_squared(count), statistic));
  }
  return cdf(complement(boost::math::fisher_f(count, degrees_of_freedom), statistic / count));
}

std::string verdict(const FitResult& plain, const FitResult& rich, double p_value) {
  const std::string p = p_value < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", p_value);
  const double gain =
      plain.metric_error > 0 ? 100 * (1 - rich.metric_error / plain.metric_error) : 0;
  if (p_value > nested_significance) {
    return fmt::format(
        "{} explains these data no better than {} beyond chance ({}): take the isotropic one",
        rich.model.name(), plain.model.name(), p);
  }
  return fmt::format(
      "these data are not isotropic ({}): the error of {} is {:.2g} % smaller than "
      "that of {}",
      p, rich.model.name(), gain, plain.model.name());
}

std::optional<NestedComparison> compare(const FitResult& plain, const FitResult& rich) {
  const std::vector<std::size_t> terms = richer_terms(plain.model, rich.model);
  if (terms.empty()) return std::nullopt;
  const std::optional<Contrasts> contrasts = contrasts_of(rich, terms);
  if (!contrasts) return std::nullopt;
  const Eigen::LLT<Eigen::MatrixXd> factor(contrasts->covariance);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const double statistic = contrasts->values.dot(factor.solve(contrasts->values));
  if (!std::isfinite(statistic)) return std::nullopt;
  const double p_value =
      p_value_of(statistic, double(terms.size()), rich.uncertainty.degrees_of_freedom);
  return NestedComparison{rich.model.name(), statistic, p_value, verdict(plain, rich, p_value)};
}

}  // namespace

void compare_nested(std::span<FitResult> results) {
  for (FitResult& plain : results) {
    for (const FitResult& rich : results) {
      if (auto comparison = compare(plain, rich)) plain.nested = std::move(comparison);
    }
  }
}

}  // namespace gonio::fit
