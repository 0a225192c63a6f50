#include "bench/shader_accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace gonio::bench {
namespace {

std::string_view name_of(shader::Language language) {
  return language == shader::Language::hlsl ? "hlsl" : "glsl";
}

std::string angles_of(const brdf::Direction<float>& w) {
  constexpr double degrees = 180 / std::numbers::pi;
  const double theta = degrees * std::atan2(std::hypot(double(w.x), double(w.y)), double(w.z));
  const double phi = degrees * std::atan2(double(w.y), double(w.x));
  return fmt::format("{:.4f},{:.4f}", theta, phi);
}

std::string mark_of(const ShaderErrors& errors) {
  if (errors.not_finite > 0) return "NaN";
  if (errors.lit_below_horizon > 0) return "lit";
  return figure_holds(errors) ? "" : ">";
}

bool is_worse(const ShaderErrors& a, const ShaderErrors& b) {
  if (figure_holds(a) != figure_holds(b)) return figure_holds(b);
  return a.worst.error > b.worst.error;
}

/// The worst materials of every model in both languages, in the order of the models.
std::vector<ShaderErrors> worst_of_models(const std::vector<ShaderErrors>& all) {
  std::vector<ShaderErrors> worst;
  for (const ShaderErrors& errors : all) {
    const auto same = std::find_if(worst.begin(), worst.end(), [&](const ShaderErrors& w) {
      return w.model == errors.model && w.language == errors.language;
    });
    if (same == worst.end()) {
      worst.push_back(errors);
    } else if (is_worse(errors, *same)) {
      *same = errors;
    }
  }
  return worst;
}

double largest_of_peak(const std::vector<ShaderErrors>& all, const ShaderErrors& of) {
  double largest = 0;
  for (const ShaderErrors& errors : all) {
    if (errors.model != of.model || errors.language != of.language) continue;
    largest = std::max(largest, errors.worst_of_peak.error);
  }
  return largest;
}

}  // namespace

std::string shader_error_table(const std::vector<ShaderErrors>& all) {
  std::string table =
      fmt::format("{:3} {:43} {:4} {:>8} {:>8}  {}\n", "", "model", "", "error", "of peak",
                  "parameters; f_r found, expected; wi, wo as theta,phi in degrees");
  for (const ShaderErrors& errors : worst_of_models(all)) {
    const ShaderError& e = errors.worst;
    table += fmt::format("{:3} {:43} {:4} {:8.1e} {:8.1e}  {}{}{:.7g}, {:.7g}; {}, {}\n",
                         mark_of(errors), errors.model, name_of(errors.language), e.error,
                         largest_of_peak(all, errors), errors.parameters,
                         errors.parameters.empty() ? "" : "; ", e.found, e.expected,
                         angles_of(e.pair.wi), angles_of(e.pair.wo));
  }
  return table;
}

std::string narrow_lobe_table(const std::vector<ShaderErrors>& all) {
  std::string table = fmt::format("{:3} {:43} {:44} {:4} {:>8} {:>10} {:>8}\n", "", "model",
                                  "parameters", "", "error", "directions", "at most");
  for (const ShaderErrors& errors : all) {
    table += fmt::format("{:3} {:43} {:44} {:4} {:8.1e} {:10.1e} {:8.1e}\n", mark_of(errors),
                         errors.model, errors.parameters, name_of(errors.language),
                         errors.worst.error, errors.input_rounding, errors.input_rounding_bound);
  }
  return table;
}

}  // namespace gonio::bench
