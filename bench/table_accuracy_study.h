// How far a table's values are from what they stand for: the two tables of errors on docs/lut.md.
//
// Errors are absolute; all that the tables hold is at most 1, so those of lobes are fractions of
// the peak (of Ward's lobe: of its numerator's, 1).
#pragma once

#include <string>
#include <vector>

#include "lut/table.h"

namespace gonio::bench {

/// exp(-tan^2 / alpha^2) for w = 1 - n.h: Ward's numerator.
double ward_lobe_at(double w, double alpha);

/// The largest error of Ward's numerator by a table of ward-exponent or ward-lobe, over n.h from 1
/// to 0: at 200,000 angles, dense near the peak, hundreds between any two of 512 texels.
double worst_ward_error(const lut::Table& table, double alpha, lut::Filter filter,
                        lut::Weights weights);

/// A table of 512 texels for one alpha; `reaches_lobe`: as far as that needs, else to n.h = 0.
lut::Table ward_table_of_512(lut::TableKind kind, lut::Coordinate coordinate, lut::Storage storage,
                             double alpha, bool reaches_lobe);

/// A row of a table of errors: the words that say which look-up table it is of, and its errors.
struct AccuracyRow {
  std::vector<std::string> words;
  std::vector<double> errors;
};

/// A table of errors as the page has it.
struct AccuracyTable {
  std::vector<std::string> titles;  // of the words and of the errors
  std::vector<AccuracyRow> rows;
};

/// Ward's tables of 512 texels, each for one alpha.
AccuracyTable accuracy_of_one_lobe();

/// Tables of two axes: ward-lobe and blinn-phong-power over a range, strauss-j.
AccuracyTable accuracy_of_two_axes();

/// In Markdown, with two digits of each error.
std::string markdown_of(const AccuracyTable& table);

}  // namespace gonio::bench
