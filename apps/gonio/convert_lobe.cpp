// gonio convert LOBE: one lobe given on the command line.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "apps/gonio/convert.h"
#include "brdf/model.h"
#include "material/material_json.h"

namespace gonio::app {
namespace {

using material::Amplitude;
using material::Conversion;

bool is_phong(std::string_view term) { return term.ends_with("phong"); }
bool is_ward(std::string_view term) { return term.starts_with("ward"); }

/// An option that belongs to the lobe, or its default. Throws if it is not within the bounds.
double value_of(std::string_view option, const std::string& text, double otherwise, double lower,
                double upper) {
  const double value = text.empty() ? otherwise : number_of(option, text);
  if (value >= lower && value <= upper) return value;
  throw std::invalid_argument(
      fmt::format("{} {:g}: expected {:g} to {:g}", option, value, lower, upper));
}

double shape_in(const ConvertArguments& arguments) {
  const std::string& term = arguments.source;
  const bool has_alpha = is_ward(term);
  const std::string_view option = has_alpha ? "--alpha" : "--exponent";
  const std::string& text = has_alpha ? arguments.alpha : arguments.exponent;
  if (text.empty()) {
    throw std::invalid_argument(
        fmt::format("convert {}: {} is missing: say how wide the lobe is", term, option));
  }
  if (!(has_alpha ? arguments.exponent : arguments.alpha).empty()) {
    throw std::invalid_argument(fmt::format("convert {}: the lobe's width is {}, not {}", term,
                                            option, has_alpha ? "--exponent" : "--alpha"));
  }
  const double value = number_of(option, text);
  if (!has_alpha && !(value > 0)) {
    throw std::invalid_argument(fmt::format(
        "--exponent {}: expected an exponent above 0: at 0 there is no highlight", text));
  }
  return has_alpha ? value_of(option, text, 0, 1e-4, 10) : value_of(option, text, 0, 0, 1e6);
}

double amplitude_value_in(const ConvertArguments& arguments) {
  const std::string& term = arguments.source;
  struct Option {
    std::string_view name;
    const std::string& text;
    bool belongs;
    double otherwise;
    double upper;
  };
  const double largest = 1e6;
  const std::array<Option, 3> options{
      {{"--ks", arguments.ks, is_phong(term), 1, largest},
       {"--rho-s", arguments.rho_s, is_ward(term), 1, largest},
       {"--Rs", arguments.specular_share, term == "ashikhmin-shirley", 0.05, 1}}};
  double value = 0;
  for (const Option& option : options) {
    if (option.belongs) {
      value = value_of(option.name, option.text, option.otherwise, 0, option.upper);
    } else if (!option.text.empty()) {
      throw std::invalid_argument(
          fmt::format("convert {}: {} is no amplitude of it", term, option.name));
    }
  }
  return value;
}

Amplitude convention_in(const ConvertArguments& arguments) {
  if (arguments.amplitude.empty()) return Amplitude::raw;
  if (!is_phong(arguments.source)) {
    throw std::invalid_argument(fmt::format(
        "convert {}: --amplitude is how ks of phong and blinn-phong is given", arguments.source));
  }
  return material::amplitude_from_name(arguments.amplitude);
}

material::LobeMaterial lobe_in(const ConvertArguments& arguments) {
  const double shape = shape_in(arguments);
  const Amplitude convention = convention_in(arguments);
  const double given = amplitude_value_in(arguments);
  const double amplitude =
      is_phong(arguments.source) ? material::raw_amplitude(convention, given, shape) : given;
  return {.name = {},
          .channels = {"Y"},
          .rho_d = {0},
          .lobe = {.term = arguments.source, .shape = shape, .amplitudes = {amplitude}},
          .is_classic = convention == Amplitude::classic};
}

std::string target_in(const ConvertArguments& arguments) {
  ConvertArguments with_default = arguments;
  if (arguments.to.empty()) with_default.to = is_phong(arguments.source) ? "ward" : "blinn-phong";
  return target_term_in(with_default);
}

/// The amplitude of a Phong lobe in each convention.
std::string conventions_of(const material::Lobe& lobe) {
  const double ks = lobe.amplitudes.front();
  return fmt::format("  ks {:.6g} 1/sr (raw) = {:.6g} (normalised) = {:.6g} (classic)\n", ks,
                     material::amplitude_in(Amplitude::normalised, ks, lobe.shape),
                     material::amplitude_in(Amplitude::classic, ks, lobe.shape));
}

std::string described(const material::LobeMaterial& from, std::string_view to) {
  const material::Material as_material = material_of(from.lobe, from.rho_d, from.channels);
  const auto& amplitude = as_material.parameters[1];
  const auto& shape = as_material.parameters[2];
  std::string text = fmt::format("{}, {} {:.6g}, {} {:.6g}{}, as {}\n", from.lobe.term, shape.name,
                                 shape.value.front(), amplitude.name, amplitude.value.front(),
                                 from.is_classic ? " (classic: without the cosine)" : "", to);
  if (is_phong(from.lobe.term)) text += conventions_of(from.lobe);
  return text;
}

struct Attempt {
  material::ConversionMethod method;
  std::optional<Conversion> conversion;
  std::string problem;
};

/// A closed form that does not exist is told beside the best fit, unless it was asked for alone.
std::vector<Attempt> attempts(const ConvertArguments& arguments, const material::LobeMaterial& from,
                              const std::string& to) {
  std::vector<Attempt> all;
  for (const auto method : methods_in(arguments)) {
    material::ConversionOptions options = conversion_options_in(arguments);
    options.method = method;
    try {
      all.push_back({method, convert(from, to, options), {}});
    } catch (const std::invalid_argument& error) {
      if (!arguments.method.empty() || method == material::ConversionMethod::best_fit) throw;
      all.push_back({method, std::nullopt, error.what()});
    }
  }
  return all;
}

void print_table(const std::vector<Attempt>& all, const material::ConversionOptions& options) {
  const auto& names = all.back().conversion->material.parameters;
  std::string text =
      fmt::format("\n  {:<12} {:>11} {:>11} {:>12} {:>9} {:>9} {:>10}\n", "", names[2].name,
                  names[1].name, name(options.metric), "peak", "rms", "albedo");
  for (const Attempt& attempt : all) {
    text += fmt::format("  {:<12}", name(attempt.method));
    if (!attempt.conversion) {
      text += fmt::format(" none: {}\n", attempt.problem);
      continue;
    }
    const Conversion& c = *attempt.conversion;
    text += fmt::format(" {:>11.6g} {:>11.6g} {:>12.6g} {:>9} {:>9} {:>10.3g}\n",
                        c.material.parameters[2].value.front(),
                        c.material.parameters[1].value.front(), c.metric_error,
                        percent(c.remaining.peak), percent(c.remaining.rms), c.remaining.albedo);
  }
  const material::Difference& remaining = all.back().conversion->remaining;
  if (remaining.peak > 0) {
    text += fmt::format("\nFarthest apart for light from {:.3g} deg at {:.3g} deg.\n",
                        remaining.where.theta_i_deg, remaining.where.theta_o_deg);
  }
  print(text + error_legend(options));
}

nlohmann::ordered_json json_of(const std::vector<Attempt>& all) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Attempt& attempt : all) {
    if (attempt.conversion) {
      nlohmann::ordered_json entry = to_json(attempt.conversion->material);
      entry["conversion"]["metric_error"] = attempt.conversion->metric_error;
      list.push_back(entry);
    } else {
      list.push_back(
          {{"conversion", {{"method", name(attempt.method)}}}, {"error", attempt.problem}});
    }
  }
  return {{"conversions", list}};
}

}  // namespace

void convert_lobe(const ConvertArguments& arguments, Invocation& invocation) {
  const material::LobeMaterial from = lobe_in(arguments);
  const std::string to = target_in(arguments);
  std::vector<Attempt> all = attempts(arguments, from, to);
  for (Attempt& attempt : all) {
    if (attempt.conversion) set_provenance(attempt.conversion->material, "", invocation);
  }
  if (arguments.json) {
    print_json(json_of(all));
  } else {
    print(described(from, to));
    print_table(all, conversion_options_in(arguments));
  }
  if (!arguments.output.empty()) write_material(all.back().conversion->material, arguments.output);
}

}  // namespace gonio::app
