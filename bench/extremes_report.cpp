#include "bench/extremes_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bench/extremes_regions.h"

namespace gonio::bench {
namespace {

std::string error(double value) { return std::isinf(value) ? "NaN" : fmt::format("{:.0e}", value); }

std::string summary(const Summary& s) {
  return fmt::format("{:>5} {:>5}", error(s.worst), error(s.median));
}

std::string precision_columns(const PrecisionErrors& errors) {
  if (errors.lit == 0) return fmt::format("{:>6} {:>11}  {:>11}", 0, "-", "-");
  return fmt::format("{:>6} {}  {}", errors.lit, summary(errors.stable.relative),
                     summary(errors.naive.relative));
}

std::string verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::reached:
      return "reached";
    case Verdict::bound_by_condition:
      return "bound by condition";
    case Verdict::missed:
      break;
  }
  return "MISSED";
}

bool holds(const ModelErrors& model) {
  return double_verdict(model) != Verdict::missed && float_verdict(model) != Verdict::missed;
}

}  // namespace

std::string region_legend() {
  std::string text;
  for (const Region& region : regions()) {
    fmt::format_to(std::back_inserter(text), "{:<18} {}\n", region.name, region.meaning);
  }
  return text;
}

std::string error_table(const ModelErrors& model) {
  std::string text = fmt::format("{:<18} {:>6} {:>11}  {:>11} {:>6} {:>11}  {:>11} {:>7} {:>7}\n",
                                 model.name, "double", "worst   med", "naive   med", "float",
                                 "worst   med", "naive   med", "of peak", "naive");
  for (const RegionErrors& r : model.regions) {
    fmt::format_to(std::back_inserter(text), "{:<18} {} {} {:>7} {:>7}\n", r.region,
                   precision_columns(r.in_double), precision_columns(r.in_float),
                   error(r.in_float.stable.of_peak), error(r.in_float.naive.of_peak));
  }
  return text;
}

std::string figure_table(std::span<const ModelErrors> models) {
  std::string text = fmt::format(
      "double: relative error at most {:g} where f_r cos_i exceeds {:g} of its peak\n"
      "float:  error at most {:g} of the peak, roughness from {:g}, exponents to {:g}\n"
      "{:<26} {:>7} {:<20} {:>7} {}\n",
      double_figure, lit_share, float_figure, sharpest_float_roughness, sharpest_float_exponent,
      "model", "double", "", "float", "");
  const auto out = std::back_inserter(text);
  for (const ModelErrors& model : models) {
    fmt::format_to(
        out, "{:<26} {:>7} {:<20} {:>7} {}\n", model.name,
        error(worst_of(model, [](const auto& r) { return r.in_double.stable.relative.worst; })),
        verdict_text(double_verdict(model)),
        error(worst_of(model, [](const auto& r) { return r.in_float.stable.of_peak; })),
        verdict_text(float_verdict(model)));
  }
  for (const ModelErrors& model : models) {
    if (double_verdict(model) != Verdict::bound_by_condition &&
        float_verdict(model) != Verdict::bound_by_condition) {
      continue;
    }
    fmt::format_to(
        out,
        "{}: bound by {}; at most {:.2f} of it, elsewhere {} (double), {} of the peak (float)\n",
        model.name, model.condition,
        std::max(worst_of(model, [](const auto& r) { return r.in_double.of_allowed; }),
                 worst_of(model, [](const auto& r) { return r.in_float.of_peak_allowed; })),
        error(worst_of(model, [](const auto& r) { return r.in_double.well_conditioned; })),
        error(worst_of(model, [](const auto& r) { return r.in_float.well_conditioned_of_peak; })));
  }
  return text;
}

bool all_figures_hold(std::span<const ModelErrors> models) {
  return std::all_of(models.begin(), models.end(), holds);
}

std::string finite_table(std::span<const ModelFiniteness> models) {
  std::string text = fmt::format("{:<38} {:>12} {:>9} {:>12} {:>9}\n", "model", "in double",
                                 "unsound", "in float", "unsound");
  const auto out = std::back_inserter(text);
  for (const ModelFiniteness& m : models) {
    fmt::format_to(out, "{:<38} {:>12} {:>9} {:>12} {:>9}\n", m.name, m.in_double.evaluations,
                   m.in_double.unsound, m.in_float.evaluations, m.in_float.unsound);
    if (m.in_double.unsound > 0) fmt::format_to(out, "  double: {}\n", m.in_double.first);
    if (m.in_float.unsound > 0) fmt::format_to(out, "  float: {}\n", m.in_float.first);
  }
  return text;
}

bool all_sound(std::span<const ModelFiniteness> models) {
  return std::all_of(models.begin(), models.end(), [](const ModelFiniteness& m) {
    return m.in_double.unsound == 0 && m.in_float.unsound == 0;
  });
}

}  // namespace gonio::bench
