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
  return {TermEntry{.description = std::tuple_element_t<I, Terms>::description,
                    .amplitudes = std::tuple_element_t<I, Terms>::amplitudes,
                    .shape = std::tuple_element_t<I, Terms>::shape,
                    .index = I,
                    .basis = &basis_of<std::tuple_element_t<I, Terms>>}...};
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

const TermEntry* find_term(std::string_view name) {
  const auto terms = all_terms();
  const auto found = std::find_if(terms.begin(), terms.end(), [&](const TermEntry& entry) {
    return entry.description.name == name;
  });
  return found == terms.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(std::string_view model, const std::string& reason) {
  throw std::invalid_argument(
      "model '" + std::string(model) + "': " + reason +
      "; a model is diffuse, specular or diffuse+specular, diffuse one of " +
      names_of(TermKind::diffuse) + ", specular one of " + names_of(TermKind::specular));
}

const TermEntry& require_term(std::string_view model, std::string_view name) {
  const TermEntry* term = find_term(name);
  if (term == nullptr) refuse(model, "there is no term '" + std::string(name) + "'");
  return *term;
}

std::vector<const TermEntry*> parse(std::string_view model) {
  const std::size_t plus = model.find('+');
  if (plus == std::string_view::npos) {
    const TermEntry& term = require_term(model, model);
    if (term.description.kind == TermKind::diffuse) return {&term};
    return {&require_term(model, term.description.companion), &term};
  }
  const TermEntry& diffuse = require_term(model, model.substr(0, plus));
  const TermEntry& specular = require_term(model, model.substr(plus + 1));
  if (diffuse.description.kind != TermKind::diffuse ||
      specular.description.kind != TermKind::specular) {
    refuse(model, "the first term has to be diffuse and the second specular");
  }
  return {&diffuse, &specular};
}

}  // namespace

std::span<const TermEntry> all_terms() {
  static const auto entries = make_entries(std::make_index_sequence<std::tuple_size_v<Terms>>());
  return entries;
}

Model::Model(std::string_view name) : terms_(parse(name)) {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (t > 0) name_ += '+';
    name_ += terms_[t]->description.name;
    for (const Parameter& p : terms_[t]->amplitudes) {
      amplitudes_.push_back({std::string(p.name), p, t});
    }
    for (const Parameter& p : terms_[t]->shape) shape_.push_back({std::string(p.name), p, t});
  }
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
