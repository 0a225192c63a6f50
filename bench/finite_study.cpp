#include "bench/finite_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "bench/extremes_parameters.h"
#include "bench/random_source.h"
#include "bench/term_name.h"
#include "brdf/terms.h"
#include "table/parallel.h"

namespace gonio::bench {
namespace {

using brdf::Direction;

/// Evaluations that one task makes with one random stream.
constexpr std::uint64_t block_size = 1 << 16;

template <class D>
struct Pair {
  Direction<D> wi, wo;
};

/// Draws in the precision D, without transcendental functions: they would take most of the time.
template <class D>
class DirectionSource {
 public:
  explicit DirectionSource(RandomSource& random) : random_(random) {}

  /// Above the horizon, by the cosine.
  Direction<D> ordinary() {
    const Azimuth a = point_in_disc();
    return {a.x, a.y, std::sqrt(std::max(D(0), 1 - a.x * a.x - a.y * a.y))};
  }

  Pair<D> at_extremes() {
    const Direction<D> wi = extreme();
    switch (random_.index(8)) {
      case 0:
        return {wi, {-wi.x, -wi.y, wi.z}};
      case 1:
        return {wi, wi};
      case 2:
        return {wi, {-wi.x, -wi.y, -wi.z}};
      case 3:
        return {wi, unit({-wi.x + tiny(), -wi.y + tiny(), wi.z})};
      case 4:
        return {wi, unit({wi.x + tiny(), wi.y + tiny(), wi.z})};
      case 5:
        return {wi, lowered({wi.x, wi.y}, small_cosine())};
      case 6:
        return {wi, lowered({-wi.x, -wi.y}, small_cosine())};
      default:
        return {wi, extreme()};
    }
  }

 private:
  struct Azimuth {
    D x, y;
  };

  Azimuth point_in_disc() {
    for (;;) {
      const D x = static_cast<D>(random_.uniform(-1, 1));
      const D y = static_cast<D>(random_.uniform(-1, 1));
      if (x * x + y * y < 1) return {x, y};
    }
  }

  /// Any order of magnitude, either sign; denormal numbers and 0 among them.
  D tiny() {
    constexpr int orders =
        std::numeric_limits<D>::digits - std::numeric_limits<D>::min_exponent + 2;
    const D size = std::ldexp(static_cast<D>(random_.uniform(0.5, 1)),
                              -int(random_.index(std::size_t{orders})));
    return random_.coin() ? size : -size;
  }

  /// Mostly above the horizon; on it, or below it, every eighth time each.
  D small_cosine() {
    switch (random_.index(8)) {
      case 0:
        return random_.coin() ? D(0) : D(-0.0);
      case 1:
        return -std::abs(tiny());
      default:
        return std::abs(tiny());
    }
  }

  /// The direction with this cosine above the azimuth of a horizontal vector.
  Direction<D> lowered(const Azimuth& a, D cosine) {
    const D length = std::hypot(a.x, a.y);
    const D sine = std::sqrt((1 - cosine) * (1 + cosine));
    if (!(length > 0)) return {sine, 0, cosine};
    return {sine * (a.x / length), sine * (a.y / length), cosine};
  }

  Direction<D> unit(const Direction<D>& w) {
    const D length = std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
    if (!(length > 0)) return {0, 0, 1};
    return {w.x / length, w.y / length, w.z / length};
  }

  Direction<D> extreme() {
    switch (random_.index(6)) {
      case 0:
        return {0, 0, 1};
      case 1:
        return unit({tiny(), tiny(), 1});
      case 2: {
        const D cosine = small_cosine();
        const D sine = std::sqrt((1 - cosine) * (1 + cosine));
        return random_.coin() ? Direction<D>{sine, 0, cosine} : Direction<D>{0, -sine, cosine};
      }
      case 3:
      case 4:
        return lowered(point_in_disc(), small_cosine());
      default:
        return ordinary();
    }
  }

  RandomSource& random_;
};

template <class T, class D>
struct Input {
  std::array<double, T::amplitudes.size()> amplitudes{};
  std::array<double, T::shape.size()> shape{};
  Pair<D> pair{};
};

template <class T, class D>
Input<T, D> draw(RandomSource& random, bool at_extremes) {
  DirectionSource<D> directions(random);
  Input<T, D> input;
  draw_shape(random, T::shape, input.shape);
  draw_amplitudes(random, T::amplitudes, input.amplitudes);
  input.pair = at_extremes ? directions.at_extremes()
                           : Pair<D>{directions.ordinary(), directions.ordinary()};
  return input;
}

template <class D, std::size_t N>
std::array<D, N> each_as(const std::array<double, N>& values) {
  std::array<D, N> converted{};
  std::transform(values.begin(), values.end(), converted.begin(),
                 [](double value) { return static_cast<D>(value); });
  return converted;
}

enum class Soundness { unsound, dark, lit };

template <class T, class D>
Soundness evaluate(const Input<T, D>& input) {
  const auto basis = T::template basis<D, D>(each_as<D>(input.shape), input.pair.wi, input.pair.wo);
  const auto coefficients = brdf::coefficients_of<T, D>(each_as<D>(input.amplitudes));
  D sum = 0;
  for (std::size_t b = 0; b < basis.size(); ++b) {
    // Comparisons with NaN are false.
    const bool is_sound = basis[b] >= 0 && basis[b] <= std::numeric_limits<D>::max() &&
                          coefficients[b] >= 0 && coefficients[b] <= std::numeric_limits<D>::max();
    if (!is_sound) return Soundness::unsound;
    sum += coefficients[b] * basis[b];
  }
  const D saturated = std::min(sum, std::numeric_limits<D>::max());
  if (!(saturated >= 0)) return Soundness::unsound;
  return saturated > 0 ? Soundness::lit : Soundness::dark;
}

template <class T, class D>
std::string described(const Input<T, D>& input) {
  const auto& [wi, wo] = input.pair;
  return fmt::format("shape {}, amplitudes {}, wi ({}, {}, {}), wo ({}, {}, {})", input.shape,
                     input.amplitudes, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
}

template <class T, class D>
FiniteCount study_block(std::uint64_t evaluations, RandomSource random) {
  FiniteCount count;
  count.evaluations = evaluations;
  for (std::uint64_t i = 0; i < evaluations; ++i) {
    const Input<T, D> input = draw<T, D>(random, i % 2 == 0);
    const Soundness soundness = evaluate<T, D>(input);
    if (soundness == Soundness::lit) ++count.lit;
    if (soundness != Soundness::unsound) continue;
    if (count.unsound++ == 0) count.first = described<T, D>(input);
  }
  return count;
}

FiniteCount sum_of(const std::vector<FiniteCount>& blocks) {
  FiniteCount sum;
  for (const FiniteCount& block : blocks) {
    sum.evaluations += block.evaluations;
    sum.unsound += block.unsound;
    sum.lit += block.lit;
    if (sum.first.empty()) sum.first = block.first;
  }
  return sum;
}

using StudyOfBlock = FiniteCount (*)(std::uint64_t, RandomSource);

FiniteCount study(StudyOfBlock study_of_block, const FiniteSettings& settings,
                  std::uint64_t first_stream) {
  const std::uint64_t block_count = (settings.evaluations + block_size - 1) / block_size;
  std::vector<FiniteCount> blocks(block_count);
  table::parallel_for(block_count, settings.threads, [&](std::size_t b) {
    const std::uint64_t done = b * block_size;
    blocks[b] = study_of_block(std::min(block_size, settings.evaluations - done),
                               RandomSource(settings.seed, first_stream + b));
  });
  return sum_of(blocks);
}

template <class T>
constexpr bool has_free_frame = false;
template <class T>
constexpr bool has_free_frame<brdf::FreeFrame<T>> = true;

template <class T>
std::string name_with_frame() {
  return study_name<T>() + (has_free_frame<T> ? ", free frame" : "");
}

/// Streams are apart by more than any study has blocks.
constexpr std::uint64_t streams_per_study = std::uint64_t(1) << 40;

template <class... T>
std::vector<ModelFiniteness> count_all(std::type_identity<std::tuple<T...>> /*terms*/,
                                       const FiniteSettings& settings) {
  std::uint64_t stream = 0;
  const auto next_stream = [&] { return streams_per_study * stream++; };
  return {ModelFiniteness{name_with_frame<T>(),
                          study(study_block<T, double>, settings, next_stream()),
                          study(study_block<T, float>, settings, next_stream())}...};
}

}  // namespace

std::vector<ModelFiniteness> count_unsound(const FiniteSettings& settings) {
  return count_all(std::type_identity<brdf::EvaluatedTerms>{}, settings);
}

}  // namespace gonio::bench
