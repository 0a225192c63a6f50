// Files of the RGL database: the warp against its own inverse and integrals, values against a file
// whose f_r follows by hand and against a reference loader's, weights against an integral.
#include "table/formats/rgl.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/rgl_warp.h"
#include "table/read.h"
#include "table/solid_angle.h"
#include "tests/real_data.h"
#include "tests/tensor_bytes.h"

namespace gonio::tests {
namespace {

using brdf::direction_from_degrees;
using table::GriddedTable;
using table::MaskReason;
using table::Point;
using table::SampleTable;
using table::SliceMix;
using table::Warp;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

// The warp ---------------------------------------------------------------------------------------

constexpr std::size_t rows = 5;
constexpr std::size_t columns = 4;

std::vector<float> random_density(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.05F, 2.0F);
  std::vector<float> values(2 * rows * columns);
  std::generate(values.begin(), values.end(), [&] { return uniform(random); });
  return values;
}

const SliceMix mixed{{0, 1}, {0.3, 0.7}};

TEST(RglWarp, ForwardAndInverseUndoEachOther) {
  const Warp warp(random_density(1), 2, rows, columns);
  for (double x = 0.01; x < 1; x += 0.07) {
    for (double y = 0.01; y < 1; y += 0.07) {
      const Point there = warp.forward({x, y}, mixed);
      const Point back = warp.inverse(there, mixed);
      EXPECT_NEAR(back.x, x, 1e-12);
      EXPECT_NEAR(back.y, y, 1e-12);
    }
  }
}

TEST(RglWarp, TheInverseIsTheIntegralOfTheDensity) {
  const Warp warp(random_density(2), 2, rows, columns);
  // P(y' < y), and P(x' < x) within the row y, by the midpoint rule on a fine grid.
  const Point p{0.37, 0.61};
  constexpr int steps = 600;
  double below = 0;
  double all = 0;
  double left = 0;
  double row = 0;
  for (int i = 0; i < steps; ++i) {
    const double a = (i + 0.5) / steps;
    row += warp.density({a, p.y}, mixed);
    left += warp.density({a * p.x, p.y}, mixed) * p.x;
    for (int k = 0; k < steps; ++k) {
      const double b = (k + 0.5) / steps;
      all += warp.density({a, b}, mixed);
      below += warp.density({a, b * p.y}, mixed) * p.y;
    }
  }
  EXPECT_NEAR(all / (steps * steps), 1, 1e-5);
  const Point s = warp.inverse(p, mixed);
  EXPECT_NEAR(s.y, below / (steps * steps), 1e-5);
  EXPECT_NEAR(s.x, left / row, 1e-5);
}

TEST(RglWarp, StaysInTheSquareWhereTheDensityVanishes) {
  std::vector<float> values(rows * columns, 0.0F);
  values[7] = 1;
  const Warp peak(values, 1, rows, columns);
  const Warp nothing(std::vector<float>(rows * columns, 0.0F), 1, rows, columns);
  const SliceMix only{{0, 0}, {1, 0}};
  for (const Warp* warp : {&peak, &nothing}) {
    for (const double x : {0.0, 0.3, 1.0}) {
      for (const double y : {0.0, 0.7, 1.0}) {
        for (const Point& q : {warp->forward({x, y}, only), warp->inverse({x, y}, only)}) {
          EXPECT_TRUE(q.x >= 0 && q.x <= 1 && q.y >= 0 && q.y <= 1) << q.x << ' ' << q.y;
        }
      }
    }
  }
}

// A file whose values follow by hand -----------------------------------------------------------

std::vector<float> constant(std::size_t count, float value) {
  std::vector<float> values(count, value);
  return values;
}

/// ndf, sigma and vndf are constant; rgb is linear in x and y, R negative in a corner.
std::vector<TensorField> plain_fields() {
  std::vector<float> rgb;
  for (int incidence = 0; incidence < 2; ++incidence) {
    for (int channel = 0; channel < 3; ++channel) {
      for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
          rgb.push_back(channel == 0 ? float(x + y) - 0.5F
                                     : float(channel) + float(x) + 10 * float(incidence));
        }
      }
    }
  }
  return {{"phi_i", {1}, {0}},
          {"theta_i", {2}, {0.25F, 1.25F}},
          {"ndf", {2, 2}, constant(4, 3)},
          {"sigma", {2, 2}, constant(4, 0.5F)},
          {"vndf", {1, 2, 3, 3}, constant(18, 7)},
          {"rgb", {1, 2, 3, 2, 2}, rgb}};
}

TEST(Rgl, EvaluatesTheFormula) {
  const GriddedTable grid = table::read_rgl_grid(tensor_file_of(plain_fields()), "t.bsdf");
  EXPECT_THAT(grid.channels, ElementsAre("R", "G", "B"));
  const auto wi = brdf::direction_from_radians(0.75, 0.4);
  const auto wo = brdf::direction_from_radians(0.5, 2.0);
  std::array<double, 3> f_r{};
  grid.f_r(wi, wo, f_r);
  // The warp of a constant density is the identity: x = u, y = v of the half vector.
  const auto h = brdf::half_vector(wi, wo);
  const double x = std::sqrt(2 / pi * std::acos(h.z / std::hypot(h.x, h.y, h.z)));
  const double y = (std::atan2(h.y, h.x) - 0.4 + pi) / (2 * pi);
  const double factor = 3 / (4 * 0.5) / std::cos(0.5);
  EXPECT_NEAR(f_r[0], std::max(x + y - 0.5, 0.0) * factor, 1e-6);
  EXPECT_NEAR(f_r[1], (1 + x + 5) * factor, 1e-6);  // midway between both incidences
  EXPECT_NEAR(f_r[2], (2 + x + 5) * factor, 1e-6);
}

TEST(Rgl, HasNothingAtTheHorizonAndBelow) {
  const GriddedTable grid = table::read_rgl_grid(tensor_file_of(plain_fields()), "t.bsdf");
  std::array<double, 3> f_r{};
  for (const auto& [theta_i, theta_o] : {std::pair{90.0, 10.0}, {10.0, 90.0}, {10.0, 120.0}}) {
    grid.f_r(direction_from_degrees(theta_i, 0), direction_from_degrees(theta_o, 10), f_r);
    EXPECT_TRUE(std::isnan(f_r[0]) && std::isnan(f_r[2]));
  }
}

/// Densities and colours at random, the same at both ends of the azimuth, which are one direction.
std::vector<TensorField> random_fields() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.1F, 2.0F);
  const auto periodic = [&](std::size_t slices, std::size_t along_v, std::size_t along_u) {
    std::vector<float> values(slices * along_v * along_u);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool is_last_row = i / along_u % along_v == along_v - 1;
      values[i] = is_last_row ? values[i - (along_v - 1) * along_u] : uniform(random);
    }
    return values;
  };
  return {{"phi_i", {1}, {0}},
          {"theta_i", {3}, {0, 0.5F, 1.25F}},
          {"ndf", {4, 5}, periodic(1, 4, 5)},
          {"sigma", {3, 6}, periodic(1, 3, 6)},
          {"vndf", {1, 3, 6, 7}, periodic(3, 6, 7)},
          {"rgb", {1, 3, 3, 8, 9}, periodic(9, 8, 9)}};
}

/// The largest difference of a sample from the function at its directions, and how many there are.
/// Samples without a weight are left out: there the half vector is the normal, without an azimuth.
std::pair<double, std::size_t> worst_sample(const SampleTable& table, const GriddedTable& grid) {
  double worst = 0;
  std::size_t used = 0;
  std::array<double, 3> f_r{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != MaskReason::none || table.weight[i] == 0) continue;
    ++used;
    grid.f_r(table.wi[i], table.wo[i], f_r);
    for (std::size_t c = 0; c < 3; ++c) {
      const double difference = std::abs(f_r[c] - table.values[c][i]);
      worst = difference <= worst ? worst : difference;  // keeps a NaN
    }
  }
  return {worst, used};
}

TEST(Rgl, SamplesAreThoseOfTheFunctionAtTheirDirections) {
  const std::string bytes = tensor_file_of(random_fields());
  const SampleTable table = table::read_rgl(bytes, "t.bsdf", {});
  const auto [worst, used] = worst_sample(table, table::read_rgl_grid(bytes, "t.bsdf"));
  EXPECT_EQ(table.size(), 3U * 8 * 9);
  EXPECT_GT(used, 80U);
  EXPECT_LE(worst, 1e-9);
}

/// The sum of the weights per incidence, of all samples or of those that are not masked.
std::vector<double> sums_of_weights(const SampleTable& table, std::size_t incidences, bool masked) {
  std::vector<double> sums(incidences);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (masked || table.mask[i] == MaskReason::none) {
      sums[i / (table.size() / incidences)] += table.weight[i];
    }
  }
  return sums;
}

TEST(Rgl, WeightsAreTheSolidAngleOfWo) {
  // Mirrored about the half vectors up to 45 deg, the normal covers the hemisphere, and what lies
  // below it weighs nothing; a single incidence has the measure 1. The density is at random, the
  // grid of the samples is fine.
  std::vector<TensorField> fields = random_fields();
  fields[1] = {"theta_i", {1}, {0}};
  fields[4] = {"vndf", {1, 1, 5, 4}, random_density(4)};
  fields[4].values.resize(20);
  fields[5] = {"rgb", {1, 1, 3, 129, 129}, constant(std::size_t{3} * 129 * 129, 1)};
  const SampleTable normal = table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
  EXPECT_NEAR(sums_of_weights(normal, 1, true)[0] / (2 * pi), 1, 5e-3);

  // The samples above the horizon cover the hemisphere, whatever the incidence.
  for (const float theta_i : {0.0F, 0.5F, 1.0F, 1.4F}) {
    fields[1].values = {theta_i};
    const SampleTable table = table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
    EXPECT_NEAR(sums_of_weights(table, 1, false)[0] / (2 * pi), 1, 0.02) << theta_i;
  }
}

TEST(Rgl, WeightsHoldTheMeasureOfTheIncidence) {
  std::vector<TensorField> fields = random_fields();
  fields[4] = {"vndf", {1, 3, 2, 2}, constant(12, 1)};
  fields[5] = {"rgb", {1, 3, 3, 129, 129}, constant(std::size_t{9} * 129 * 129, 1)};
  const SampleTable table = table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
  const std::vector<double> sums = sums_of_weights(table, 3, false);
  // Cells of the polar angles 0, 0.5 and 1.25: edges 0, 0.25, 0.875 and pi/2.
  const std::array<double, 4> edges{0, 0.25, 0.875, pi / 2};
  for (std::size_t k = 0; k < 3; ++k) {
    const double measure = std::cos(edges[k]) - std::cos(edges[k + 1]);
    EXPECT_NEAR(sums[k] / measure / (2 * pi), 1, 0.02) << k;
  }
}

TEST(Rgl, WhatReflectsNothingIsAHoleWithoutInfinities) {
  std::vector<TensorField> fields = random_fields();
  fields[3] = {"sigma", {2, 2}, constant(4, 0)};
  fields[4].values.assign(fields[4].values.size(), 0);
  const SampleTable table = table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
  std::size_t holes = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_NE(table.mask[i], MaskReason::none);
    EXPECT_TRUE(std::isnan(table.values[0][i]));
    EXPECT_TRUE(std::isfinite(table.weight[i]) && table.weight[i] >= 0);
    const auto wo = table.wo[i];
    EXPECT_NEAR(std::hypot(wo.x, wo.y, wo.z), 1, 1e-12);
    holes += table.mask[i] == MaskReason::hole ? 1 : 0;
  }
  EXPECT_GT(holes, 80U);
}

TEST(Rgl, NamesChannelsByWavelength) {
  std::vector<TensorField> fields = plain_fields();
  fields.back() = {"spectra", {1, 2, 2, 2, 2}, constant(16, 0.5F)};
  fields.push_back({"wavelengths", {2}, {450, 550.5F}});
  const SampleTable table = table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
  EXPECT_THAT(table.channels, ElementsAre("450nm", "550.5nm"));
}

std::string refusal(const std::vector<TensorField>& fields) {
  try {
    table::read_rgl(tensor_file_of(fields), "t.bsdf", {});
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Rgl, RefusesShapesThatContradictEachOther) {
  const auto with = [](std::size_t index, const TensorField& field) {
    std::vector<TensorField> fields = plain_fields();
    fields[index] = field;
    return refusal(fields);
  };
  EXPECT_THAT(with(0, {"phi_i", {3}, {0, 1, 2}}), HasSubstr("anisotropic"));
  EXPECT_THAT(with(1, {"theta_i", {3}, {0, 1, 1.2F}}), HasSubstr("field 'vndf': found data for"));
  EXPECT_THAT(with(1, {"theta_i", {2}, {1, 0.5F}}), HasSubstr("rising angles"));
  EXPECT_THAT(with(1, {"theta_i", {2}, {1, 1.7F}}), HasSubstr("rising angles"));
  EXPECT_THAT(with(1, {"theta_i", {2}, {-1e-6F, 1}}), HasSubstr("rising angles"));
  EXPECT_THAT(with(2, {"ndf", {1, 4}, constant(4, 1)}), HasSubstr("2 x 2 at least"));
  EXPECT_THAT(with(3, {"sigma", {4}, constant(4, 1)}), HasSubstr("1 dimensions, expected 2"));
  EXPECT_THAT(with(4, {"vndf", {1, 2, 3, 3}, constant(18, -1)}), HasSubstr("expected at least 0"));
  EXPECT_THAT(with(5, {"rgb", {1, 2, 4, 2, 2}, constant(32, 1)}),
              HasSubstr("found 4 channels, expected 3"));
  EXPECT_THAT(with(5, {"grey", {1, 2, 1, 2, 2}, constant(8, 1)}), HasSubstr("'spectra'"));
  std::vector<TensorField> twice = plain_fields();
  twice.back() = {"spectra", {1, 2, 2, 2, 2}, constant(16, 0.5F)};
  twice.push_back({"wavelengths", {2}, {450, 450}});
  EXPECT_THAT(refusal(twice), HasSubstr("stands twice"));
}

// Real files -------------------------------------------------------------------------------------

const std::array<const char*, 9> materials{
    "aurora_white",           "cc_ibiza_sunset", "cc_nothern_aurora",
    "chm_light_blue",         "chm_orange",      "colodur_napoli_4f",
    "irid_flake_paint1_fine", "paper_white",     "vch_golden_yellow"};

class RealRgl : public testing::TestWithParam<const char*> {};

TEST_P(RealRgl, GivesWhatTheReferenceLoaderGave) {
  const std::string stem = std::string("rgl/") + GetParam() + "_rgb";
  GONIO_REAL_DATA_OR_SKIP(path, stem + ".bsdf");
  GONIO_REAL_DATA_OR_SKIP(reference_path, stem + ".csv");
  table::ReadOptions options;
  options.quantity = table::Quantity::brdf;
  const SampleTable reference = table::read(reference_path, options);
  const GriddedTable grid = table::read_gridded(path);
  double peak = 0;
  for (const auto& values : reference.values) {
    peak = std::max(peak, *std::max_element(values.begin(), values.end()));
  }
  double worst = 0;
  std::size_t holes = 0;  // std::max() would pass over them
  std::array<double, 3> f_r{};
  for (std::size_t i = 0; i < reference.size(); ++i) {
    grid.f_r(reference.wi[i], reference.wo[i], f_r);
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(f_r[c] - reference.values[c][i]) / peak);
      holes += std::isnan(f_r[c]) ? 1 : 0;
    }
  }
  EXPECT_EQ(reference.size(), 4674U);
  EXPECT_EQ(holes, 0U);
  EXPECT_LE(worst, 1e-4);
  RecordProperty("of_peak", fmt::format("{:.2e}", worst));
}

TEST_P(RealRgl, SamplesAreThoseOfTheFunctionAtTheirDirections) {
  const std::string stem = std::string("rgl/") + GetParam() + "_rgb";
  GONIO_REAL_DATA_OR_SKIP(path, stem + ".bsdf");
  const SampleTable table = table::read(path);
  const auto [worst, used] = worst_sample(table, table::read_gridded(path));
  double peak = 0;
  for (const auto& values : table.values) {
    for (const double value : values) peak = std::max(peak, value);
  }
  EXPECT_GT(used, table.size() / 2);
  EXPECT_LE(worst / peak, 1e-4);
}

/// The light of `wi` that leaves in channel 1, on a grid of half vectors that is finer towards the
/// normal: a clear coat's highlight is narrower than a degree.
double brute_force_albedo(const GriddedTable& grid, const brdf::Direction<double>& wi) {
  constexpr int along_u = 600;
  constexpr int along_phi = 150;  // isotropic: both halves of the circle are taken as one
  double sum = 0;
  std::array<double, 3> f_r{};
  for (int i = 0; i < along_u; ++i) {
    const double u = (i + 0.5) / along_u;
    const double theta = pi / 2 * u * u;
    for (int k = 0; k < along_phi; ++k) {
      const auto h = brdf::direction_from_radians(theta, pi * (k + 0.5) / along_phi);
      const double wi_h = wi.x * h.x + wi.y * h.y + wi.z * h.z;
      const brdf::Direction<double> wo{2 * wi_h * h.x - wi.x, 2 * wi_h * h.y - wi.y,
                                       2 * wi_h * h.z - wi.z};
      if (wi_h <= 0 || wo.z <= 1e-6) continue;
      grid.f_r(wi, wo, f_r);
      sum += f_r[1] * wo.z * 4 * wi_h * std::sin(theta) * pi * u;  // dwo = 4 (wi.h) dh
    }
  }
  return sum / along_u * 2 * pi / along_phi;
}

TEST_P(RealRgl, WeightsGiveTheAlbedoOfEveryIncidenceUpTo75Degrees) {
  const std::string stem = std::string("rgl/") + GetParam() + "_rgb";
  GONIO_REAL_DATA_OR_SKIP(path, stem + ".bsdf");
  const SampleTable table = table::read(path);
  const GriddedTable grid = table::read_gridded(path);
  constexpr std::size_t incidences = 8;
  const std::size_t nodes = table.size() / incidences;
  std::vector<double> theta_i;
  for (std::size_t k = 0; k < incidences; ++k) theta_i.push_back(std::acos(table.wi.z[k * nodes]));
  const std::vector<double> measures = table::zenith_measures(theta_i, pi / 2);
  double worst = 0;
  for (std::size_t k = 0; k < incidences && theta_i[k] < 75 * pi / 180; ++k) {
    double by_samples = 0;
    for (std::size_t i = k * nodes; i < (k + 1) * nodes; ++i) {
      if (table.mask[i] != MaskReason::none) continue;
      by_samples += table.weight[i] / measures[k] * table.values[1][i] * table.wo.z[i];
    }
    const double ratio = by_samples / brute_force_albedo(grid, table.wi[k * nodes]);
    // The cells of nodes beyond the horizon are lost, a few per cent on 32 x 32 nodes.
    EXPECT_NEAR(ratio, 0.98, 0.05) << theta_i[k] * 180 / pi;
    worst = std::max(worst, std::abs(ratio - 1));
  }
  RecordProperty("worst_albedo", fmt::format("{:.3f}", worst));
}

INSTANTIATE_TEST_SUITE_P(Materials, RealRgl, testing::ValuesIn(materials),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace gonio::tests
