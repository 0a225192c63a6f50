#include "fit/albedo_warning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "brdf/albedo.h"

namespace gonio::fit {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr double tolerance = 1e-2;
/// The rough albedo from which on the exact one, which costs about half a millisecond, is looked
/// at.
constexpr double worth_a_look = 0.8;
/// The rough one may miss half of a very anisotropic lobe.
constexpr double anisotropic_worth_a_look = 0.5;

struct LargestAlbedo {
  double value = 1;
  double theta_i = 0;
  std::size_t channel = 0;
};

/// The largest angle, and where it is beyond 60 deg that, and the middle between both.
std::vector<double> angles_up_to(double theta_i) {
  constexpr double grazing = 60 * radians_per_degree;
  if (theta_i <= grazing) return {theta_i};
  return {theta_i, (theta_i + grazing) / 2, grazing};
}

/// That of the light, and where the material has a tangent those along and across it: an
/// anisotropic table has light from all of them. A tangent of its own is within an eighth of a turn
/// of one.
std::vector<double> azimuths_of(const brdf::Model& model, double phi_i) {
  if (!model.is_anisotropic()) return {phi_i};
  constexpr double pi = std::numbers::pi;
  if (!model.has_free_frame()) return {phi_i, 0, pi / 2};
  return {phi_i, 0, pi / 4, pi / 2, 3 * pi / 4};
}

std::vector<std::size_t> determined_channels(const FitResult& result,
                                             const Identifiability& identifiability) {
  std::vector<bool> determined(result.channels.size(), true);
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    if (!identifiability.is_undetermined(u)) continue;
    const Unknown& unknown = result.unknowns[u];
    if (unknown.is_shape) return {};
    determined[unknown.channel] = false;
  }
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < determined.size(); ++c) {
    if (determined[c]) channels.push_back(c);
  }
  return channels;
}

/// What the coefficients of a channel make of the values of the basis functions.
double combined(const FitResult& result, std::size_t channel, std::span<const double> basis) {
  const auto amplitudes = result.values.amplitudes.col(Eigen::Index(channel));
  std::vector<double> coefficients(result.model.basis_size());
  result.model.coefficients({amplitudes.data(), std::size_t(amplitudes.size())}, coefficients);
  double sum = 0;
  for (std::size_t b = 0; b < basis.size(); ++b) sum += coefficients[b] * basis[b];
  return sum;
}

/// Models whose albedo exceeds 1 anywhere come near it at the most grazing angle.
bool is_worth_a_look(const FitResult& result, std::span<const std::size_t> channels, double theta_i,
                     double phi_i) {
  const std::vector<double> basis =
      brdf::rough_basis_albedo(result.model, result.values.shape, theta_i, phi_i);
  const double least = result.model.is_anisotropic() ? anisotropic_worth_a_look : worth_a_look;
  return std::any_of(channels.begin(), channels.end(),
                     [&](std::size_t channel) { return combined(result, channel, basis) > least; });
}

/// Replaces `largest` if an albedo of the given channels is larger for certain.
void look_at(const FitResult& result, std::span<const std::size_t> channels, double theta_i,
             double phi_i, LargestAlbedo& largest) {
  const brdf::Albedo basis =
      brdf::basis_albedo(result.model, result.values.shape, theta_i, phi_i, tolerance);
  for (const std::size_t channel : channels) {
    // Coefficients are not negative.
    const double value =
        combined(result, channel, basis.values) - combined(result, channel, basis.errors);
    if (value > largest.value) largest = {value, theta_i, channel};
  }
}

}  // namespace

std::optional<std::string> albedo_warning(const FitResult& result,
                                          const Identifiability& identifiability,
                                          const brdf::Direction<double>& most_grazing_wi) {
  const std::vector<std::size_t> channels = determined_channels(result, identifiability);
  if (channels.empty()) return std::nullopt;
  const brdf::Direction<double>& wi = most_grazing_wi;
  // Closer to the horizon than any instrument, and than is needed to see where a model goes.
  constexpr double most_grazing = 89.9999 * radians_per_degree;
  const double theta_i = std::min(std::atan2(std::hypot(wi.x, wi.y), wi.z), most_grazing);
  const double phi_i = std::atan2(wi.y, wi.x);
  LargestAlbedo largest;
  for (const double azimuth : azimuths_of(result.model, phi_i)) {
    if (!is_worth_a_look(result, channels, theta_i, azimuth)) continue;
    for (const double angle : angles_up_to(theta_i)) {
      look_at(result, channels, angle, azimuth, largest);
    }
  }
  if (largest.value <= 1) return std::nullopt;
  return fmt::format(
      "the albedo of channel {} is {:.3g} for light from {:.4g} deg, an angle that the samples "
      "reach: the model reflects more light than arrives; 'gonio albedo' shows at which angles",
      result.channels[largest.channel], largest.value, largest.theta_i / radians_per_degree);
}

}  // namespace gonio::fit
