#include "bench/cramer_rao.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fit/parameters.h"
#include "instrument/synthesize.h"
#include "tests/ward_reference.h"

namespace gonio::bench {
namespace {

using tests::Digits;
using Direction = brdf::Direction<double>;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// f_r for rho_s = 1.
using Lobe = Digits (*)(const Digits& alpha_x, const Digits& alpha_y, const Direction& wi,
                        const Direction& wo);

template <class T>
Digits lobe(const Digits& alpha_x, const Digits& alpha_y, const Direction& wi,
            const Direction& wo) {
  return tests::reference(T{}, alpha_x, alpha_y, wi, wo).value;
}

[[noreturn]] void refuse(const instrument::Recipe& recipe, std::string_view found) {
  throw std::invalid_argument(
      fmt::format("recipe '{}': {} has no multi-precision reference to take a Cramer-Rao bound "
                  "from; expected lambert and ward, ward-approx, ward-duer or ward-gmd, each also "
                  "with -aniso, in the sample's frame",
                  recipe.name, found));
}

Lobe lobe_of(const instrument::Recipe& recipe) {
  static const std::map<std::string, Lobe> lobes{
      {"lambert+ward", lobe<brdf::WardLobe>},
      {"lambert+ward-approx", lobe<brdf::WardApproxLobe>},
      {"lambert+ward-duer", lobe<brdf::WardDuerLobe>},
      {"lambert+ward-gmd", lobe<brdf::WardGmdLobe>},
  };
  static const std::set<std::string> known{"rho_d", "rho_s", "alpha", "alpha_x", "alpha_y"};
  for (const auto& [parameter, values] : recipe.parameters) {
    if (!known.contains(parameter)) refuse(recipe, fmt::format("the parameter '{}'", parameter));
  }
  constexpr std::string_view anisotropic = "-aniso";
  std::string name = brdf::Model(recipe.model).name();
  if (name.ends_with(anisotropic)) name.resize(name.size() - anisotropic.size());
  const auto found = lobes.find(name);
  if (found == lobes.end()) refuse(recipe, fmt::format("the model '{}'", recipe.model));
  return found->second;
}

/// The parameters of one channel.
struct Parameters {
  Digits rho_d, rho_s, alpha_x, alpha_y;
};

Parameters parameters_of(const instrument::Recipe& recipe, std::size_t channel) {
  const auto shape = [&](const std::string& name) {
    const auto found = recipe.parameters.find(name);
    return found == recipe.parameters.end() ? recipe.parameters.at("alpha")[0] : found->second[0];
  };
  return {recipe.parameters.at("rho_d").at(channel), recipe.parameters.at("rho_s").at(channel),
          shape("alpha_x"), shape("alpha_y")};
}

/// The lobe with one of its roughnesses moved by `step`; `alpha` is both.
Digits moved_lobe(Lobe lobe, const Parameters& parameters, std::string_view name,
                  const Digits& step, const Direction& wi, const Direction& wo) {
  const Digits alpha_x = name == "alpha_y" ? parameters.alpha_x : parameters.alpha_x + step;
  const Digits alpha_y = name == "alpha_x" ? parameters.alpha_y : parameters.alpha_y + step;
  return lobe(alpha_x, alpha_y, wi, wo);
}

/// d f_r / d parameter of f_r = rho_d / pi + rho_s lobe(alpha_x, alpha_y). The difference loses
/// about the square of its step, 1e-30, and rounding 1e-50 / 1e-15: far below long double.
long double derivative(Lobe lobe, const Parameters& parameters, std::string_view name,
                       const Direction& wi, const Direction& wo) {
  if (name == "rho_d") return static_cast<long double>(1 / tests::reference_pi());
  if (name == "rho_s") {
    return static_cast<long double>(lobe(parameters.alpha_x, parameters.alpha_y, wi, wo));
  }
  static const Digits step("1e-15");
  const Digits difference = moved_lobe(lobe, parameters, name, step, wi, wo) -
                            moved_lobe(lobe, parameters, name, -step, wi, wo);
  return static_cast<long double>(parameters.rho_s * difference / (2 * step));
}

/// Of f_r / sigma, [channel * samples + sample, unknown].
LongMatrix jacobian_of(const instrument::Recipe& recipe, const table::SampleTable& table,
                       std::span<const fit::Unknown> unknowns) {
  const Lobe lobe = lobe_of(recipe);
  const std::size_t samples = table.size();
  LongMatrix jacobian = LongMatrix::Zero(Eigen::Index(samples * table.channels.size()),
                                         Eigen::Index(unknowns.size()));
  for (std::size_t c = 0; c < table.channels.size(); ++c) {
    const Parameters truth = parameters_of(recipe, c);
    for (std::size_t u = 0; u < unknowns.size(); ++u) {
      if (!unknowns[u].is_shape && unknowns[u].channel != c) continue;
      for (std::size_t i = 0; i < samples; ++i) {
        jacobian(Eigen::Index(c * samples + i), Eigen::Index(u)) =
            derivative(lobe, truth, unknowns[u].parameter, table.wi[i], table.wo[i]) /
            table.sigma[c][i];
      }
    }
  }
  return jacobian;
}

}  // namespace

std::vector<double> cramer_rao_bounds(const instrument::Recipe& recipe) {
  instrument::Recipe with_sigma = recipe;
  with_sigma.sigma_columns = true;
  const table::SampleTable table = instrument::synthesize(with_sigma);
  const std::vector<fit::Unknown> unknowns =
      fit::unknowns_of(brdf::Model(recipe.model), recipe.channels);
  const LongMatrix jacobian = jacobian_of(recipe, table, unknowns);
  const LongMatrix information = jacobian.transpose() * jacobian;
  const LongMatrix covariance = information.inverse();
  std::vector<double> bounds;
  for (Eigen::Index u = 0; u < covariance.rows(); ++u) {
    bounds.push_back(double(std::sqrt(covariance(u, u))));
  }
  return bounds;
}

}  // namespace gonio::bench
