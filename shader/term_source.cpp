#include "shader/term_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "brdf/free_frame.h"

namespace gonio::shader {
namespace {

using brdf::TermKind;

using Names = std::vector<std::string_view>;

/// Ward's lobes are one function each, isotropic where both roughnesses are the same.
void add_ward(std::vector<TermSource>& sources, std::string_view term, std::string_view term_aniso,
              std::string_view name, const Names& directions) {
  sources.push_back({term, TermKind::specular, name, {"alpha", "alpha"}, directions, {"rho_s"}});
  sources.push_back(
      {term_aniso, TermKind::specular, name, {"alpha_x", "alpha_y"}, directions, {"rho_s"}});
}

std::vector<TermSource> make_sources() {
  const Names pair{"wi", "wo"};
  const Names lobe{"h", "wi", "wo"};
  const Names one_exponent{"n"};
  const Names two_exponents{"nu", "nv"};
  const Names layer{"Rd_under_Rs", "Rs", ""};
  const Names strauss{"s", "m", "one_minus_s", "one_minus_m", "one_minus_t"};

  std::vector<TermSource> sources{
      {"lambert", TermKind::diffuse, "lambert", {}, {}, {"rho_d"}},
      {"oren-nayar", TermKind::diffuse, "oren_nayar", {"sigma"}, pair, {"rho_d"}},
      {"oren-nayar-full",
       TermKind::diffuse,
       "oren_nayar_full",
       {"sigma"},
       pair,
       {"rho_d", "rho_d_squared"}},
      {"phong", TermKind::specular, "phong", {"exponent"}, pair, {"ks"}},
      {"blinn-phong", TermKind::specular, "blinn_phong", {"exponent"}, {"h"}, {"ks"}},
      {"ashikhmin-shirley",
       TermKind::specular,
       "ashikhmin_shirley",
       one_exponent,
       lobe,
       {"Rs", ""}},
      {"ashikhmin-shirley-aniso",
       TermKind::specular,
       "ashikhmin_shirley_aniso",
       two_exponents,
       lobe,
       {"Rs", ""}},
      {"ashikhmin-shirley", TermKind::whole, "ashikhmin_shirley_coupled", one_exponent, lobe,
       layer},
      {"ashikhmin-shirley-aniso", TermKind::whole, "ashikhmin_shirley_coupled_aniso", two_exponents,
       lobe, layer},
      {"strauss", TermKind::whole, "strauss", strauss, pair, {"c", ""}},
      {"strauss-listing", TermKind::whole, "strauss_listing", strauss, pair, {"c", ""}}};
  add_ward(sources, "ward", "ward-aniso", "ward", lobe);
  add_ward(sources, "ward-approx", "ward-approx-aniso", "ward_approx", lobe);
  add_ward(sources, "ward-duer", "ward-duer-aniso", "ward_duer", lobe);
  add_ward(sources, "ward-gmd", "ward-gmd-aniso", "ward_gmd", {"h"});
  return sources;
}

std::string meaning_of(const brdf::Parameter& parameter) {
  if (parameter.unit == "1") return std::string(parameter.meaning);
  return fmt::format("{}, in {}", parameter.meaning, parameter.unit);
}

constexpr std::string_view complement_prefix = "one_minus_";

/// The argument of that name: a parameter of the term, or its difference from 1, which is taken
/// here because in float it would lose digits.
ShapeConstant shape_constant(const brdf::TermEntry& term, std::span<const double> values,
                             std::string_view argument, std::string_view suffix) {
  const bool is_complement = argument.starts_with(complement_prefix);
  const std::string_view name =
      is_complement ? argument.substr(complement_prefix.size()) : argument;
  const auto found = std::find_if(term.shape.begin(), term.shape.end(),
                                  [&](const brdf::Parameter& p) { return p.name == name; });
  if (found == term.shape.end()) {
    throw std::logic_error(fmt::format("the shader of '{}' wants '{}', which the term has not",
                                       term.description.name, argument));
  }
  const double value = values[std::size_t(found - term.shape.begin())];
  std::string own_name = fmt::format("{}{}", argument, suffix);
  if (!is_complement) return {std::move(own_name), {value}, meaning_of(*found)};
  return {std::move(own_name),
          {1 - value},
          fmt::format("1 - {0}{1} for {0}{1} = {2}: {3}", name, suffix, value, found->meaning)};
}

/// A number from -1 to 1 as a multiple of 1/4096 and the rest.
std::vector<double> in_two_parts(double x) {
  constexpr double parts = 4096;
  const double high = std::round(x * parts) / parts;
  return {high, x - high};
}

}  // namespace

const TermSource& term_source(const brdf::TermEntry& term) {
  static const std::vector<TermSource> sources = make_sources();
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const TermSource& source) {
    return source.term == term.description.name && source.kind == term.description.kind;
  });
  if (found == sources.end()) {
    throw std::logic_error(
        fmt::format("the term '{}' has no HLSL source; add it to shader/hlsl "
                    "and to the list in shader/term_source.cpp",
                    term.description.name));
  }
  return *found;
}

bool has_tangent_angle(const brdf::TermEntry& term) {
  return !term.shape.empty() && term.shape.back().name == brdf::tangent_angle.name;
}

std::vector<ShapeConstant> shape_constants(const brdf::TermEntry& term, const TermSource& source,
                                           std::span<const double> values,
                                           std::string_view suffix) {
  std::vector<ShapeConstant> constants;
  const Names& arguments = source.shape;
  for (auto argument = arguments.begin(); argument != arguments.end(); ++argument) {
    if (std::find(arguments.begin(), argument, *argument) != argument) continue;
    constants.push_back(shape_constant(term, values, *argument, suffix));
  }
  if (has_tangent_angle(term)) {
    const double psi = values[term.shape.size() - 1];
    const std::string angle = fmt::format("psi{} = {}", suffix, psi);
    constants.push_back({fmt::format("cos_psi{}", suffix), in_two_parts(std::cos(psi)),
                         fmt::format("{}: {}", angle, meaning_of(brdf::tangent_angle))});
    constants.push_back({fmt::format("sin_psi{}", suffix), in_two_parts(std::sin(psi)), angle});
  }
  return constants;
}

}  // namespace gonio::shader
