#include "lut/table_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

#include "brdf/free_frame.h"
#include "brdf/half_vector_lobe.h"
#include "brdf/strauss.h"
#include "brdf/ward.h"

namespace gonio::lut {
namespace {

using Direction = brdf::Direction<double>;

constexpr double pi = std::numbers::pi;

/// A table and how it is read.
struct Reader {
  const Table& table;
  Filter filter;
  Weights weights;

  std::array<double, most_channels> at(double first, double second) const {
    return look_up(table, first, second, filter, weights);
  }
};

/// 1 - n.h without its rounding.
double distance_from_normal(const Direction& h) {
  const double length = brdf::length_above_horizon(h);
  const double x = h.x / length;
  const double y = h.y / length;
  return (x * x + y * y) / (1 + h.z / length);
}

/// 1/alpha^2 of an isotropic lobe; of an anisotropic one that of the half vector's azimuth.
double per_alpha_squared(const brdf::TermDescription& term, std::span<const double> shape,
                         const Direction& h) {
  const double size = std::max(std::abs(h.x), std::abs(h.y));
  if (!term.anisotropic || size == 0) return 1 / (shape[0] * shape[0]);
  // Scaled: the squares would underflow near the pole.
  const double x = h.x / size;
  const double y = h.y / size;
  const double u = x / shape[0];
  const double v = y / shape[1];
  return (u * u + v * v) / (x * x + y * y);
}

/// E as the table has it.
double ward_numerator(const Reader& read, double w, double k) {
  if (read.table.layout.kind == TableKind::ward_lobe) return read.at(w, 1 / std::sqrt(k))[0];
  const double exponent = read.at(w, 0)[0];
  const bool is_beyond = exponent <= static_cast<double>(end_of_exponent(read.table.layout));
  return is_beyond ? 0 : std::exp(k * std::min(exponent, 0.0));
}

/// What the model divides its E by.
double ward_denominator(std::string_view name, double alpha_x, double alpha_y, const Direction& wi,
                        const Direction& wo) {
  if (name.starts_with(brdf::WardDuerLobe::name)) {
    return brdf::WardDuerLobe::denominator(alpha_x, alpha_y, wi, wo);
  }
  if (name.starts_with(brdf::WardGmdLobe::name)) {
    return brdf::WardGmdLobe::denominator(alpha_x, alpha_y, wi, wo);
  }
  return brdf::WardLobe::denominator(alpha_x, alpha_y, wi, wo);
}

double ward(const Reader& read, const brdf::TermEntry& term, std::span<const double> shape,
            const Direction& wi, const Direction& wo) {
  const Direction h = brdf::half_vector(wi, wo);
  const bool is_free = shape.size() == 3;
  const Direction local = is_free ? brdf::turned(h, std::cos(shape[2]), std::sin(shape[2])) : h;
  const double k = per_alpha_squared(term.description, shape, local);
  const double numerator = ward_numerator(read, distance_from_normal(h), k);
  if (numerator <= 0) return 0;
  const double alpha_y = term.description.anisotropic ? shape[1] : shape[0];
  const double value =
      numerator / ward_denominator(term.description.name, shape[0], alpha_y, wi, wo);
  return std::min(value, std::numeric_limits<double>::max());
}

double blinn_phong(const Reader& read, std::span<const double> shape, const Direction& wi,
                   const Direction& wo) {
  return read.at(distance_from_normal(brdf::half_vector(wi, wo)), shape[0])[0];
}

/// What strauss takes from a table or computes.
struct StraussParts {
  double j;
  double passed;   // 1 - F
  double diffuse;  // d Rd
  double r;
};

template <class ArgumentOf>
StraussParts strauss_parts(const Reader& read, std::span<const double> shape, const Direction& wi,
                           const Direction& wo) {
  using namespace brdf::strauss_detail;  // NOLINT(google-build-using-namespace)
  const double s = shape[0];
  const double m = shape[1];
  const double opaque = 1 - shape[2];
  const Argument<double> in = ArgumentOf::argument(wi);
  const Argument<double> out = ArgumentOf::argument(wo);
  if (read.table.layout.kind == TableKind::strauss_j) {
    const bool of_cosine = read.table.layout.of_cosine;
    const auto [j, passed] = read.at(of_cosine ? in.complement : wi.z,  //
                                     of_cosine ? out.complement : wo.z);
    return {j, passed, (1 - m * s) * (1 - s) * (1 + s + s * s) * opaque, s * s * s * opaque};
  }
  const auto [diffuse, r] = read.at(s, m);
  const Fresnel<double> f = fresnel(in);
  return {f.per_x * in.x * attenuation(in) * attenuation(out),
          f.complement_per_complement * in.complement, diffuse, r};
}

/// Writes the coefficient of c and the rest.
template <class ArgumentOf>
void strauss(const Reader& read, std::span<const double> shape, const Direction& wi,
             const Direction& wo, std::span<double> basis) {
  const StraussParts parts = strauss_parts<ArgumentOf>(read, shape, wi, wo);
  const double m = shape[1];
  const double reflected = std::min(1.0, parts.r + parts.j * (parts.r + 0.1));
  const double highlight = brdf::strauss_detail::lobe(shape[0], wi, wo) * reflected / pi;
  const double per_cosine = brdf::saturated<double>(1 / wi.z);
  basis[0] = parts.diffuse / pi + highlight * m * (parts.passed * per_cosine);
  basis[1] = highlight * (1 - m) * per_cosine + highlight * m * ((1 - parts.passed) * per_cosine);
}

void read_term(const Reader& read, const brdf::TermEntry& term, std::span<const double> shape,
               const Direction& wi, const Direction& wo, std::span<double> basis) {
  switch (read.table.layout.kind) {
    case TableKind::ward_exponent:
    case TableKind::ward_lobe:
      basis[0] = ward(read, term, shape, wi, wo);
      return;
    case TableKind::blinn_phong_power:
      basis[0] = blinn_phong(read, shape, wi, wo);
      return;
    case TableKind::strauss_j:
    case TableKind::strauss_terms:
      if (term.description.name == brdf::StraussCosine::name) {
        strauss<brdf::StraussCosine>(read, shape, wi, wo, basis);
      } else {
        strauss<brdf::StraussAngle>(read, shape, wi, wo, basis);
      }
      return;
  }
}

/// "alpha 0.1", "exponent 10 to 1000"
std::string range_text(const Layout& layout) {
  const std::string_view name = parameter_of(layout.kind);
  if (layout.lowest == layout.highest) return fmt::format("{} {}", name, layout.lowest);
  return fmt::format("{} {} to {}", name, layout.lowest, layout.highest);
}

/// Throws if the table's rows or fixed parameters are of another material.
void check_serves(const Layout& table, const Layout& needed) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("{}: the table is {}; bake one for this material", name_of(table.kind), what));
  };
  switch (table.kind) {
    case TableKind::ward_exponent:
    case TableKind::ward_lobe:
    case TableKind::blinn_phong_power:
      if (serves_any_alpha(table)) return;
      if (needed.lowest < table.lowest || needed.highest > table.highest) {
        refuse(fmt::format("for {}, the material has {}", range_text(table), range_text(needed)));
      }
      return;
    case TableKind::strauss_j:
      if (needed.of_cosine != table.of_cosine) {
        refuse(fmt::format("for {}, the material is {}",
                           table.of_cosine ? "strauss-listing" : "strauss",
                           needed.of_cosine ? "strauss-listing" : "strauss"));
      }
      return;
    case TableKind::strauss_terms:
      if (needed.transparency != table.transparency) {
        refuse(fmt::format("for t = {}, the material's is {}", table.transparency,
                           needed.transparency));
      }
      return;
  }
}

}  // namespace

void require_serves(const brdf::BoundModel& model, const Table& table) {
  check_serves(table.layout, layout_for(model, table.layout.kind));
}

TableModel::TableModel(const brdf::BoundModel& model, const Table& table, Filter filter,
                       Weights weights)
    : model_(model), table_(&table), filter_(filter), weights_(weights) {
  require_serves(model, table);
}

void TableModel::f_r(const Direction& wi, const Direction& wo, std::span<double> values) const {
  std::array<double, brdf::most_basis_functions> basis{};
  model_.model().basis(model_.shape(), wi, wo, basis);
  if (brdf::above_horizon(wi, wo)) {
    const Reader read{.table = *table_, .filter = filter_, .weights = weights_};
    std::span<const double> shape_of_rest = model_.shape();
    std::span<double> basis_of_rest = basis;
    for (const brdf::TermEntry* term : model_.model().terms()) {
      if (is_served(term->description, table_->layout.kind)) {
        read_term(read, *term, shape_of_rest.first(term->shape.size()), wi, wo,
                  basis_of_rest.first(term->basis_size));
      }
      shape_of_rest = shape_of_rest.subspan(term->shape.size());
      basis_of_rest = basis_of_rest.subspan(term->basis_size);
    }
  }
  for (std::size_t c = 0; c < model_.channel_count(); ++c) {
    double sum = 0;
    const std::span<const double> coefficients = model_.coefficients(c);
    for (std::size_t b = 0; b < coefficients.size(); ++b) sum += coefficients[b] * basis[b];
    values[c] = std::min(sum, std::numeric_limits<double>::max());
  }
}

}  // namespace gonio::lut
