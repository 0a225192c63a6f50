#include "brdf/model.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "brdf/terms.h"

namespace gonio::brdf {
namespace {

template <Term T>
void basis_of(const double* shape, const Direction<double>& wi, const Direction<double>& wo,
              double* values) {
  std::array<double, T::shape.size()> theta;
  std::copy_n(shape, theta.size(), theta.begin());
  const auto result = T::template basis<double, double>(theta, wi, wo);
  std::copy(result.begin(), result.end(), values);
}

template <std::size_t... I>
std::array<TermEntry, sizeof...(I)> make_entries(std::index_sequence<I...> /*indices*/) {
  return {TermEntry{.description = std::tuple_element_t<I, EvaluatedTerms>::description,
                    .amplitudes = std::tuple_element_t<I, EvaluatedTerms>::amplitudes,
                    .shape = std::tuple_element_t<I, EvaluatedTerms>::shape,
                    .index = I,
                    .basis = &basis_of<std::tuple_element_t<I, EvaluatedTerms>>}...};
}

std::span<const TermEntry> evaluated_terms() {
  static const auto entries =
      make_entries(std::make_index_sequence<std::tuple_size_v<EvaluatedTerms>>());
  return entries;
}

std::string names_of(TermKind kind) {
  std::string names;
  for (const TermEntry& entry : all_terms()) {
    if (entry.description.kind != kind) continue;
    if (!names.empty()) names += ", ";
    names += entry.description.name;
  }
  return names;
}

/// The entry of that name among `terms`, or null.
const TermEntry* find_term(std::span<const TermEntry> terms, std::string_view name) {
  const auto found = std::find_if(terms.begin(), terms.end(), [&](const TermEntry& entry) {
    return entry.description.name == name;
  });
  return found == terms.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(std::string_view model, const std::string& reason) {
  throw std::invalid_argument(
      "model '" + std::string(model) + "': " + reason +
      "; a model is diffuse, specular, diffuse+specular or diffuse+specular+specular, diffuse one "
      "of " +
      names_of(TermKind::diffuse) + ", specular one of " + names_of(TermKind::specular));
}

const TermEntry& require_term(std::string_view model, std::string_view name) {
  const TermEntry* term = find_term(all_terms(), name);
  if (term == nullptr) refuse(model, "there is no term '" + std::string(name) + "'");
  return *term;
}

/// The terms of `diffuse+specular` or `diffuse+specular+specular`.
std::vector<const TermEntry*> parse_sum(std::string_view model) {
  std::vector<const TermEntry*> terms;
  for (std::string_view rest = model;;) {
    const std::size_t plus = rest.find('+');
    terms.push_back(&require_term(model, rest.substr(0, plus)));
    if (plus == std::string_view::npos) break;
    rest.remove_prefix(plus + 1);
  }
  if (terms.size() > 3) refuse(model, std::to_string(terms.size()) + " terms are too many");
  if (terms[0]->description.kind != TermKind::diffuse ||
      !std::all_of(terms.begin() + 1, terms.end(), [](const TermEntry* term) {
        return term->description.kind == TermKind::specular;
      })) {
    refuse(model, "the first term has to be diffuse and every further one specular");
  }
  return terms;
}

std::vector<const TermEntry*> parse(std::string_view model) {
  if (model.find('+') != std::string_view::npos) return parse_sum(model);
  const TermEntry& term = require_term(model, model);
  if (term.description.kind == TermKind::diffuse) return {&term};
  return {&require_term(model, term.description.companion), &term};
}

const TermEntry* with_free_frame(const TermEntry* term) {
  if (!term->description.anisotropic) return term;
  return find_term(evaluated_terms().subspan(all_terms().size()), term->description.name);
}

}  // namespace

std::span<const TermEntry> all_terms() { return evaluated_terms().first(std::tuple_size_v<Terms>); }

Model::Model(std::string_view name, Frame frame) : frame_(frame), terms_(parse(name)) {
  constexpr std::size_t second_specular = 2;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (t > 0) name_ += '+';
    name_ += terms_[t]->description.name;
    if (frame == Frame::free) terms_[t] = with_free_frame(terms_[t]);
    const std::string suffix(t == second_specular ? second_lobe_suffix : "");
    for (const Parameter& p : terms_[t]->amplitudes) {
      amplitudes_.push_back({std::string(p.name) + suffix, p, t});
    }
    for (const Parameter& p : terms_[t]->shape) {
      shape_.push_back({std::string(p.name) + suffix, p, t});
    }
  }
}

bool Model::is_anisotropic() const {
  return std::any_of(terms_.begin(), terms_.end(),
                     [](const TermEntry* term) { return term->description.anisotropic; });
}

void Model::basis(std::span<const double> shape, const Direction<double>& wi,
                  const Direction<double>& wo, std::span<double> values) const {
  const double* theta = shape.data();
  double* value = values.data();
  for (const TermEntry* term : terms_) {
    term->basis(theta, wi, wo, value);
    theta += term->shape.size();
    value += term->amplitudes.size();
  }
}

double Model::evaluate(std::span<const double> amplitudes, std::span<const double> shape,
                       const Direction<double>& wi, const Direction<double>& wo) const {
  double sum = 0;
  const double* theta = shape.data();
  const double* amplitude = amplitudes.data();
  for (const TermEntry* term : terms_) {
    std::array<double, 8> values{};
    term->basis(theta, wi, wo, values.data());
    for (std::size_t k = 0; k < term->amplitudes.size(); ++k) sum += amplitude[k] * values[k];
    theta += term->shape.size();
    amplitude += term->amplitudes.size();
  }
  return std::min(sum, std::numeric_limits<double>::max());
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const TermEntry& entry : all_terms()) names.push_back(Model(entry.description.name).name());
  return names;
}

}  // namespace gonio::brdf
