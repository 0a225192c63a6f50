// What gonio fit prints for a person.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"
#include "table/sample_table.h"

namespace gonio::app {

/// The table in a line: what was read and what of it was used.
std::string report_table(const table::SampleTable& table, const fit::FitResult& result,
                         double max_theta_deg);
/// One fit: its parameters with standard deviation and interval, its errors, its outliers.
std::string report_fit(const fit::FitResult& result, const fit::Options& options);
/// Several fits, best first, a line each, and what comparing those within each other tells.
std::string report_ranking(const std::vector<fit::FitResult>& results);

/// How many times larger an error is: "1.063 x".
std::string ratio_text(double ratio);
/// What heads a column of errors under a metric: "error in 1/sr".
std::string error_heading(fit::Metric metric);

}  // namespace gonio::app
