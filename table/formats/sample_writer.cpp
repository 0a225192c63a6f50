#include "table/formats/sample_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace gonio::table {

namespace {

constexpr double horizon_tolerance_deg = 1e-6;

}  // namespace

SampleWriter::SampleWriter(const Columns& columns, Quantity quantity, AngleUnit unit,
                           SampleTable& table)
    : columns_(columns),
      quantity_(quantity),
      unit_(unit),
      quarter_turn_(unit == AngleUnit::degrees ? 90 : std::numbers::pi / 2),
      tolerance_(horizon_tolerance_deg / 90 * quarter_turn_),
      table_(table) {}

RowProblem SampleWriter::write(std::span<const double> fields, std::size_t i) const {
  if (const auto problem = write_directions(fields, i); problem.fault != RowFault::none) {
    return problem;
  }
  const double scale = divisor(fields, i);
  if (const auto problem = write_values(fields, scale, i); problem.fault != RowFault::none) {
    return problem;
  }
  if (const auto problem = write_sigmas(fields, scale, i); problem.fault != RowFault::none) {
    return problem;
  }
  return write_weight(fields, i);
}

RowProblem SampleWriter::write_directions(std::span<const double> fields, std::size_t i) const {
  std::array<double, 4> angle;
  for (std::size_t a = 0; a < angle.size(); ++a) {
    angle[a] = fields[columns_.angles[a]];
    if (std::isnan(angle[a])) return {RowFault::empty_angle, columns_.angles[a]};
  }
  for (const Angle a : {theta_i, theta_o}) {
    if (angle[a] < 0 || angle[a] > quarter_turn_ + tolerance_) {
      return {RowFault::theta_range, columns_.angles[a]};
    }
    if (is_horizontal(angle[a])) table_.mask[i] = MaskReason::horizon;
  }
  table_.wi.set(i, direction(angle[theta_i], angle[phi_i]));
  table_.wo.set(i, direction(angle[theta_o], angle[phi_o]));
  return {};
}

brdf::Direction<double> SampleWriter::direction(double theta, double phi) const {
  return unit_ == AngleUnit::degrees ? brdf::direction_from_degrees(theta, phi)
                                     : brdf::direction_from_radians(theta, phi);
}

/// What the file's numbers are divided by to give f_r; NaN where they cannot tell it.
double SampleWriter::divisor(std::span<const double> fields, std::size_t i) const {
  switch (quantity_) {
    case Quantity::brdf:
      break;
    case Quantity::brdf_cos:
      return is_horizontal(fields[columns_.angles[theta_i]])
                 ? std::numeric_limits<double>::quiet_NaN()
                 : table_.wi.z[i];
    case Quantity::reflectance_factor:
      return std::numbers::pi;
  }
  return 1;
}

RowProblem SampleWriter::write_values(std::span<const double> fields, double divisor,
                                      std::size_t i) const {
  bool is_hole = true;
  for (std::size_t c = 0; c < columns_.values.size(); ++c) {
    const double written = fields[columns_.values[c]];
    const double value = written / divisor;
    if (std::isinf(value)) return {RowFault::too_large, columns_.values[c]};
    table_.values[c][i] = value;
    is_hole = is_hole && std::isnan(written);
  }
  if (is_hole && table_.mask[i] == MaskReason::none) table_.mask[i] = MaskReason::hole;
  return {};
}

RowProblem SampleWriter::write_sigmas(std::span<const double> fields, double divisor,
                                      std::size_t i) const {
  for (std::size_t c = 0; c < columns_.sigmas.size(); ++c) {
    const std::size_t column = columns_.sigmas[c];
    const double written = fields[column];
    const bool is_measured = !std::isnan(fields[columns_.values[c]]);
    if (std::isnan(written) && is_measured) return {RowFault::empty_sigma, column};
    const double sigma = written / divisor;
    // The quotient of a tiny one may be 0.
    if (written <= 0 || sigma <= 0) return {RowFault::sigma_not_positive, column};
    if (std::isinf(sigma)) return {RowFault::too_large, column};
    table_.sigma[c][i] = sigma;
  }
  return {};
}

RowProblem SampleWriter::write_weight(std::span<const double> fields, std::size_t i) const {
  if (!columns_.weight) return {};
  const double weight = fields[*columns_.weight];
  const auto is_empty = [&](std::size_t column) { return std::isnan(fields[column]); };
  if (std::isnan(weight) &&
      !std::all_of(columns_.values.begin(), columns_.values.end(), is_empty)) {
    return {RowFault::empty_weight, *columns_.weight};
  }
  if (weight < 0) return {RowFault::weight_negative, *columns_.weight};
  table_.weight[i] = std::isnan(weight) ? 0 : weight;
  return {};
}

}  // namespace gonio::table
