// CUReT's pair of files, and what Oren and Nayar's models make of its materials.
#include "table/formats/curet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "bench/curet_study.h"
#include "brdf/model.h"
#include "table/file_error.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using table::MaskReason;
using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;

// Synthetic pairs ----------------------------------------------------------------------------

const std::string two_directions =
    "1 0.5 -1.0 0.25 3.0\r\n"
    "2 0.0  0.0 1.25 0.0";

/// Reads a pair of these contents; `message` is that of the error, if there is one.
std::vector<SampleTable> read(const std::string& measurements, const std::string& directions,
                              std::string& message) {
  const TemporaryFolder folder;
  try {
    return table::read_curet({.measurements = folder.write("abrdf.dat", measurements),
                              .directions = folder.write("table.txt", directions)});
  } catch (const table::FileError& error) {
    message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return {};
  }
}

std::vector<SampleTable> accepted(const std::string& measurements, const std::string& directions) {
  std::string message;
  std::vector<SampleTable> tables = read(measurements, directions, message);
  EXPECT_EQ(message, "");
  return tables;
}

std::string refusal(const std::string& measurements, const std::string& directions) {
  std::string message = "accepted";
  read(measurements, directions, message);
  return message;
}

TEST(Curet, TheViewerStandsBeforeTheLampInTheTableOfDirections) {
  const auto tables = accepted("1 0.125 0.25\n7 0.5 1.5\n", two_directions);
  ASSERT_EQ(tables.size(), 2u);
  const SampleTable& t = tables[1];
  EXPECT_EQ(t.name, "CUReT 7");
  EXPECT_THAT(t.channels, ElementsAre("mean"));
  EXPECT_THAT(t.values, ElementsAre(ElementsAre(0.5, 1.5)));
  EXPECT_EQ(t.provenance.format, "CUReT");
  EXPECT_EQ(t.provenance.angles, table::AngleUnit::radians);
  EXPECT_NEAR(t.wo[0].x, std::sin(0.5) * std::cos(-1.0), 1e-15);
  EXPECT_NEAR(t.wo[0].y, std::sin(0.5) * std::sin(-1.0), 1e-15);
  EXPECT_NEAR(t.wo[0].z, std::cos(0.5), 1e-15);
  EXPECT_NEAR(t.wi[0].x, std::sin(0.25) * std::cos(3.0), 1e-15);
  EXPECT_NEAR(t.wi[0].y, std::sin(0.25) * std::sin(3.0), 1e-15);
  EXPECT_NEAR(t.wi[1].z, std::cos(1.25), 1e-15);
}

TEST(Curet, ZeroAndNegativeReadingsAreHoles) {
  const SampleTable t = accepted("4 -0.009 0.001\n", two_directions).at(0);
  EXPECT_THAT(t.mask, ElementsAre(MaskReason::hole, MaskReason::none));
  EXPECT_TRUE(std::isnan(t.values[0][0]));
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("1 of the 2 readings are 0 or negative")));
  EXPECT_THAT(accepted("1 -0.000 0\n", two_directions).at(0).mask, testing::Each(MaskReason::hole));
}

TEST(Curet, RefusesWhatIsNoPairAndSaysWhere) {
  EXPECT_THAT(refusal("1 0.1\n", two_directions),
              testing::AllOf(HasSubstr("abrdf.dat:1: found 2 fields"), HasSubstr("expected 3"),
                             HasSubstr("complete the row")));
  EXPECT_THAT(refusal("1 0.1 0.2\n\n2 0.1 0.2 0.3\n", two_directions),
              HasSubstr("abrdf.dat:3: found 4 fields"));
  EXPECT_THAT(refusal("1 0.1 bright\n", two_directions),
              testing::AllOf(HasSubstr("abrdf.dat:1: column 'measurement 2'"),
                             HasSubstr("found 'bright', expected a number")));
  EXPECT_THAT(refusal("1 0.1 nan\n", two_directions), HasSubstr("expected a finite number"));
  EXPECT_THAT(refusal("1.5 0.1 0.2\n", two_directions),
              HasSubstr("abrdf.dat:1: material 1.5, expected a whole number"));
  EXPECT_THAT(refusal("0 0.1 0.2\n", two_directions), HasSubstr("material 0, expected"));
  EXPECT_THAT(refusal("3 0.1 0.2\n2 0.1 0.2\n3 0.1 0.2\n", two_directions),
              HasSubstr("abrdf.dat:3: material 3 stands in line 1 already"));
  EXPECT_THAT(refusal("# nothing\n", two_directions), HasSubstr("abrdf.dat: no row of numbers"));
  EXPECT_THAT(refusal("1 0.1\n", "1 0.5 0 2.5 0\n"),
              testing::AllOf(HasSubstr("table.txt:1: column 'theta_i'"),
                             HasSubstr("found '2.5', expected 0 to pi/2")));
  EXPECT_THAT(refusal("1 0.1\n", "1 0.5 0 0.5\n"), HasSubstr("table.txt:1: found 4 fields"));
  EXPECT_THAT(refusal("1 0.1 0.2\n", "1 0.5 0 0.5 0\n3 0.5 0 0.5 0\n"),
              HasSubstr("table.txt:2: index 3, expected 2"));
  EXPECT_THAT(refusal("1 0.1\n", ""), HasSubstr("table.txt: the file is empty"));
}

TEST(Curet, AMaterialThatIsNotThereIsNamed) {
  const TemporaryFolder folder;
  const table::CuretFiles files{.measurements = folder.write("abrdf.dat", "1 0.1 0.2\n7 0.3 0.4\n"),
                                .directions = folder.write("table.txt", two_directions)};
  EXPECT_EQ(table::read_curet(files, 7).values[0][1], 0.4);
  try {
    table::read_curet(files, 2);
    ADD_FAILURE() << "accepted";
  } catch (const table::FileError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("no material 2: the file holds 2, the first is 1, the last 7"));
  }
}

// The real pair ------------------------------------------------------------------------------

constexpr std::size_t material_count = 61;
constexpr std::size_t direction_count = 205;

TEST(CuretData, IsReadAsItStandsInTheFiles) {
  GONIO_REAL_DATA_OR_SKIP(measurements, "curet/abrdf.dat");
  GONIO_REAL_DATA_OR_SKIP(directions, "curet/table.txt");
  const auto tables = table::read_curet({measurements, directions});
  ASSERT_EQ(tables.size(), material_count);
  // By a parser of its own.
  std::ifstream direction_text(directions);
  std::vector<std::array<double, 5>> rows(direction_count);
  for (auto& row : rows) {
    for (double& field : row) direction_text >> field;
  }
  std::ifstream measurement_text(measurements);
  std::size_t holes = 0;
  for (const SampleTable& t : tables) {
    int number = 0;
    measurement_text >> number;
    EXPECT_EQ(t.name, "CUReT " + std::to_string(number));
    ASSERT_EQ(t.size(), direction_count);
    for (std::size_t i = 0; i < direction_count; ++i) {
      double value = 0;
      measurement_text >> value;
      holes += value > 0 ? 0 : 1;
      ASSERT_EQ(t.mask[i], value <= 0 ? MaskReason::hole : MaskReason::none);
      if (value > 0) {
        ASSERT_EQ(t.values[0][i], value);
      }
      ASSERT_NEAR(t.wo[i].z, std::cos(rows[i][1]), 1e-15);
      ASSERT_NEAR(t.wo[i].x, std::sin(rows[i][1]) * std::cos(rows[i][2]), 1e-15);
      ASSERT_NEAR(t.wi[i].y, std::sin(rows[i][3]) * std::sin(rows[i][4]), 1e-15);
    }
  }
  EXPECT_TRUE(direction_text && measurement_text);
  EXPECT_EQ(holes, 43u);  // as the data's own description counts them

  // A few by eye: the first direction, the only hole of material 4 (-0.009), the largest value.
  EXPECT_NEAR(std::acos(tables[0].wo[0].z), 1.389566, 1e-12);
  EXPECT_NEAR(std::acos(tables[0].wi[0].z), 1.374447, 1e-12);
  EXPECT_EQ(tables[0].values[0][0], 0.2);
  EXPECT_EQ(tables[3].mask[191], MaskReason::hole);
  EXPECT_EQ(std::count(tables[3].mask.begin(), tables[3].mask.end(), MaskReason::hole), 1);
  EXPECT_EQ(std::count(tables[60].mask.begin(), tables[60].mask.end(), MaskReason::hole), 42);
  EXPECT_EQ(tables[29].values[0][99], 0.204);
}

TEST(CuretData, GlossyMaterialsMirrorWhereTheDirectionsSayTheyDo) {
  // Material 9 shines: were the columns of the two directions mixed up, its brightest reading
  // would not lie in the mirror direction.
  GONIO_REAL_DATA_OR_SKIP(measurements, "curet/abrdf.dat");
  GONIO_REAL_DATA_OR_SKIP(directions, "curet/table.txt");
  const SampleTable t = table::read_curet({measurements, directions}, 9);
  const auto brightest = static_cast<std::size_t>(
      std::max_element(t.values[0].begin(), t.values[0].end()) - t.values[0].begin());
  EXPECT_EQ(t.values[0][brightest], 1.669);
  EXPECT_NEAR(t.wi[brightest].x, -t.wo[brightest].x, 1e-5);
  EXPECT_NEAR(t.wi[brightest].y, -t.wo[brightest].y, 1e-5);
  EXPECT_NEAR(t.wi[brightest].z, t.wo[brightest].z, 1e-5);
}

/// The least root mean square over sigma in steps of half a degree and every rho_d of at least 0:
/// rho_d is found in closed form.
double scanned_error(const SampleTable& t, fit::Metric metric) {
  const brdf::Model model("oren-nayar");
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= 180; ++step) {
    const std::array sigma{step * std::numbers::pi / 360};
    double basis_square = 0;
    double product = 0;
    double square = 0;
    double count = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (t.mask[i] != MaskReason::none) continue;
      const double factor = metric == fit::Metric::cosine_l2 ? t.wi[i].z : 1;
      double basis = 0;
      model.basis(sigma, t.wi[i], t.wo[i], std::span(&basis, 1));
      basis *= factor;
      const double value = factor * t.values[0][i];
      basis_square += basis * basis;
      product += basis * value;
      square += value * value;
      count += 1;
    }
    least = std::min(least, std::sqrt((square - product * product / basis_square) / count));
  }
  return least;
}

class CuretMaterials : public testing::TestWithParam<fit::Metric> {};

TEST_P(CuretMaterials, AreDescribedByOrenNayarAtLeastAsWellAsByLambert) {
  GONIO_REAL_DATA_OR_SKIP(measurements, "curet/abrdf.dat");
  GONIO_REAL_DATA_OR_SKIP(directions, "curet/table.txt");
  const auto tables = table::read_curet({measurements, directions});
  const auto materials = bench::study_roughness(tables, GetParam(), 90, 0);
  for (const std::size_t model : std::array<std::size_t, 2>{1, 2}) {  // both contain lambert
    const bench::Tally tally = bench::tally(materials, model, 0);
    EXPECT_EQ(tally.better + tally.equal + tally.worse, material_count);
    EXPECT_EQ(tally.worse, 0u) << bench::rough_models[model];
    // Most of the other materials shine where light grazes them, which sigma cannot follow.
    EXPECT_GE(tally.better, 15u) << bench::rough_models[model];
  }
  for (std::size_t k = 0; k < materials.size(); ++k) {
    EXPECT_EQ(materials[k].used, k == 3 ? 204u : k == 60 ? 163u : 205u);
    for (const bench::RoughFit& fit : materials[k].fits) EXPECT_TRUE(fit.converged);
    // The scan is finite: the fit lies a little below it.
    EXPECT_LE(materials[k].fits[1].error, scanned_error(tables[k], GetParam()) * (1 + 1e-9))
        << materials[k].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Metrics, CuretMaterials,
                         testing::Values(fit::Metric::l2, fit::Metric::cosine_l2),
                         [](const auto& instance) {
                           return instance.param == fit::Metric::l2 ? "l2" : "cosine_l2";
                         });

}  // namespace
}  // namespace gonio::tests
