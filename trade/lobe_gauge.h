// What the error of an evaluator is a fraction of: the peak of the material's specular lobe.
//
// The lobe is all but the diffuse term, or the whole of a model that is one term. Its peak is its
// largest value in a channel at angles up to 60 degrees: some models grow without bound at grazing
// ones. Where f_r is larger than anywhere at those angles, the gauge is that f_r. It is 1/1000 of
// the channel's largest f_r at those angles at least: no error is told of a lobe too dim to be
// seen.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"

namespace gonio::trade {

/// f_r in 1/sr of the model, [pair][channel].
std::vector<double> reflectances(const brdf::BoundModel& model,
                                 std::span<const brdf::DirectionPair<double>> pairs);

class LobeGauge {
 public:
  /// The peaks are looked for over `pairs` and over directions that show the lobe, which the pairs
  /// may miss. A channel without a lobe has the peak of f_r, and 1 if it is black.
  LobeGauge(const brdf::BoundModel& model, std::span<const brdf::DirectionPair<double>> pairs);

  /// Of the lobe, or 1/1000 of that of f_r if this is more; in 1/sr, above 0.
  double peak(std::size_t channel) const { return lobe_peaks_[channel]; }
  /// What an error where the channel's true value is `f_r` is a fraction of, in 1/sr, above 0.
  double at(std::size_t channel, double f_r) const;

 private:
  std::vector<double> lobe_peaks_;
  std::vector<double> f_r_peaks_;
};

}  // namespace gonio::trade
