#include "bench/extremes_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/extremes_condition.h"
#include "bench/extremes_parameters.h"
#include "bench/extremes_reference.h"
#include "bench/extremes_regions.h"
#include "bench/naive/ashikhmin_shirley.h"
#include "bench/naive/oren_nayar.h"
#include "bench/naive/phong.h"
#include "bench/naive/strauss.h"
#include "bench/naive/ward.h"
#include "bench/term_name.h"
#include "table/parallel.h"

namespace gonio::bench {
namespace {

using brdf::Direction;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a term is evaluated for.
template <class T, class D>
struct Input {
  std::array<D, T::amplitudes.size()> amplitudes;
  std::array<D, T::shape.size()> shape;
  Direction<D> wi, wo;
};

template <class To, class From, std::size_t N>
std::array<To, N> each_as(const std::array<From, N>& values) {
  std::array<To, N> converted{};
  std::transform(values.begin(), values.end(), converted.begin(),
                 [](From value) { return static_cast<To>(value); });
  return converted;
}

template <class To, class From>
Direction<To> direction_as(const Direction<From>& w) {
  return {static_cast<To>(w.x), static_cast<To>(w.y), static_cast<To>(w.z)};
}

/// The input rounded to D.
template <class D, class T>
Input<T, D> rounded(const Input<T, double>& input) {
  return {each_as<D>(input.amplitudes), each_as<D>(input.shape), direction_as<D>(input.wi),
          direction_as<D>(input.wo)};
}

template <class T, class D>
D stable_value(const Input<T, D>& input) {
  const auto basis = T::template basis<D, D>(input.shape, input.wi, input.wo);
  const auto coefficients = brdf::coefficients_of<T, D>(input.amplitudes);
  D sum = 0;
  for (std::size_t b = 0; b < basis.size(); ++b) sum += coefficients[b] * basis[b];
  return sum;
}

template <class T, class D>
Digits true_value(const Input<T, D>& input) {
  return Reference<T>::value(each_as<Digits>(input.amplitudes), each_as<Digits>(input.shape),
                             input.wi, input.wo);
}

template <class T>
Reflectance reflectance(Input<T, double> input) {
  return [input](const Direction<double>& wi, const Direction<double>& wo) mutable {
    input.wi = wi;
    input.wo = wo;
    return stable_value<T>(input);
  };
}

/// A lobe no sharper than the float figure is meant for.
template <class T>
bool within_float_figure(const std::array<double, T::shape.size()>& shape) {
  for (std::size_t p = 0; p < shape.size(); ++p) {
    const brdf::Parameter& parameter = T::shape[p];
    if (parameter.scale == brdf::Scale::logarithmic && shape[p] < sharpest_float_roughness) {
      return false;
    }
    if (parameter.scale == brdf::Scale::logarithmic_from_one &&
        shape[p] > sharpest_float_exponent) {
      return false;
    }
    // Strauss's smoothness: the exponent is 3/(1 - s).
    if (parameter.name == "s" && 3 > sharpest_float_exponent * (1 - shape[p])) return false;
  }
  return true;
}

/// Collects the errors of one form.
class Collector {
 public:
  void add(double relative_error, double of_peak, bool within_figure) {
    relative_.push_back(relative_error);
    if (within_figure && !(of_peak <= of_peak_)) of_peak_ = of_peak;
  }
  FormErrors summary() {
    if (relative_.empty()) return {};
    const auto middle = relative_.begin() + std::ptrdiff_t(relative_.size() / 2);
    std::nth_element(relative_.begin(), middle, relative_.end());
    return {{*std::max_element(relative_.begin(), relative_.end()), *middle}, of_peak_};
  }

 private:
  std::vector<double> relative_;
  double of_peak_ = 0;
};

/// |value - truth| / truth; infinite if the value is not finite.
template <class D>
double error_of(D value, const Digits& truth) {
  return std::isfinite(value) ? tests::relative_error(value, truth) : infinity;
}

/// The errors of one precision in one region.
template <class T, class D>
class PrecisionStudy {
 public:
  void add(const Input<T, double>& drawn) {
    const Input<T, D> input = rounded<D>(drawn);
    const Input<T, double> as_double = rounded_to_double(input);
    const Digits truth = true_value(input);
    const double size = truth.template convert_to<double>();
    const double peak = std::max(size, peak_of(reflectance<T>(as_double), as_double.wi));
    if (!(size > lit_share * peak) || size < double{std::numeric_limits<D>::min()}) return;
    ++result_.lit;
    const bool within_figure = within_float_figure<T>(as_double.shape);
    const double share = size / peak;
    const double error = error_of(stable_value<T>(input), truth);
    stable_.add(error, error * share, within_figure);
    const double naive =
        error_of(Naive<T>::value(input.amplitudes, input.shape, input.wi, input.wo), truth);
    naive_.add(naive, naive * share, within_figure);
    judge(error, share, within_figure,
          Condition<T>::bound(as_double.shape, as_double.wi, as_double.wo,
                              double{std::numeric_limits<D>::epsilon()}));
  }

  PrecisionErrors result() {
    result_.stable = stable_.summary();
    result_.naive = naive_.summary();
    return result_;
  }

 private:
  static Input<T, double> rounded_to_double(const Input<T, D>& input) {
    return {each_as<double>(input.amplitudes), each_as<double>(input.shape),
            direction_as<double>(input.wi), direction_as<double>(input.wo)};
  }

  void judge(double error, double share, bool within_figure, double condition) {
    const auto raise = [](double& worst, double value) { worst = std::max(worst, value); };
    raise(result_.of_allowed, error / std::max(double_figure, condition));
    if (condition <= double_figure) raise(result_.well_conditioned, error);
    if (!within_figure) return;
    raise(result_.of_peak_allowed, error * share / std::max(float_figure, condition * share));
    if (condition * share <= float_figure) raise(result_.well_conditioned_of_peak, error * share);
  }

  PrecisionErrors result_;
  Collector stable_, naive_;
};

template <class T>
RegionErrors study_region(const Region& region, std::size_t samples, RandomSource random) {
  PrecisionStudy<T, double> in_double;
  PrecisionStudy<T, float> in_float;
  for (std::size_t i = 0; i < samples; ++i) {
    Input<T, double> input{};
    draw_shape(random, T::shape, input.shape);
    draw_amplitudes(random, T::amplitudes, input.amplitudes);
    const DirectionPair pair = draw_pair(region, random, reflectance<T>(input));
    input.wi = pair.wi;
    input.wo = pair.wo;
    in_double.add(input);
    in_float.add(input);
  }
  return {region.name, in_double.result(), in_float.result()};
}

using StudyOfRegion = RegionErrors (*)(const Region&, std::size_t, RandomSource);

struct TermStudy {
  std::string name;
  std::span<const brdf::Parameter> shape;
  std::string_view condition;
  StudyOfRegion study;
};

template <class... T>
std::vector<TermStudy> term_studies(std::type_identity<std::tuple<T...>> /*terms*/) {
  return {TermStudy{study_name<T>(), T::shape, Condition<T>::derivation, study_region<T>}...};
}

Verdict verdict(double worst, double figure, double of_allowed) {
  if (worst <= figure) return Verdict::reached;
  return of_allowed <= 1 ? Verdict::bound_by_condition : Verdict::missed;
}

}  // namespace

std::vector<ModelErrors> sweep_extremes(const SweepSettings& settings) {
  const std::vector<TermStudy> terms = term_studies(std::type_identity<brdf::Terms>{});
  const std::size_t region_count = regions().size();
  std::vector<ModelErrors> models;
  models.reserve(terms.size());
  for (const TermStudy& term : terms) {
    models.push_back(
        {term.name, term.shape, term.condition, std::vector<RegionErrors>(region_count)});
  }
  table::parallel_for(terms.size() * region_count, settings.threads, [&](std::size_t task) {
    const std::size_t t = task / region_count;
    const std::size_t r = task % region_count;
    models[t].regions[r] =
        terms[t].study(regions()[r], settings.samples, RandomSource(settings.seed, task));
  });
  return models;
}

Verdict double_verdict(const ModelErrors& model) {
  return verdict(worst_of(model, [](const auto& r) { return r.in_double.stable.relative.worst; }),
                 double_figure,
                 worst_of(model, [](const auto& r) { return r.in_double.of_allowed; }));
}

Verdict float_verdict(const ModelErrors& model) {
  return verdict(worst_of(model, [](const auto& r) { return r.in_float.stable.of_peak; }),
                 float_figure,
                 worst_of(model, [](const auto& r) { return r.in_float.of_peak_allowed; }));
}

}  // namespace gonio::bench
