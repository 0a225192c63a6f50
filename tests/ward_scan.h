// A dense scan over the roughness, independent of the fit: textbook formulas by polar angles of the
// half vector, the two amplitudes by the normal equations, both not negative.
#pragma once

#include <vector>

#include "table/sample_table.h"

namespace gonio::tests {

class WardScan {
 public:
  /// Takes the samples that are not masked and within `max_theta_deg`.
  WardScan(const table::SampleTable& table, double max_theta_deg);

  /// The half vector and the cosines of one sample.
  struct Geometry {
    double tan2_x, tan2_y;  // tan^2 of the half vector's polar angle times cos^2, sin^2 of phi
    double cos_i, cos_o;
    double half_length2, half_z;  // of wi + wo
  };
  using Lobe = double (*)(const Geometry&, double alpha_x, double alpha_y);
  static double ward(const Geometry&, double alpha_x, double alpha_y);
  static double ward_duer(const Geometry&, double alpha_x, double alpha_y);
  static double ward_gmd(const Geometry&, double alpha_x, double alpha_y);

  /// Half the sum of squared residuals (l2) at the best amplitudes.
  double cost(Lobe lobe, double alpha_x, double alpha_y) const;

  /// The least cost on 600 roughnesses from 1e-3 to 5, refined by golden sections.
  double least_cost_over_one_roughness(Lobe lobe) const;
  /// The least cost on 30 x 30 pairs of roughnesses from 0.005 to 3, refined by shrinking the grid
  /// about its best point.
  double least_cost_over_both_roughnesses(Lobe lobe) const;

 private:
  std::vector<Geometry> geometry_;
  std::vector<std::vector<double>> values_;  // [channel][sample]
};

}  // namespace gonio::tests
