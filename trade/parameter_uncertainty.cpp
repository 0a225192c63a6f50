#include "trade/parameter_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "brdf/bound_model.h"
#include "material/evaluate.h"

namespace gonio::trade {
namespace {

/// A parameter moved down and up, in every channel at once: a channel's f_r depends on no other
/// channel's amplitudes.
struct Difference {
  const material::ParameterValue* parameter;
  brdf::BoundModel lower, upper;
  std::vector<double> width;  // per channel, or one for all; 0 where the parameter is known
};

double per_channel(const std::vector<double>& values, std::size_t channel) {
  return values.size() == 1 ? values[0] : values[channel];
}

bool has_stddev(const material::ParameterValue& parameter, std::size_t index) {
  return index < parameter.stddev.size() && parameter.stddev[index] &&
         *parameter.stddev[index] > 0 && std::isfinite(*parameter.stddev[index]);
}

/// A hundredth of the standard deviation: far less than what the model curves on. Not less than
/// what the rounding of f_r leaves of a difference.
double step_of(double value, double stddev) {
  return std::max(stddev / 100, 1e-6 * std::abs(value));
}

brdf::BoundModel with_values(const material::Material& material,
                             const material::ParameterValue& parameter,
                             const std::vector<double>& values) {
  material::Material moved = material;
  moved.parameters[std::size_t(&parameter - material.parameters.data())].value = values;
  return material::bind(moved);
}

const brdf::Parameter& descriptor_of(const brdf::Model& model, const std::string& name) {
  for (const brdf::OrderedParameter& p : brdf::ordered_parameters(model)) {
    if (p.parameter->name == name) return p.parameter->descriptor;
  }
  throw std::invalid_argument("parameter_uncertainty: no parameter '" + name + "'");
}

std::optional<Difference> difference_by(const material::Material& material,
                                        const material::ParameterValue& parameter) {
  const brdf::Model model = material::model_of(material);
  const brdf::Parameter& bounds = descriptor_of(model, parameter.name);
  std::vector<double> lower = parameter.value;
  std::vector<double> upper = parameter.value;
  std::vector<double> width(parameter.value.size());
  bool any = false;
  for (std::size_t k = 0; k < width.size(); ++k) {
    if (!has_stddev(parameter, k)) continue;
    const double step = step_of(parameter.value[k], *parameter.stddev[k]);
    lower[k] = std::max(bounds.lower, parameter.value[k] - step);
    upper[k] = std::min(bounds.upper, parameter.value[k] + step);
    width[k] = upper[k] - lower[k];
    any = true;
  }
  if (!any) return std::nullopt;
  return Difference{&parameter, with_values(material, parameter, lower),
                    with_values(material, parameter, upper), std::move(width)};
}

/// Where the parameter's channel stands in the rows of the correlation matrix; nothing if nowhere.
std::optional<std::size_t> row_of(const material::FitSummary& fit,
                                  const material::ParameterValue& parameter,
                                  const std::string& channel) {
  const auto& rows = fit.correlation_parameters;
  for (const std::string& name : {parameter.name + "." + channel, parameter.name}) {
    const auto row = std::find(rows.begin(), rows.end(), name);
    if (row != rows.end()) return std::size_t(row - rows.begin());
  }
  return std::nullopt;
}

/// 1 on the diagonal; 0 where the file does not say.
double correlation(const material::FitSummary& fit, const material::ParameterValue& a,
                   const material::ParameterValue& b, const std::string& channel) {
  if (&a == &b) return 1;
  const auto i = row_of(fit, a, channel);
  const auto j = row_of(fit, b, channel);
  if (!i || !j || *i >= fit.correlation.size() || *j >= fit.correlation[*i].size()) return 0;
  return fit.correlation[*i][*j].value_or(0);
}

double stddev_of(const material::ParameterValue& parameter, std::size_t channel) {
  const std::size_t k = parameter.value.size() == 1 ? 0 : channel;
  return has_stddev(parameter, k) ? *parameter.stddev[k] : 0;
}

/// The covariance of the moved parameters as one channel has them, [row][column].
std::vector<double> covariance(const material::Material& material,
                               const std::vector<Difference>& differences, std::size_t channel) {
  std::vector<double> matrix;
  for (const Difference& a : differences) {
    for (const Difference& b : differences) {
      matrix.push_back(
          correlation(*material.fit, *a.parameter, *b.parameter, material.channels[channel]) *
          stddev_of(*a.parameter, channel) * stddev_of(*b.parameter, channel));
    }
  }
  return matrix;
}

double quadratic_form(std::span<const double> gradient, std::span<const double> matrix) {
  double sum = 0;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    for (std::size_t j = 0; j < gradient.size(); ++j) {
      sum += gradient[i] * gradient[j] * matrix[i * gradient.size() + j];
    }
  }
  return sum;
}

/// The gradient of f_r by the moved parameters, [channel][parameter].
class Gradient {
 public:
  Gradient(const std::vector<Difference>& differences, std::size_t channels)
      : differences_(differences),
        values_(channels * differences.size()),
        below_(channels),
        above_(channels) {}

  void evaluate(const brdf::DirectionPair<double>& pair) {
    for (std::size_t p = 0; p < differences_.size(); ++p) {
      differences_[p].lower.f_r(pair.wi, pair.wo, below_);
      differences_[p].upper.f_r(pair.wi, pair.wo, above_);
      for (std::size_t c = 0; c < above_.size(); ++c) {
        const double width = per_channel(differences_[p].width, c);
        const double change = above_[c] - below_[c];
        values_[c * differences_.size() + p] = width > 0 ? change / width : 0;
      }
    }
  }

  std::span<const double> of(std::size_t channel) const {
    return std::span(values_).subspan(channel * differences_.size(), differences_.size());
  }

 private:
  const std::vector<Difference>& differences_;
  std::vector<double> values_, below_, above_;
};

std::vector<Difference> differences_of(const material::Material& material) {
  std::vector<Difference> differences;
  for (const material::ParameterValue& parameter : material.parameters) {
    if (auto difference = difference_by(material, parameter)) {
      differences.push_back(std::move(*difference));
    }
  }
  return differences;
}

}  // namespace

std::optional<std::vector<double>> parameter_uncertainty(
    const material::Material& material, std::span<const brdf::DirectionPair<double>> pairs) {
  if (!material.fit) return std::nullopt;
  const std::vector<Difference> differences = differences_of(material);
  if (differences.empty()) return std::nullopt;
  const std::size_t channels = material.channels.size();
  std::vector<std::vector<double>> covariances;
  for (std::size_t c = 0; c < channels; ++c) {
    covariances.push_back(covariance(material, differences, c));
  }
  Gradient gradient(differences, channels);
  std::vector<double> stddev;
  stddev.reserve(pairs.size() * channels);
  for (const auto& pair : pairs) {
    gradient.evaluate(pair);
    for (std::size_t c = 0; c < channels; ++c) {
      // The matrix, of rounded numbers, need not be positive definite.
      stddev.push_back(std::sqrt(std::max(0.0, quadratic_form(gradient.of(c), covariances[c]))));
    }
  }
  return stddev;
}

}  // namespace gonio::trade
