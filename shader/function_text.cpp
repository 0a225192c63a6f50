#include "shader/function_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "shader/literal.h"

namespace gonio::shader {
namespace {

/// No shader type has more components.
constexpr std::size_t most_components = 4;

std::string with_comment(const std::string& code, const std::string& comment) {
  return comment.empty() ? code + '\n' : fmt::format("{}  // {}\n", code, comment);
}

/// A term of the model and where its parts of the model's lists begin.
struct PlacedTerm {
  const brdf::TermEntry& entry;
  const TermSource& source;
  bool is_read;  // from a table
  std::size_t first_basis;
  std::size_t first_shape;
  std::string suffix;  // of its parameters
};

/// `table`: what is read from one, if anything.
std::vector<PlacedTerm> placed_terms(const brdf::Model& model,
                                     const std::optional<TableText>& table) {
  constexpr std::size_t second_specular = 2;
  std::vector<PlacedTerm> terms;
  std::size_t basis = 0;
  std::size_t shape = 0;
  for (const brdf::TermEntry* entry : model.terms()) {
    const std::string suffix(terms.size() == second_specular ? brdf::second_lobe_suffix : "");
    const TermSource* read = table ? table_source(*entry, table->layout.kind) : nullptr;
    const TermSource& source = read != nullptr ? *read : term_source(*entry);
    terms.push_back({*entry, source, read != nullptr, basis, shape, suffix});
    basis += entry->basis_size;
    shape += entry->shape.size();
  }
  return terms;
}

/// Writes the function of one bound model, in HLSL.
class FunctionWriter {
 public:
  FunctionWriter(const brdf::BoundModel& model, std::string name, std::optional<TableText> table)
      : model_(model),
        name_(std::move(name)),
        table_(std::move(table)),
        terms_(placed_terms(model.model(), table_)) {}

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
    std::vector<const brdf::TermEntry*> read;
    for (const PlacedTerm& term : terms_) {
      if (!term.source.name.empty()) names.push_back(term.source.name);
      if (has_tangent_angle(term.entry)) names.emplace_back("turned");
      if (term.is_read) read.push_back(&term.entry);
    }
    if (!table_) return names;
    const std::vector<std::string_view> of_table = table_files(table_->layout, read);
    names.insert(names.end(), of_table.begin(), of_table.end());
    return names;
  }

 private:
  std::size_t channels() const { return model_.channel_count(); }
  bool has_vector() const { return channels() <= most_components; }

  bool uses_half_vector() const {
    return std::any_of(terms_.begin(), terms_.end(), [&](const PlacedTerm& term) {
      const auto& names = term.source.directions;
      const bool by_reading = term.is_read && takes_half_vector(table_->layout.kind);
      return by_reading || std::find(names.begin(), names.end(), "h") != names.end();
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
    for (const ShapeConstant& c :
         shape_constants(term.entry, term.source, shape(term), term.suffix)) {
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

  std::span<const double> shape(const PlacedTerm& term) const {
    return model_.shape().subspan(term.first_shape, term.entry.shape.size());
  }

  /// What the term's basis is called, and what begins the names of the numbers before it.
  static std::string variable(const PlacedTerm& term) {
    return fmt::format("{}{}", term_source(term.entry).name, term.suffix);
  }

  /// The half vector in the frame of the term's tangent.
  static std::string half_vector(const PlacedTerm& term) {
    if (!has_tangent_angle(term.entry)) return "h";
    return fmt::format("gonio_turned(wi, wo, cos_psi{0}, sin_psi{0})", term.suffix);
  }

  std::string evaluation(const PlacedTerm& term) const {
    if (term.is_read) return evaluation_by_table(term);
    return call(term, {}, half_vector(term));
  }

  std::string evaluation_by_table(const PlacedTerm& term) const {
    std::string text;
    std::string h = "h";
    if (has_tangent_angle(term.entry)) {
      h = variable(term) + "_h";
      text = fmt::format("  float3 {} = {};\n", h, half_vector(term));
    }
    const bool is_basis = term.source.name.empty();
    const std::string read = is_basis ? variable(term) : variable(term) + "_read";
    text += table_reading(*table_, {term.entry, shape(term), h}, read);
    return is_basis ? text : text + call(term, read, h);
  }

  /// Declares the basis: the term's function of `first`, if there is that, its shape and the
  /// directions.
  static std::string call(const PlacedTerm& term, const std::string& first, const std::string& h) {
    std::string arguments = first;
    const auto add = [&](const std::string& argument) {
      arguments += arguments.empty() ? argument : ", " + argument;
    };
    for (const std::string_view name : term.source.shape) add(std::string(name) + term.suffix);
    for (const std::string_view name : term.source.directions) {
      add(name == "h" ? h : std::string(name));
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
  std::optional<TableText> table_;
  std::vector<PlacedTerm> terms_;
};

}  // namespace

FunctionText function_text(const brdf::BoundModel& model, const std::string& name,
                           const std::optional<TableText>& table) {
  const FunctionWriter writer(model, name, table);
  return {writer.signature(), writer.text(), writer.files()};
}

}  // namespace gonio::shader
