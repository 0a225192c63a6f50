#include "fit/options.h"

#include <array>
#include <stdexcept>
#include <utility>

namespace gonio::fit {
namespace {

constexpr std::array metrics{std::pair{Metric::l2, std::string_view("l2")},
                             std::pair{Metric::cosine_l2, std::string_view("cosine-l2")},
                             std::pair{Metric::log, std::string_view("log")},
                             std::pair{Metric::cube_root, std::string_view("cube-root")},
                             std::pair{Metric::relative, std::string_view("relative")},
                             std::pair{Metric::chi2, std::string_view("chi2")}};
constexpr std::array losses{std::pair{Loss::none, std::string_view("none")},
                            std::pair{Loss::huber, std::string_view("huber")},
                            std::pair{Loss::cauchy, std::string_view("cauchy")},
                            std::pair{Loss::tukey, std::string_view("tukey")}};
constexpr std::array covariances{
    std::pair{Covariance::automatic, std::string_view("auto")},
    std::pair{Covariance::known_sigma, std::string_view("known-sigma")},
    std::pair{Covariance::residual, std::string_view("residual")},
    std::pair{Covariance::sandwich, std::string_view("sandwich")}};

template <class Names, class Value>
std::string_view name_in(const Names& names, Value value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  return "";
}

template <class Names>
auto value_in(const Names& names, std::string_view kind, std::string_view wanted) {
  std::string known;
  for (const auto& [candidate, name] : names) {
    if (name == wanted) return candidate;
    known += known.empty() ? "" : ", ";
    known += name;
  }
  throw std::invalid_argument(std::string(kind) + " '" + std::string(wanted) +
                              "' is not known; there are " + known);
}

}  // namespace

std::string_view name(Metric metric) { return name_in(metrics, metric); }
std::string_view name(Loss loss) { return name_in(losses, loss); }
std::string_view name(Covariance covariance) { return name_in(covariances, covariance); }
Metric metric_from_name(std::string_view name) { return value_in(metrics, "metric", name); }
Loss loss_from_name(std::string_view name) { return value_in(losses, "loss", name); }
Covariance covariance_from_name(std::string_view name) {
  return value_in(covariances, "covariance", name);
}

}  // namespace gonio::fit
