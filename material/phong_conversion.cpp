#include "material/phong_conversion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "brdf/model.h"

namespace gonio::material {
namespace {

using std::numbers::pi;

/// What a lobe's shape parameter is, in terms of the half vector's cosine.
enum class Family { mirror_power, half_vector_power, ashikhmin_shirley, ward };

struct ConvertibleTerm {
  std::string_view name;
  Family family;
};

constexpr std::array<ConvertibleTerm, 7> families{
    {{"phong", Family::mirror_power},
     {"blinn-phong", Family::half_vector_power},
     {"ward", Family::ward},
     {"ward-approx", Family::ward},
     {"ward-duer", Family::ward},
     {"ward-gmd", Family::ward},
     {"ashikhmin-shirley", Family::ashikhmin_shirley}}};

constexpr auto term_names = [] {
  std::array<std::string_view, families.size()> names{};
  std::transform(families.begin(), families.end(), names.begin(),
                 [](const ConvertibleTerm& term) { return term.name; });
  return names;
}();

Family family_of(std::string_view term) {
  const auto found =
      std::find_if(families.begin(), families.end(),
                   [&](const ConvertibleTerm& candidate) { return candidate.name == term; });
  if (found != families.end()) return found->family;
  throw std::invalid_argument(fmt::format("'{}' has no closed form; those with one are {}", term,
                                          fmt::join(term_names, ", ")));
}

/// The isotropic specular term of that name, which has one shape and one amplitude.
const brdf::TermEntry& term_entry(std::string_view term) {
  const auto terms = brdf::all_terms();
  return *std::find_if(terms.begin(), terms.end(), [&](const brdf::TermEntry& entry) {
    return entry.description.name == term && entry.description.kind == brdf::TermKind::specular;
  });
}

void require_within(double value, const brdf::Parameter& descriptor, std::string_view term) {
  if (value >= descriptor.lower && value <= descriptor.upper) return;
  throw std::invalid_argument(
      fmt::format("by the closed form {} needs {} = {:.4g}, which may be {:g} to {:g}", term,
                  descriptor.name, value, descriptor.lower, descriptor.upper));
}

}  // namespace

std::string_view name(Amplitude amplitude) {
  switch (amplitude) {
    case Amplitude::raw:
      return "raw";
    case Amplitude::normalised:
      return "normalised";
    case Amplitude::classic:
      return "classic";
  }
  return "";
}

Amplitude amplitude_from_name(std::string_view text) {
  for (const auto amplitude : {Amplitude::raw, Amplitude::normalised, Amplitude::classic}) {
    if (text == name(amplitude)) return amplitude;
  }
  throw std::invalid_argument(fmt::format(
      "there is no amplitude convention '{}'; there are raw, normalised and classic", text));
}

double raw_amplitude(Amplitude convention, double value, double exponent) {
  switch (convention) {
    case Amplitude::normalised:
      return value * (exponent + 2) / (2 * pi);
    case Amplitude::classic:
      return value / pi;
    case Amplitude::raw:
      break;
  }
  return value;
}

double amplitude_in(Amplitude convention, double ks, double exponent) {
  return ks / raw_amplitude(convention, 1, exponent);
}

std::span<const std::string_view> convertible_terms() { return term_names; }

const brdf::Parameter& shape_parameter(std::string_view term) {
  family_of(term);
  return term_entry(term).shape.front();
}

const brdf::Parameter& amplitude_parameter(std::string_view term) {
  family_of(term);
  return term_entry(term).amplitudes.front();
}

double half_vector_exponent(std::string_view term, double shape) {
  switch (family_of(term)) {
    case Family::mirror_power:
      return 4 * shape;
    case Family::ward:
      return 2 / (shape * shape) - 2;
    case Family::half_vector_power:
    case Family::ashikhmin_shirley:
      break;
  }
  return shape;
}

double shape_of_exponent(std::string_view term, double half_vector_exponent) {
  const Family family = family_of(term);
  if (!(half_vector_exponent > (family == Family::ward ? -2 : -1e-15))) {
    throw std::invalid_argument(fmt::format(
        "a half-vector exponent of {:.4g} is wider than any lobe of {}: a roughness above 1 has no "
        "closed form",
        half_vector_exponent, term));
  }
  switch (family) {
    case Family::mirror_power:
      return std::max(0.0, half_vector_exponent) / 4;
    case Family::ward:
      return std::sqrt(2 / (half_vector_exponent + 2));
    case Family::half_vector_power:
    case Family::ashikhmin_shirley:
      break;
  }
  return std::max(0.0, half_vector_exponent);
}

double peak_at_normal(std::string_view term, double shape) {
  switch (family_of(term)) {
    case Family::ward:
      return 1 / (4 * pi * shape * shape);
    case Family::ashikhmin_shirley:
      return (shape + 1) / (8 * pi);
    case Family::mirror_power:
    case Family::half_vector_power:
      break;
  }
  return 1;
}

Lobe closed_form(const Lobe& lobe, std::string_view to) {
  Lobe result{.term = std::string(to),
              .shape = shape_of_exponent(to, half_vector_exponent(lobe.term, lobe.shape)),
              .amplitudes = {}};
  require_within(result.shape, shape_parameter(to), to);
  const double per_amplitude =
      peak_at_normal(lobe.term, lobe.shape) / peak_at_normal(to, result.shape);
  for (const double amplitude : lobe.amplitudes) {
    result.amplitudes.push_back(amplitude * per_amplitude);
    require_within(result.amplitudes.back(), amplitude_parameter(to), to);
  }
  return result;
}

Material material_of(const Lobe& lobe, std::span<const double> rho_d,
                     std::span<const std::string> channels) {
  Material material;
  material.model = brdf::Model("lambert+" + lobe.term).name();
  material.channels.assign(channels.begin(), channels.end());
  material.parameters = {
      {"rho_d", {rho_d.begin(), rho_d.end()}, {}, {}},
      {std::string(amplitude_parameter(lobe.term).name), lobe.amplitudes, {}, {}},
      {std::string(shape_parameter(lobe.term).name), {lobe.shape}, {}, {}}};
  return material;
}

}  // namespace gonio::material
