// How far double and float are from the truth at the extremes: every term of brdf/terms.h in every
// region of extremes_regions.h, against 50 digits, beside the naive form of the same formula.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/parameter.h"

namespace gonio::bench {

/// The largest relative error of double where f_r cos_i exceeds `lit_share` of its peak.
inline constexpr double double_figure = 1e-11;
/// The largest error of float as a fraction of the lobe's peak, for lobes no sharper than these.
inline constexpr double float_figure = 2e-6;
inline constexpr double sharpest_float_roughness = 1e-3;
inline constexpr double sharpest_float_exponent = 1e4;
/// Of the peak, which peak_of() defines.
inline constexpr double lit_share = 1e-12;

struct Summary {
  double worst = 0;
  double median = 0;
};

/// Errors in one precision, of one form.
struct FormErrors {
  /// Of the lit samples; infinite if a value is not finite.
  Summary relative;
  /// The worst error as a fraction of the peak, of lobes within the float figure's range.
  double of_peak = 0;
};

/// What one precision does in one region.
struct PrecisionErrors {
  std::size_t lit = 0;
  FormErrors stable, naive;
  /// The worst of those samples whose condition allows no more than the figure.
  double well_conditioned = 0;
  double well_conditioned_of_peak = 0;
  /// The worst ratio of an error to the larger of the figure and what the condition allows.
  double of_allowed = 0;
  double of_peak_allowed = 0;
};

struct RegionErrors {
  std::string_view region;
  PrecisionErrors in_double, in_float;
};

struct ModelErrors {
  std::string name;
  std::span<const brdf::Parameter> shape;
  /// Of the bound by which the condition excuses more than the figure; empty if nothing does.
  std::string_view condition;
  std::vector<RegionErrors> regions;
};

struct SweepSettings {
  /// Of each term in each region.
  std::size_t samples = 1000;
  std::uint64_t seed = 1;
  /// 0: as many as the machine has. The results do not depend on it.
  int threads = 0;
};

/// One entry per term, in the order of brdf/terms.h.
std::vector<ModelErrors> sweep_extremes(const SweepSettings& settings);

enum class Verdict { reached, bound_by_condition, missed };

/// Double against its figure, over all regions.
Verdict double_verdict(const ModelErrors& model);
/// Float against its figure, over all regions.
Verdict float_verdict(const ModelErrors& model);

/// The worst over all regions of what `get` reads from a region.
template <class Get>
double worst_of(const ModelErrors& model, const Get& get) {
  double worst = 0;
  for (const RegionErrors& region : model.regions) {
    const double value = get(region);
    if (!(value <= worst)) worst = value;
  }
  return worst;
}

}  // namespace gonio::bench
