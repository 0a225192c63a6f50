// Ngan, Durand and Matusik's ranking (Experimental Analysis of BRDF Models, EGSR 2005) put to the
// test: Ashikhmin-Shirley before Ward-Duer before Ward before Blinn-Phong, each one lobe beside a
// Lambertian part, by their errors on measured materials.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fit/options.h"
#include "table/sample_table.h"

namespace gonio::bench {

/// Ashikhmin and Shirley's model stands there in three forms: as Ngan fitted it (scaled_fresnel.h),
/// its lobe beside lambert, and with its own diffuse part. Ngan's form is no term of the library.
struct Contender {
  char letter;
  std::string_view name;
};
inline constexpr std::array<Contender, 6> contenders{{{'N', "Ngan's form"},
                                                      {'L', "lambert+ashikhmin-shirley"},
                                                      {'A', "ashikhmin-shirley"},
                                                      {'D', "lambert+ward-duer"},
                                                      {'W', "lambert+ward"},
                                                      {'B', "lambert+blinn-phong"}}};
inline constexpr std::size_t ngan_form = 0;
inline constexpr std::size_t ashikhmin_shirley_forms = 3;
inline constexpr std::size_t ward_duer = 3;
inline constexpr std::size_t ward = 4;
inline constexpr std::size_t blinn_phong = 5;

/// What errors are measured by.
struct View {
  std::string_view name;
  fit::Metric metric;
  /// Samples count by sin(theta_o), the solid angle that they stand for on a grid of polar angles.
  bool solid_angle;
};

/// A contender's error is missing where it is not fitted under the view's metric: Ngan's form under
/// others than cosine-l2.
struct Ranked {
  std::string material;
  std::size_t used = 0;
  std::array<std::optional<double>, contenders.size()> errors;
  bool all_converged = true;
};

/// Fits all contenders to a material.
Ranked rank(const table::SampleTable& table, const View& view, double max_theta_deg, int threads);

/// The indices of the contenders that are there, by error.
std::vector<std::size_t> order_of(std::span<const std::optional<double>, contenders.size()> errors);

/// On how many materials Ngan's ranking holds, with one of the forms of Ashikhmin-Shirley.
struct RankingTally {
  std::size_t before_ward_duer = 0;
  std::size_t ward_duer_before_ward = 0;
  std::size_t ward_before_blinn_phong = 0;
  std::size_t all = 0;
};
RankingTally tally_ranking(std::span<const Ranked> materials, std::size_t form);

/// Per contender, the geometric mean over the materials of its error relative to the least.
std::array<std::optional<double>, contenders.size()> pooled_errors(
    std::span<const Ranked> materials);

}  // namespace gonio::bench
