// From the numbers of a row to a sample: directions, f_r, and why a sample is masked.
#pragma once

#include <cstddef>
#include <span>

#include "table/formats/columns.h"
#include "table/formats/row_fields.h"
#include "table/sample_table.h"

namespace gonio::table {

/// Writes rows into a table whose arrays have their size. Rows may be written in any order and by
/// several threads at once.
class SampleWriter {
 public:
  /// `columns` and `table` have to outlive the writer; `quantity` and `unit` are the file's.
  SampleWriter(const Columns& columns, Quantity quantity, AngleUnit unit, SampleTable& table);

  /// Writes sample `i` from the row's `fields`, a NaN for each empty one, in the file's order.
  RowProblem write(std::span<const double> fields, std::size_t i) const;

 private:
  RowProblem write_directions(std::span<const double> fields, std::size_t i) const;
  RowProblem write_values(std::span<const double> fields, double divisor, std::size_t i) const;
  RowProblem write_sigmas(std::span<const double> fields, double divisor, std::size_t i) const;
  RowProblem write_weight(std::span<const double> fields, std::size_t i) const;
  brdf::Direction<double> direction(double theta, double phi) const;
  bool is_horizontal(double theta) const { return theta >= quarter_turn_ - tolerance_; }
  double divisor(std::span<const double> fields, std::size_t i) const;

  const Columns& columns_;
  Quantity quantity_;
  AngleUnit unit_;
  double quarter_turn_;  // in the file's unit
  double tolerance_;
  SampleTable& table_;
};

}  // namespace gonio::table
