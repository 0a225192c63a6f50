#include "fit/canonical.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gonio::fit {
namespace {

bool is_inside(const Box& box, const ParameterValues& values) {
  for (std::size_t j = 0; j < values.shape.size(); ++j) {
    if (values.shape[j] < box.shape_lower[j] || values.shape[j] > box.shape_upper[j]) return false;
  }
  if (values.amplitudes.size() == 0) return true;
  return (values.amplitudes.array() >= box.amplitude_lower.array()).all() &&
         (values.amplitudes.array() <= box.amplitude_upper.array()).all();
}

/// Where the parameters of a term begin.
struct TermPlace {
  std::size_t shape, amplitude;
};

std::vector<TermPlace> places_of(const brdf::Model& model) {
  std::vector<TermPlace> places;
  TermPlace next{0, 0};
  for (const brdf::TermEntry* term : model.terms()) {
    places.push_back(next);
    next.shape += term->shape.size();
    next.amplitude += term->amplitudes.size();
  }
  return places;
}

/// The angle in [-pi/2, pi/2) that differs by a multiple of pi.
double within_half_turn(double angle) {
  constexpr double pi = std::numbers::pi;
  return std::clamp(angle - pi * std::floor(angle / pi + 0.5), -pi / 2, pi / 2);
}

/// The tangent along which the lobe is narrower: where the roughness is smaller, or the exponent
/// larger.
ParameterValues with_narrow_tangent(const brdf::TermEntry& term, std::size_t first,
                                    ParameterValues values) {
  double& psi = values.shape[first + term.shape.size() - 1];
  psi = within_half_turn(psi);
  const bool are_exponents = term.shape[0].scale == brdf::Scale::logarithmic_from_one;
  const double along_x = values.shape[first];
  const double along_y = values.shape[first + 1];
  if (are_exponents ? along_x < along_y : along_x > along_y) {
    std::swap(values.shape[first], values.shape[first + 1]);
    psi = within_half_turn(psi + std::numbers::pi / 2);
  }
  return values;
}

ParameterValues with_swapped_terms(const brdf::TermEntry& term, const TermPlace& a,
                                   const TermPlace& b, ParameterValues values) {
  for (std::size_t j = 0; j < term.shape.size(); ++j) {
    std::swap(values.shape[a.shape + j], values.shape[b.shape + j]);
  }
  if (values.amplitudes.size() == 0) return values;
  for (std::size_t k = 0; k < term.amplitudes.size(); ++k) {
    values.amplitudes.row(Eigen::Index(a.amplitude + k))
        .swap(values.amplitudes.row(Eigen::Index(b.amplitude + k)));
  }
  return values;
}

}  // namespace

std::optional<ParameterValues> twin_of(const brdf::Model& model, const Box& box,
                                       ParameterValues values) {
  const std::vector<TermPlace> places = places_of(model);
  bool has_twin = false;
  for (std::size_t t = 0; t < places.size(); ++t) {
    const brdf::TermEntry& term = *model.terms()[t];
    if (term.twin == nullptr) continue;
    has_twin = true;
    const Eigen::VectorXd mean =
        values.amplitudes
            .middleRows(Eigen::Index(places[t].amplitude), Eigen::Index(term.amplitudes.size()))
            .rowwise()
            .mean();
    const std::vector<double> shape = values.shape;
    term.twin(&shape[places[t].shape], mean.data(), &values.shape[places[t].shape]);
  }
  if (!has_twin || !is_inside(box, values)) return std::nullopt;
  return values;
}

ParameterValues canonical(const brdf::Model& model, const Box& box, ParameterValues values) {
  const auto terms = model.terms();
  const std::vector<TermPlace> places = places_of(model);
  const auto take_if_inside = [&](ParameterValues other) {
    if (is_inside(box, other)) values = std::move(other);
  };
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (model.has_free_frame() && terms[t]->description.anisotropic) {
      take_if_inside(with_narrow_tangent(*terms[t], places[t].shape, values));
    }
  }
  for (std::size_t t = 1; t < terms.size(); ++t) {
    if (terms[t] != terms[t - 1] || terms[t]->shape.empty()) continue;
    const auto shape = [&](std::size_t term) {
      const auto begin = values.shape.begin() + std::ptrdiff_t(places[term].shape);
      return std::vector<double>(begin, begin + std::ptrdiff_t(terms[t]->shape.size()));
    };
    if (shape(t) < shape(t - 1)) {
      take_if_inside(with_swapped_terms(*terms[t], places[t - 1], places[t], values));
    }
  }
  return values;
}

}  // namespace gonio::fit
