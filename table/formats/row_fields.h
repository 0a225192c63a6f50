// One row of a text table: its fields as numbers, and what is wrong with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "table/formats/text_rows.h"

namespace gonio::table {

/// What is wrong with a row; `none` if nothing is.
enum class RowFault : std::uint8_t {
  none,
  text,
  not_finite,
  too_large,
  too_few_fields,
  too_many_fields,
  empty_angle,
  theta_range,
  empty_sigma,
  sigma_not_positive,
  empty_weight,
  weight_negative,
};

/// A fault and the column that it stands in.
struct RowProblem {
  RowFault fault = RowFault::none;
  std::size_t column = 0;
};

/// Reads a row into `fields`, a quiet NaN for each empty one, and moves `at` behind the number
/// that it read last. One empty field more than there are columns is accepted at the end. Where
/// `ignored` (empty, or one per field) is true, the field is passed over: NaN.
RowProblem read_fields(const char*& at, const char* end, Separator separator,
                       std::span<double> fields, const std::vector<bool>& ignored = {});

/// The fields of a line as they are written, trimmed.
std::vector<std::string_view> split_fields(std::string_view line, Separator separator);

/// The message for a problem: place, column, what was found and expected, what to do.
std::string explain(const RowProblem& problem, const TextRows& rows, AngleUnit unit,
                    std::size_t line_number, std::string_view line);

}  // namespace gonio::table
