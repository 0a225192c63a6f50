#include "brdf/model.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "brdf/nearest_name.h"
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

template <Term T>
void coefficients_for(const double* amplitudes, double* coefficients) {
  std::array<double, T::amplitudes.size()> given;
  std::copy_n(amplitudes, given.size(), given.begin());
  const auto result = coefficients_of<T, double>(given);
  // The square of a huge albedo would be infinite, and times a basis function of 0 no number.
  std::transform(result.begin(), result.end(), coefficients,
                 [](double c) { return std::min(c, std::numeric_limits<double>::max()); });
}

template <Term T>
void twin_of(const double* shape, const double* amplitudes, double* other_shape) {
  std::array<double, T::shape.size()> theta;
  std::array<double, T::amplitudes.size()> given;
  std::copy_n(shape, theta.size(), theta.begin());
  std::copy_n(amplitudes, given.size(), given.begin());
  const auto other = T::twin(theta, given);
  std::copy(other.begin(), other.end(), other_shape);
}

template <Term T>
constexpr auto twin_function() -> decltype(TermEntry::twin) {
  if constexpr (term_detail::HasTwin<T>) {
    return &twin_of<T>;
  } else {
    return nullptr;
  }
}

template <std::size_t... I>
std::array<TermEntry, sizeof...(I)> make_entries(std::index_sequence<I...> /*indices*/) {
  return {TermEntry{.description = std::tuple_element_t<I, EvaluatedTerms>::description,
                    .amplitudes = std::tuple_element_t<I, EvaluatedTerms>::amplitudes,
                    .shape = std::tuple_element_t<I, EvaluatedTerms>::shape,
                    .index = I,
                    .basis_size = basis_size<std::tuple_element_t<I, EvaluatedTerms>>,
                    .basis = &basis_of<std::tuple_element_t<I, EvaluatedTerms>>,
                    .coefficients = &coefficients_for<std::tuple_element_t<I, EvaluatedTerms>>,
                    .twin = twin_function<std::tuple_element_t<I, EvaluatedTerms>>()}...};
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

/// The entry of that name and kind among `terms`, or null.
const TermEntry* find_term(std::span<const TermEntry> terms, std::string_view name, TermKind kind) {
  const auto found = std::find_if(terms.begin(), terms.end(), [&](const TermEntry& entry) {
    return entry.description.name == name && entry.description.kind == kind;
  });
  return found == terms.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(std::string_view model, const std::string& reason) {
  throw std::invalid_argument(
      "model '" + std::string(model) + "': " + reason +
      "; a model is diffuse, specular, diffuse+specular, diffuse+specular+specular or a whole one, "
      "diffuse one of " +
      names_of(TermKind::diffuse) + ", specular one of " + names_of(TermKind::specular) +
      ", whole one of " + names_of(TermKind::whole));
}

[[noreturn]] void refuse_unknown(std::string_view model, std::string_view name) {
  std::vector<std::string> names;
  for (const TermEntry& entry : all_terms()) names.emplace_back(entry.description.name);
  const std::optional<std::string_view> nearest = nearest_name(name, names);
  if (nearest) {
    throw std::invalid_argument("model '" + std::string(model) + "': there is no term '" +
                                std::string(name) + "', did you mean '" + std::string(*nearest) +
                                "'? 'gonio models' lists what there is");
  }
  refuse(model, "there is no term '" + std::string(name) + "'");
}

/// The term that the place in a sum wants.
const TermEntry& require_summand(std::string_view model, std::string_view name, TermKind wanted) {
  if (const TermEntry* term = find_term(all_terms(), name, wanted)) return *term;
  if (find_term(all_terms(), name, TermKind::diffuse) != nullptr) {
    refuse(model, "'" + std::string(name) +
                      "' is a second diffuse term, and only the first may be "
                      "one: every further one has to be specular");
  }
  if (find_term(all_terms(), name, TermKind::specular) != nullptr) {
    refuse(model, "the first term has to be diffuse and every further one specular");
  }
  if (find_term(all_terms(), name, TermKind::whole) != nullptr) {
    refuse(model, "'" + std::string(name) + "' is a whole model and takes no other term");
  }
  refuse_unknown(model, name);
}

/// The terms of `diffuse+specular` or `diffuse+specular+specular`.
std::vector<const TermEntry*> parse_sum(std::string_view model) {
  std::vector<const TermEntry*> terms;
  for (std::string_view rest = model;;) {
    const std::size_t plus = rest.find('+');
    terms.push_back(&require_summand(model, rest.substr(0, plus),
                                     terms.empty() ? TermKind::diffuse : TermKind::specular));
    if (plus == std::string_view::npos) break;
    rest.remove_prefix(plus + 1);
  }
  if (terms.size() > 3) refuse(model, std::to_string(terms.size()) + " terms are too many");
  return terms;
}

std::vector<const TermEntry*> parse(std::string_view model) {
  if (model.find('+') != std::string_view::npos) return parse_sum(model);
  for (const TermKind kind : {TermKind::whole, TermKind::diffuse}) {
    if (const TermEntry* term = find_term(all_terms(), model, kind)) return {term};
  }
  const TermEntry* term = find_term(all_terms(), model, TermKind::specular);
  if (term == nullptr) refuse_unknown(model, model);
  return {find_term(all_terms(), term->description.companion, TermKind::diffuse), term};
}

const TermEntry* with_free_frame(const TermEntry* term) {
  if (!term->description.anisotropic) return term;
  return find_term(evaluated_terms().subspan(all_terms().size()), term->description.name,
                   term->description.kind);
}

}  // namespace

bool has_fixed_part(const TermEntry& term) {
  const std::array<double, most_basis_functions> nothing{};
  std::array<double, most_basis_functions> coefficients{};
  term.coefficients(nothing.data(), coefficients.data());
  return std::any_of(coefficients.begin(), coefficients.end(), [](double c) { return c != 0; });
}

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
    basis_terms_.insert(basis_terms_.end(), terms_[t]->basis_size, t);
  }
}

bool Model::is_anisotropic() const {
  return std::any_of(terms_.begin(), terms_.end(),
                     [](const TermEntry* term) { return term->description.anisotropic; });
}

Coefficients Model::coefficients_kind() const {
  Coefficients kind = Coefficients::linear;
  for (const TermEntry* term : terms_) kind = std::max(kind, term->description.coefficients);
  return kind;
}

void Model::basis(std::span<const double> shape, const Direction<double>& wi,
                  const Direction<double>& wo, std::span<double> values) const {
  const double* theta = shape.data();
  double* value = values.data();
  for (const TermEntry* term : terms_) {
    term->basis(theta, wi, wo, value);
    theta += term->shape.size();
    value += term->basis_size;
  }
}

void Model::coefficients(std::span<const double> amplitudes, std::span<double> coefficients) const {
  const double* amplitude = amplitudes.data();
  double* coefficient = coefficients.data();
  for (const TermEntry* term : terms_) {
    term->coefficients(amplitude, coefficient);
    amplitude += term->amplitudes.size();
    coefficient += term->basis_size;
  }
}

double Model::evaluate(std::span<const double> amplitudes, std::span<const double> shape,
                       const Direction<double>& wi, const Direction<double>& wo) const {
  std::array<double, most_basis_functions> values{};
  std::array<double, most_basis_functions> factors{};
  basis(shape, wi, wo, values);
  coefficients(amplitudes, factors);
  double sum = 0;
  for (std::size_t b = 0; b < basis_size(); ++b) sum += factors[b] * values[b];
  return std::min(sum, std::numeric_limits<double>::max());
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const TermEntry& entry : all_terms()) {
    std::string name = Model(entry.description.name).name();
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  }
  return names;
}

}  // namespace gonio::brdf
