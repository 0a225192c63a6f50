// docs/extremes.md: what a user may rely on at the extremes, in words and bounds. The page is
// written from a study, and later studies check it: each states bounds a little wider than what was
// measured, so that it holds on machines whose arithmetic differs in the last digit.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "bench/extremes_study.h"

namespace gonio::bench {

/// The errors of one model or of one region: `double_error` and `float_of_peak` are at most these,
/// those of the naive form at least.
struct StatedErrors {
  std::string subject;
  double double_error, float_of_peak;
  double naive_double_error, naive_float_of_peak;
};

/// The numbers of the page.
struct PageBounds {
  std::vector<StatedErrors> models, regions;
};

/// Bounds of one digit that hold with a margin for what was measured.
PageBounds stated_bounds(std::span<const ModelErrors> models);

/// The whole page.
std::string page_text(std::span<const ModelErrors> models, const PageBounds& bounds);

/// What is wrong with the text of a page, a line each: bounds that do not hold for the measured
/// errors or are more than ten times as wide, and words or rows that are not those of page_text().
std::vector<std::string> faults_of_text(const std::string& text,
                                        std::span<const ModelErrors> models);

/// The same for a file. Throws table::FileError if it cannot be read.
std::vector<std::string> faults_of_page(const std::string& path,
                                        std::span<const ModelErrors> models);

}  // namespace gonio::bench
