#include "shader/compose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "shader/glsl.h"
#include "shader/hlsl_sources.h"
#include "shader/identifier.h"
#include "shader/term_source.h"

namespace gonio::shader {
namespace {

/// A coefficient times a basis function, both at most this, is a float; as gonio_largest of
/// quotient.hlsl.
constexpr double largest = 1e18;

/// No shader type has more components.
constexpr std::size_t most_components = 4;

/// The double as a float literal, in a form that a shader's float can hold.
std::string literal(double value) {
  const double held = std::abs(value) < double(std::numeric_limits<float>::min())
                          ? 0
                          : std::clamp(value, -largest, largest);
  std::string text = fmt::format("{}", held);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// What has to be said about the values that are not held as they are.
std::string remark(std::span<const double> values) {
  std::string text;
  for (const double value : values) {
    const bool is_small = value != 0 && std::abs(value) < double(std::numeric_limits<float>::min());
    if (!is_small && std::abs(value) <= largest) continue;
    text += fmt::format("{}{} is beyond a shader's float", text.empty() ? "" : "; ", value);
  }
  return text;
}

std::string with_comment(const std::string& code, const std::string& comment) {
  return comment.empty() ? code + '\n' : fmt::format("{}  // {}\n", code, comment);
}

std::string type_of(std::size_t components) {
  return components == 1 ? "float" : fmt::format("float{}", components);
}

/// One number or a vector of them.
std::string value_of(std::span<const double> components) {
  if (components.size() == 1) return literal(components.front());
  std::string list;
  for (const double c : components) {
    list += list.empty() ? "" : ", ";
    list += literal(c);
  }
  return fmt::format("{}({})", type_of(components.size()), list);
}

std::string comment_line(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, ' ');
  // A backslash there would make a comment of the next line too.
  if (line.ends_with('\\')) line += '.';
  return line.empty() ? "//\n" : "// " + line + '\n';
}

/// A term of the model and where its parts of the model's lists begin.
struct PlacedTerm {
  const brdf::TermEntry& entry;
  const TermSource& source;
  std::size_t first_basis;
  std::size_t first_shape;
  std::string suffix;  // of its parameters
};

std::vector<PlacedTerm> placed_terms(const brdf::Model& model) {
  constexpr std::size_t second_specular = 2;
  std::vector<PlacedTerm> terms;
  std::size_t basis = 0;
  std::size_t shape = 0;
  for (const brdf::TermEntry* entry : model.terms()) {
    const std::string suffix(terms.size() == second_specular ? brdf::second_lobe_suffix : "");
    terms.push_back({*entry, term_source(*entry), basis, shape, suffix});
    basis += entry->basis_size;
    shape += entry->shape.size();
  }
  return terms;
}

/// Writes the function of one bound model, in HLSL.
class FunctionText {
 public:
  FunctionText(const brdf::BoundModel& model, std::string name)
      : model_(model), name_(std::move(name)), terms_(placed_terms(model.model())) {}

  std::string signature() const {
    return has_vector()
               ? fmt::format("{} {}(float3 wi, float3 wo)", type_of(channels()), name_)
               : fmt::format("void {}(float3 wi, float3 wo, out float f_r[{}])", name_, channels());
  }

  std::string text() const {
    std::string body = signature() + " {\n" + horizon();
    if (uses_half_vector()) body += "  float3 h = wi + wo;\n";
    for (const PlacedTerm& term : terms_) body += "\n" + constants(term) + evaluation(term);
    return body + "\n" + result() + "}\n";
  }

  std::vector<std::string_view> files() const {
    std::vector<std::string_view> names;
    for (const PlacedTerm& term : terms_) {
      names.push_back(term.source.name);
      if (has_tangent_angle(term.entry)) names.emplace_back("turned");
    }
    return names;
  }

 private:
  std::size_t channels() const { return model_.channel_count(); }
  bool has_vector() const { return channels() <= most_components; }

  bool uses_half_vector() const {
    return std::any_of(terms_.begin(), terms_.end(), [](const PlacedTerm& term) {
      const auto& names = term.source.directions;
      return std::find(names.begin(), names.end(), "h") != names.end();
    });
  }

  std::string horizon() const {
    constexpr std::string_view below = "  if (!(wi.z > 0.0 && wo.z > 0.0)) return";
    if (has_vector())
      return fmt::format("{} {};\n", below, value_of(std::vector<double>(channels(), 0)));
    return fmt::format(
        "  for (int channel = 0; channel < {}; ++channel) f_r[channel] = 0.0;\n{};\n", channels(),
        below);
  }

  /// The coefficients of one basis function of all channels.
  std::vector<double> coefficients(std::size_t basis) const {
    std::vector<double> values;
    for (std::size_t c = 0; c < channels(); ++c) values.push_back(model_.coefficients(c)[basis]);
    return values;
  }

  std::string constants(const PlacedTerm& term) const {
    std::string text =
        fmt::format("  // {}: {}\n", term.entry.description.name, term.entry.description.summary);
    const auto shape = model_.shape().subspan(term.first_shape, term.entry.shape.size());
    for (const ShapeConstant& c : shape_constants(term.entry, shape, term.suffix)) {
      const std::string code = fmt::format("  const {} {} = {};", type_of(c.components.size()),
                                           c.name, value_of(c.components));
      const std::string odd = remark(c.components);
      text += with_comment(code, odd.empty() ? c.meaning : c.meaning + "; " + odd);
    }
    for (std::size_t b = 0; has_vector() && b < term.entry.basis_size; ++b) {
      const std::string_view name = term.source.coefficients[b];
      if (name.empty()) continue;
      const std::vector<double> values = coefficients(term.first_basis + b);
      text += with_comment(fmt::format("  const {} {}{} = {};", type_of(channels()), name,
                                       term.suffix, value_of(values)),
                           remark(values));
    }
    return text;
  }

  static std::string variable(const PlacedTerm& term) {
    return fmt::format("{}{}", term.source.name, term.suffix);
  }

  static std::string evaluation(const PlacedTerm& term) {
    std::string arguments;
    const auto add = [&](const std::string& argument) {
      arguments += arguments.empty() ? argument : ", " + argument;
    };
    for (const std::string_view name : term.source.shape) add(std::string(name) + term.suffix);
    for (const std::string_view name : term.source.directions) {
      const bool is_turned = name == "h" && has_tangent_angle(term.entry);
      add(is_turned ? fmt::format("gonio_turned(wi, wo, cos_psi{0}, sin_psi{0})", term.suffix)
                    : std::string(name));
    }
    return fmt::format("  {} {} = gonio_{}({});\n", type_of(term.entry.basis_size), variable(term),
                       term.source.name, arguments);
  }

  /// A basis function of the term, as evaluation() names it.
  static std::string basis(const PlacedTerm& term, std::size_t b) {
    if (term.entry.basis_size == 1) return variable(term);
    return fmt::format("{}.{}", variable(term), "xyzw"[b]);
  }

  std::string result() const {
    if (has_vector()) return fmt::format("  return {};\n", sum_of_names());
    std::string text;
    for (std::size_t c = 0; c < channels(); ++c) text += channel_line(c);
    return text;
  }

  std::string sum_of_names() const {
    std::string sum;
    for (const PlacedTerm& term : terms_) {
      for (std::size_t b = 0; b < term.entry.basis_size; ++b) {
        const std::string_view name = term.source.coefficients[b];
        sum += sum.empty() ? "" : " + ";
        sum += name.empty() ? basis(term, b)
                            : fmt::format("{}{} * {}", name, term.suffix, basis(term, b));
      }
    }
    return sum;
  }

  std::string channel_line(std::size_t channel) const {
    std::string sum;
    const std::span<const double> all = model_.coefficients(channel);
    for (const PlacedTerm& term : terms_) {
      for (std::size_t b = 0; b < term.entry.basis_size; ++b) {
        sum += sum.empty() ? "" : " + ";
        sum += term.source.coefficients[b].empty()
                   ? basis(term, b)
                   : fmt::format("{} * {}", literal(all[term.first_basis + b]), basis(term, b));
      }
    }
    return with_comment(fmt::format("  f_r[{}] = {};", channel, sum), remark(all));
  }

  const brdf::BoundModel& model_;
  std::string name_;
  std::vector<PlacedTerm> terms_;
};

std::string header(const std::string& signature, const brdf::Model& model, const SourceText& text) {
  std::string comment;
  for (const std::string& line : text.header) comment += comment_line(line);
  if (!text.header.empty()) comment += "//\n";
  comment += fmt::format("// {}\n", signature);
  comment +=
      fmt::format("// The BRDF f_r in 1/sr of the model {}, without the cosine.\n", model.name());
  return comment +
         "// wi points to the light, wo to the viewer: unit vectors in the local frame, x = "
         "tangent\n"
         "// (along the brushing), y = bitangent, z = surface normal. 0 where wi.z or wo.z is not\n"
         "// above 0.\n"
         "// The radiance that a directional light of unit perpendicular irradiance gives is f_r "
         "*\n"
         "// wi.z; where a shader's diffuse colour stands without 1/pi, pi * f_r * wi.z.\n\n";
}

/// The files of the terms, as hlsl_with_includes wants them.
std::string helpers(const FunctionText& function) {
  std::vector<std::string> files;
  for (const std::string_view name : function.files()) files.push_back(std::string(name) + ".hlsl");
  const std::vector<std::string_view> views(files.begin(), files.end());
  return hlsl_with_includes(views);
}

/// What glsl_from_hlsl() takes for granted.
constexpr std::string_view glsl_preamble = R"(#ifndef GONIO_PRECISE
#ifdef GL_ES
precision highp float;
#define GONIO_PRECISE
#else
#define GONIO_PRECISE precise
#endif
#endif

)";

}  // namespace

std::string function_source(const brdf::BoundModel& model, Language language,
                            const SourceText& text) {
  const FunctionText function(model, identifier_from(text.name));
  const std::string signature = function.signature();
  const std::string code = helpers(function) + function.text();
  if (language == Language::hlsl) return header(signature, model.model(), text) + code;
  return header(glsl_from_hlsl(signature), model.model(), text) + std::string(glsl_preamble) +
         glsl_from_hlsl(code);
}

}  // namespace gonio::shader
