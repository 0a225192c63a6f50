// The median of many magnitudes in constant memory, in a few rounds over them, in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gonio::fit {

/// Each round counts the magnitudes in bins of a bracket, and narrows the bracket to the bin that
/// holds the (lower) median. Whole counts: the result does not depend on the order of anything.
class MedianSearch {
 public:
  /// The counts of a part of the magnitudes; parts are added to the search in any order.
  class Counts {
   public:
    /// Magnitudes, which must be at least 0 and no NaN; those that are 0 may be left out.
    void add(std::span<const double> magnitudes, bool with_zeros = true);
    /// Each as many times as the other span says.
    void add(std::span<const double> magnitudes, std::span<const std::uint64_t> times);

   private:
    friend MedianSearch;
    std::size_t bin_of(double magnitude) const;

    double lower_ = 0, upper_ = 0, bins_per_unit_ = 0, above_ = 0, largest_ = 0;
    /// The first counts what lies below the bracket, the last what lies above.
    std::vector<std::uint64_t> bins_;
  };

  /// The median should lie from `lower` to below `upper`, else, and if upper <= lower, it takes a
  /// round more. It is found to `tolerance` of itself (a round divides the bracket by 2048), or as
  /// less than `least`.
  MedianSearch(double lower, double upper, double tolerance, double least = 0);

  bool done() const { return done_; }
  /// Empty counts for this round.
  Counts counts() const;
  void add(const Counts& counts);
  void end_round();
  /// The median; 0 if nothing was added.
  double value() const { return (lower_ + upper_) / 2; }

 private:
  void set_bracket(double lower, double upper);

  double lower_ = 0, upper_ = 0;
  double tolerance_;
  double least_;
  bool done_ = false;
  int rounds_ = 0;
  Counts total_;
};

}  // namespace gonio::fit
