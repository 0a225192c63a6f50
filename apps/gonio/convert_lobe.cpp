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

double shape_in(const ConvertArguments& arguments) {
  const std::string& term = arguments.source;
  const bool has_alpha = width_name(term) == "alpha";
  const std::string& text = has_alpha ? arguments.alpha : arguments.exponent;
  const std::string& other = has_alpha ? arguments.exponent : arguments.alpha;
  if (text.empty() || !other.empty()) {
    throw std::invalid_argument(fmt::format("convert {}: {}: its width is given by --{}", term,
                                            text.empty() ? "how wide is it" : "two widths",
                                            width_name(term)));
  }
  return checked_width(term, number_of(has_alpha ? "--alpha" : "--exponent", text));
}

/// The amplitude as it is given, or its default.
double amplitude_value_in(const ConvertArguments& arguments) {
  const std::string& term = arguments.source;
  struct Option {
    std::string_view name;
    std::string_view amplitude;
    const std::string& text;
  };
  const std::array<Option, 3> options{{{"--ks", "ks", arguments.ks},
                                       {"--rho-s", "rho_s", arguments.rho_s},
                                       {"--Rs", "Rs", arguments.specular_share}}};
  double value = default_amplitude(term);
  for (const Option& option : options) {
    if (option.text.empty()) continue;
    if (option.amplitude != amplitude_name(term)) {
      throw std::invalid_argument(fmt::format("convert {}: {} is no amplitude of it, that is {}",
                                              term, option.name, amplitude_name(term)));
    }
    value = number_of(option.name, option.text);
  }
  return checked_amplitude(term, value);
}

material::LobeMaterial lobe_in(const ConvertArguments& arguments) {
  const std::string& term = arguments.source;
  const double shape = shape_in(arguments);
  const double given = amplitude_value_in(arguments);
  const auto convention = is_phong(term) && !arguments.amplitude.empty()
                              ? material::amplitude_from_name(arguments.amplitude)
                              : Amplitude::raw;
  return {.name = {},
          .channels = {"Y"},
          .rho_d = {0},
          .lobe = {.term = term,
                   .shape = shape,
                   .amplitudes = {is_phong(term) ? material::raw_amplitude(convention, given, shape)
                                                 : given}},
          .is_classic = convention == Amplitude::classic};
}

/// The amplitude of a Phong lobe in each convention.
std::string conventions_of(const material::Lobe& lobe) {
  const double ks = lobe.amplitudes.front();
  return fmt::format("ks {:.6g} 1/sr (raw) = {:.6g} (normalised) = {:.6g} (classic)", ks,
                     material::amplitude_in(Amplitude::normalised, ks, lobe.shape),
                     material::amplitude_in(Amplitude::classic, ks, lobe.shape));
}

std::string described(const material::LobeMaterial& from, std::string_view to) {
  const material::Lobe& lobe = from.lobe;
  std::string text = fmt::format("{}, {} {:.6g}, {} {:.6g}{}, as {}\n", lobe.term,
                                 material::shape_parameter(lobe.term).name, lobe.shape,
                                 amplitude_name(lobe.term), lobe.amplitudes.front(),
                                 from.is_classic ? " (classic: without the cosine)" : "", to);
  if (is_phong(lobe.term)) text += fmt::format("  {}\n", conventions_of(lobe));
  return text;
}

struct Attempt {
  material::ConversionMethod method;
  std::optional<Conversion> conversion;
  std::string problem;
};

material::ConversionOptions options_in(const ConvertArguments& arguments) {
  material::ConversionOptions options = conversion_options_in(arguments);
  options.to_classic = !is_phong(arguments.source) && wants_classic(arguments);
  return options;
}

/// A closed form that does not exist is told beside the best fit, unless it was asked for alone.
std::vector<Attempt> attempts(const ConvertArguments& arguments, const material::LobeMaterial& from,
                              const std::string& to) {
  std::vector<Attempt> all;
  const material::ConversionOptions given = options_in(arguments);
  for (const auto method : methods_in(arguments)) {
    if (given.to_classic && method != given.method) continue;
    material::ConversionOptions options = given;
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

/// One lobe of the result in its conventions, where it has them.
std::string result_conventions(const Conversion& conversion, bool is_classic) {
  const auto lobe = material::lobe_material_of(conversion.material);
  if (!is_phong(lobe->lobe.term)) return "";
  return fmt::format("  {}: {}{}\n", conversion.material.conversion->method,
                     conventions_of(lobe->lobe),
                     is_classic ? ", to be drawn without the cosine of the incidence" : "");
}

void print_table(const std::vector<Attempt>& all, const material::ConversionOptions& options,
                 std::string_view to) {
  std::string text = fmt::format("\n  {:<12} {:>11} {:>11} {:>12} {:>9} {:>9} {:>10}\n", "",
                                 material::shape_parameter(to).name, amplitude_name(to),
                                 name(options.metric), "peak", "rms", "albedo");
  std::string conventions;
  for (const Attempt& attempt : all) {
    text += fmt::format("  {:<12}", name(attempt.method));
    if (!attempt.conversion) {
      text += fmt::format(" none: {}\n", attempt.problem);
      continue;
    }
    const Conversion& c = *attempt.conversion;
    const material::Lobe lobe = material::lobe_material_of(c.material)->lobe;
    text += fmt::format(" {:>11.6g} {:>11.6g} {:>12.6g} {:>9} {:>9} {:>10.3g}\n", lobe.shape,
                        lobe.amplitudes.front(), c.material.conversion->metric_error,
                        percent(c.remaining.peak), percent(c.remaining.rms), c.remaining.albedo);
    conventions += result_conventions(c, options.to_classic);
  }
  if (!conventions.empty()) text += "\n" + conventions;
  const material::Difference& remaining = all.back().conversion->remaining;
  if (remaining.peak > 0) {
    text += fmt::format("\nFarthest apart for light from {:.3g} deg at {:.3g} deg.\n",
                        remaining.where.theta_i_deg, remaining.where.theta_o_deg);
  }
  print(text + error_legend(options));
}

/// A classic result is no material: its numbers.
nlohmann::ordered_json json_of(const Conversion& conversion, bool is_classic) {
  nlohmann::ordered_json json = to_json(conversion.material);
  if (!is_classic) return json;
  const material::Lobe lobe = material::lobe_material_of(conversion.material)->lobe;
  return {
      {"classic",
       {{"lobe", lobe.term},
        {"exponent", lobe.shape},
        {"Ks", material::amplitude_in(Amplitude::classic, lobe.amplitudes.front(), lobe.shape)}}},
      {"conversion", json["conversion"]}};
}

nlohmann::ordered_json json_of(const std::vector<Attempt>& all, bool is_classic) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Attempt& attempt : all) {
    if (attempt.conversion) {
      list.push_back(json_of(*attempt.conversion, is_classic));
    } else {
      list.push_back(
          {{"conversion", {{"method", name(attempt.method)}}}, {"error", attempt.problem}});
    }
  }
  return {{"conversions", list}};
}

}  // namespace

void convert_lobe(const ConvertArguments& arguments, Invocation& invocation) {
  const std::string to = target_term_in(arguments, default_target(arguments.source));
  const material::LobeMaterial from = lobe_in(arguments);
  const material::ConversionOptions options = options_in(arguments);
  if (options.to_classic && !arguments.output.empty()) {
    throw std::invalid_argument(
        "-o: a highlight without the cosine is no material of gonio: its Ks is printed");
  }
  std::vector<Attempt> all = attempts(arguments, from, to);
  for (Attempt& attempt : all) {
    if (attempt.conversion) set_provenance(attempt.conversion->material, {}, invocation);
  }
  if (arguments.json) {
    print_json(json_of(all, options.to_classic));
  } else {
    print(described(from, to));
    print_table(all, options, to);
  }
  if (!arguments.output.empty()) write_material(all.back().conversion->material, arguments.output);
}

}  // namespace gonio::app
