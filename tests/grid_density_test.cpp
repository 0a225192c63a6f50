// A fit does not depend on how densely a grid samples: a gridded format's weights are solid angles.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "fit/fit.h"
#include "table/read.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

/// What is measured: two lobes, so that the model of one lobe that is fitted does not fit. Of a
/// model that fits, the density changes nothing but the noise.
double measured(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  constexpr std::array rho_d{0.2};
  constexpr std::array rho_s{0.1};
  constexpr std::array narrow{0.12};
  constexpr std::array rho_s_2{0.15};
  constexpr std::array wide{0.4};
  static const std::array<brdf::NamedValues, 5> values{{{"rho_d", rho_d},
                                                        {"rho_s", rho_s},
                                                        {"alpha", narrow},
                                                        {"rho_s_2", rho_s_2},
                                                        {"alpha_2", wide}}};
  static const brdf::BoundModel model(brdf::Model("lambert+ward-gmd+ward-gmd"), 1, values);
  double f_r = 0;
  model.f_r(wi, wo, {&f_r, 1});
  return f_r;
}

/// A plane-symmetrical Zemax table over these radial angles about the mirror direction, with 2 % of
/// noise of a seed.
std::string zemax_table(const std::vector<double>& radial_deg, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const std::vector<double> incidence_deg{10, 30, 50};
  std::vector<double> azimuth_deg;
  for (int k = 0; k <= 18; ++k) azimuth_deg.push_back(10 * k);
  std::string text =
      "Source\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\n"
      "ScatterType\tBRDF\nSampleRotation\t1\n0\n";
  const auto list = [&](const char* name, const std::vector<double>& angles) {
    text += fmt::format("{}\t{}\n", name, angles.size());
    for (const double angle : angles) text += fmt::format("{}\t", angle);
    text += '\n';
  };
  list("AngleOfIncidence", incidence_deg);
  list("ScatterAzimuth", azimuth_deg);
  list("ScatterRadial", radial_deg);
  text += "\nMonochrome\nDataBegin\n";
  for (const double incidence : incidence_deg) {
    text += "TIS\t0.1\n";
    const auto wi = brdf::direction_from_degrees(incidence, 0);
    const brdf::Direction<double> s = brdf::direction_from_degrees(incidence, 180);
    // t points from the mirror direction to the normal, b is across.
    const brdf::Direction<double> t = brdf::direction_from_degrees(90 - incidence, 0);
    for (const double azimuth : azimuth_deg) {
      for (const double radial : radial_deg) {
        const auto from_axis = brdf::direction_from_degrees(radial, azimuth);
        const brdf::Direction<double> wo{from_axis.z * s.x + from_axis.x * t.x, from_axis.y,
                                         from_axis.z * s.z + from_axis.x * t.z};
        const double noise = 1 + 0.02 * normal(random);
        text += fmt::format("{:.6e}\t", wo.z > 0 ? measured(wi, wo) * noise : 0.0);
      }
      text += '\n';
    }
  }
  return text + "DataEnd\n";
}

std::vector<double> radial_angles(bool is_dense) {
  std::vector<double> angles;
  for (double angle = 0; angle <= 120;) {
    angles.push_back(angle);
    angle += is_dense && angle >= 20 && angle < 60 ? 2.5 : 5;
  }
  return angles;
}

fit::FitResult fitted(bool is_dense, bool with_weights) {
  const TemporaryFolder folder;
  table::SampleTable table = table::read(
      folder.write("grid.bsdf", zemax_table(radial_angles(is_dense), is_dense ? 2 : 1)));
  if (!with_weights) table.weight.clear();
  return fit::fit(brdf::Model("lambert+ward-gmd"), table, {});
}

/// The largest change of a parameter in half widths of its 95 % interval (of the even grid).
double largest_move(bool with_weights) {
  const fit::FitResult even = fitted(false, with_weights);
  const fit::FitResult dense = fitted(true, with_weights);
  double largest = 0;
  for (std::size_t u = 0; u < even.unknowns.size(); ++u) {
    const double change = dense.values[dense.unknowns[u]] - even.values[even.unknowns[u]];
    largest = std::max(largest, std::abs(change) / (1.96 * even.uncertainty.stddev[u].value()));
  }
  return largest;
}

TEST(GridDensity, AGridTwiceAsDenseInOneRegionMovesNoParameterOutOfItsInterval) {
  const double weighted = largest_move(true);
  const double unweighted = largest_move(false);
  RecordProperty("weighted", fmt::format("{:.3f}", weighted));
  RecordProperty("unweighted", fmt::format("{:.3f}", unweighted));
  EXPECT_LT(weighted, 1);
  // Else the weights would be tested by nothing.
  EXPECT_GT(unweighted, 1);
}

}  // namespace
}  // namespace gonio::tests
