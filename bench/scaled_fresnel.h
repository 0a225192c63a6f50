// Ashikhmin and Shirley's lobe as Ngan, Durand and Matusik (Experimental Analysis of BRDF Models,
// EGSR 2005) fitted it: beside a Lambertian part, with an amplitude for each channel apart from the
// Fresnel factor, which all channels share,
//
//   kd/pi + ks (F0 + (1 - F0)(1 - h.wi)^5) (n+1)/(8 pi) (n.h)^n / ((h.wi) max(cos_i, cos_o)).
//
// In the model as it was published F0 = Rs is the amplitude itself: ks = 1. With one channel the
// scaled form contains lambert+ashikhmin-shirley.
#pragma once

#include <cstddef>
#include <vector>

#include "table/sample_table.h"

namespace gonio::bench {

struct ScaledFresnelFit {
  /// Per channel, none below 0: in units of 1.
  std::vector<double> kd, ks;
  /// From 0 to 1.
  double f0 = 0;
  /// From 0 to 1e6.
  double n = 0;
  /// Root mean square of (f - model) cos_i, weighted by the table, in 1/sr.
  double error = 0;
};

/// The least-squares fit under cosine-l2 to the samples with angles up to `max_theta_deg`. Throws
/// table::FileError if there are none.
ScaledFresnelFit fit_scaled_fresnel(const table::SampleTable& table, double max_theta_deg);

}  // namespace gonio::bench
