#include "fit/median.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "brdf/pack.h"

namespace gonio::fit {
namespace {

constexpr std::size_t bin_count = 2048;
/// Rounding at the edges of bins could make the bracket move to and fro.
constexpr int most_rounds = 40;

}  // namespace

inline std::size_t MedianSearch::Counts::bin_of(double magnitude) const {
  const double place = (magnitude - lower_) * bins_per_unit_;
  return std::size_t(std::int32_t(std::min(std::max(place, -1.0) + 1, above_)));
}

namespace {

/// How many of the numbers lie below a bound; none of a NaN.
GONIO_FOR_EACH_CPU std::uint64_t count_below(std::span<const double> numbers, double bound) {
  std::uint64_t count = 0;
  for (const double number : numbers) count += number < bound;
  return count;
}

}  // namespace

void MedianSearch::Counts::add(std::span<const double> magnitudes, bool with_zeros) {
  if (upper_ <= lower_) {
    for (const double magnitude : magnitudes) largest_ = std::max(largest_, magnitude);
  }
  // Most lie outside of the bracket: they are counted without going to their bin one by one.
  constexpr std::size_t block = 256;
  std::array<double, block> inside;
  constexpr double least = std::numeric_limits<double>::denorm_min();
  for (std::size_t first = 0; first < magnitudes.size(); first += block) {
    const auto part = magnitudes.subspan(first, std::min(block, magnitudes.size() - first));
    const std::uint64_t zeros = with_zeros ? 0 : count_below(part, least);
    const std::uint64_t below = count_below(part, std::max(lower_, with_zeros ? 0 : least));
    const std::uint64_t up_to = count_below(part, upper_);
    bins_.front() += below - zeros;
    bins_.back() += part.size() - std::max(up_to, below);
    if (up_to <= below) continue;
    std::uint64_t count = 0;
    for (const double magnitude : part) {
      inside[count] = magnitude;
      count += magnitude >= lower_ && magnitude < upper_ && (with_zeros || magnitude > 0);
    }
    for (std::size_t i = 0; i < count; ++i) ++bins_[bin_of(inside[i])];
  }
}

void MedianSearch::Counts::add(std::span<const double> magnitudes,
                               std::span<const std::uint64_t> times) {
  for (std::size_t i = 0; i < magnitudes.size(); ++i) {
    largest_ = std::max(largest_, magnitudes[i]);
    bins_[bin_of(magnitudes[i])] += times[i];
  }
}

MedianSearch::MedianSearch(double lower, double upper, double tolerance, double least)
    : tolerance_(tolerance), least_(least) {
  set_bracket(lower, upper);
}

void MedianSearch::set_bracket(double lower, double upper) {
  lower_ = lower;
  upper_ = std::max(lower, upper);
  total_ = Counts();
  total_.lower_ = lower_;
  total_.upper_ = upper_;
  total_.above_ = double(bin_count + 1);
  // Without a width everything from lower on counts as above.
  total_.bins_per_unit_ = upper_ > lower_ ? double(bin_count) / (upper_ - lower_) : 1e300;
  total_.bins_.assign(bin_count + 2, 0);
}

MedianSearch::Counts MedianSearch::counts() const {
  Counts counts = total_;
  counts.largest_ = 0;
  std::fill(counts.bins_.begin(), counts.bins_.end(), 0);
  return counts;
}

void MedianSearch::add(const Counts& counts) {
  total_.largest_ = std::max(total_.largest_, counts.largest_);
  for (std::size_t b = 0; b < total_.bins_.size(); ++b) total_.bins_[b] += counts.bins_[b];
}

void MedianSearch::end_round() {
  const std::vector<std::uint64_t>& bins = total_.bins_;
  const std::uint64_t total = std::accumulate(bins.begin(), bins.end(), std::uint64_t(0));
  ++rounds_;
  if (total == 0) {
    lower_ = upper_ = 0;
    done_ = true;
    return;
  }
  std::uint64_t rank = (total - 1) / 2;
  std::size_t bin = 0;
  while (rank >= bins[bin]) rank -= bins[bin++];
  if (bin == 0) {
    set_bracket(0, lower_);
  } else if (bin == bin_count + 1) {
    // An empty bracket finds out how far the next one has to reach.
    set_bracket(upper_, upper_ > lower_ ? upper_ : total_.largest_ * (1 + 1e-15));
  } else {
    const double width = (upper_ - lower_) / double(bin_count);
    set_bracket(lower_ + double(bin - 1) * width, lower_ + double(bin) * width);
    done_ = upper_ - lower_ <= tolerance_ * upper_;
  }
  done_ = done_ || (upper_ > lower_ && upper_ < least_) || rounds_ >= most_rounds;
}

}  // namespace gonio::fit
