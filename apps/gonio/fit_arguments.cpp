#include "apps/gonio/fit_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "apps/gonio/command.h"

namespace gonio::app {
namespace {

double number_in(std::string_view text, std::string_view option, std::string_view form) {
  const std::optional<double> value = parse_number(text);
  if (!value) {
    throw std::invalid_argument(
        fmt::format("{} needs {}; '{}' is not a number", option, form, text));
  }
  return *value;
}

/// Splits at the first `separator`. Throws if there is none.
std::pair<std::string, std::string> split(const std::string& text, char separator,
                                          std::string_view option, std::string_view form) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) {
    throw std::invalid_argument(fmt::format("{} needs {}; found '{}'", option, form, text));
  }
  return {text.substr(0, at), text.substr(at + 1)};
}

std::vector<fit::ParameterSetting> settings_in(const std::vector<std::string>& texts,
                                               std::string_view option) {
  constexpr std::string_view form = "parameter=value, e.g. alpha_x=0.1 or rho_d.R=0.2";
  std::vector<fit::ParameterSetting> settings;
  for (const std::string& text : texts) {
    const auto [parameter, value] = split(text, '=', option, form);
    settings.push_back({parameter, number_in(value, option, form)});
  }
  return settings;
}

/// Sets the loss and its scale.
void set_loss(const FitArguments& arguments, fit::Options& options) {
  options.loss = fit::loss_from_name(arguments.loss);
  if (arguments.loss_scale.empty()) return;
  constexpr std::string_view form = "a number above 0, in the unit of the metric";
  if (options.loss == fit::Loss::none) {
    throw std::invalid_argument(
        "--loss-scale is where a robust loss begins to doubt a residual: add --loss huber, cauchy "
        "or tukey");
  }
  const double scale = number_in(arguments.loss_scale, "--loss-scale", form);
  if (!(std::isfinite(scale) && scale > 0)) {
    throw std::invalid_argument(
        fmt::format("--loss-scale needs {}; found {}", form, arguments.loss_scale));
  }
  options.loss_scale = scale;
}

}  // namespace

fit::Options options_in(const FitArguments& arguments) {
  fit::Options options;
  options.metric = fit::metric_from_name(arguments.metric);
  set_loss(arguments, options);
  options.covariance = fit::covariance_from_name(arguments.covariance);
  if (!(arguments.max_theta > 0 && arguments.max_theta <= 90)) {
    throw std::invalid_argument("--max-theta needs an angle above 0 and up to 90 degrees");
  }
  options.max_theta_deg = arguments.max_theta;
  if (arguments.threads < 0) throw std::invalid_argument("--threads needs a number from 0 (all)");
  options.threads = arguments.threads;
  if (!arguments.noise.empty()) {
    constexpr std::string_view form = "REL,ABS, e.g. 0.02,0.001 for 2 % and 0.001/sr";
    if (options.metric != fit::Metric::chi2) {
      throw std::invalid_argument("--noise is what metric chi2 weighs by: add --metric chi2");
    }
    const auto [relative, absolute] = split(arguments.noise, ',', "--noise", form);
    options.noise = {number_in(relative, "--noise", form), number_in(absolute, "--noise", form)};
  }
  options.homogeneous = arguments.homogeneous;
  options.fixed = settings_in(arguments.fixed, "--fix");
  options.start = settings_in(arguments.start, "--start");
  for (const std::string& text : arguments.bounds) {
    constexpr std::string_view form = "parameter=lower:upper, e.g. alpha=0.01:0.5";
    const auto [parameter, range] = split(text, '=', "--bounds", form);
    const auto [lower, upper] = split(range, ':', "--bounds", form);
    options.bounds.push_back(
        {parameter, number_in(lower, "--bounds", form), number_in(upper, "--bounds", form)});
  }
  return options;
}

brdf::Frame frame_in(const FitArguments& arguments) {
  return arguments.free_frame ? brdf::Frame::free : brdf::Frame::of_table;
}

std::optional<std::vector<brdf::Model>> models_in(const FitArguments& arguments) {
  if (!arguments.models || *arguments.models == "all") return std::nullopt;
  std::vector<brdf::Model> models;
  std::string_view rest = *arguments.models;
  while (true) {
    const std::size_t comma = rest.find(',');
    brdf::Model model(rest.substr(0, comma), frame_in(arguments));
    if (std::none_of(models.begin(), models.end(),
                     [&](const brdf::Model& other) { return other.name() == model.name(); })) {
      models.push_back(std::move(model));
    }
    if (comma == std::string_view::npos) return models;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace gonio::app
