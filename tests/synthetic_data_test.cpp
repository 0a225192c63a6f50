// The recipes and tables that the project keeps in data/synthetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "instrument/synthesize.h"
#include "table/read.h"
#include "tests/ward_materials.h"

namespace gonio::instrument {
namespace {

std::filesystem::path synthetic_folder() {
  return std::filesystem::path(GONIO_SOURCE_DIR) / "data" / "synthetic";
}

/// Those of a folder, without its subfolders.
std::vector<std::filesystem::path> recipes_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> recipes;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") recipes.push_back(entry.path());
  }
  return recipes;
}

std::vector<std::filesystem::path> committed_recipes() {
  std::vector<std::filesystem::path> recipes = recipes_in(synthetic_folder());
  const auto strauss = recipes_in(synthetic_folder() / "strauss");
  recipes.insert(recipes.end(), strauss.begin(), strauss.end());
  return recipes;
}

TEST(SyntheticData, HoldsTheTenMaterialsOfWardsTable) {
  std::set<std::uint64_t> seeds;
  for (const tests::WardMaterial& material : tests::ward_materials) {
    SCOPED_TRACE(material.name);
    std::string file(material.name);
    std::replace(file.begin(), file.end(), ' ', '_');
    const Recipe r = read_recipe((synthetic_folder() / (file + ".json")).string());
    EXPECT_EQ(r.name, material.name);
    EXPECT_EQ(r.parameters.at("rho_d"), std::vector{material.rho_d});
    EXPECT_EQ(r.parameters.at("rho_s"), std::vector{material.rho_s});
    if (material.alpha_x == material.alpha_y) {
      EXPECT_EQ(r.parameters.at("alpha"), std::vector{material.alpha_x});
    } else {
      EXPECT_EQ(r.parameters.at("alpha_x"), std::vector{material.alpha_x});
      EXPECT_EQ(r.parameters.at("alpha_y"), std::vector{material.alpha_y});
    }
    EXPECT_EQ(r.noise.relative, 0.02);
    EXPECT_EQ(r.noise.floor, 0.001);
    EXPECT_TRUE(r.sigma_columns);
    EXPECT_TRUE(seeds.insert(r.noise.seed).second) << "shares its noise with another";
  }
  EXPECT_EQ(recipes_in(synthetic_folder()).size(), tests::ward_materials.size());
}

TEST(SyntheticData, HoldsTheCornersOfStrausssModelAndSomeBetween) {
  const auto recipes = recipes_in(synthetic_folder() / "strauss");
  EXPECT_EQ(recipes.size(), 8u);
  std::set<std::uint64_t> seeds;
  std::set<std::pair<bool, bool>> corners;  // smooth or rough, metal or not
  for (const auto& path : recipes) {
    SCOPED_TRACE(path.filename());
    const Recipe r = read_recipe(path.string());
    EXPECT_EQ(r.model, "strauss");
    EXPECT_EQ(r.noise.relative, 0.02);
    EXPECT_EQ(r.noise.floor, 0.001);
    EXPECT_TRUE(r.sigma_columns);
    EXPECT_TRUE(seeds.insert(r.noise.seed).second) << "shares its noise with another";
    const double s = r.parameters.at("s").front();
    const double m = r.parameters.at("m").front();
    const bool is_corner = (s <= 0.3 || s >= 0.9) && (m <= 0.1 || m >= 0.9);
    if (is_corner) corners.emplace(s >= 0.9, m >= 0.9);
  }
  EXPECT_EQ(corners.size(), 4u);
}

TEST(SyntheticData, EveryTableIsWhatItsRecipeGives) {
  for (std::filesystem::path path : committed_recipes()) {
    SCOPED_TRACE(path.filename());
    const auto made = synthesize(read_recipe(path.string()));
    const auto committed =
        table::read(path.replace_extension(".csv").string(), {.keep_angle_text = true});
    EXPECT_EQ(committed.name, made.name);
    EXPECT_EQ(committed.channels, made.channels);
    ASSERT_EQ(committed.angle_text, made.angle_text);
    ASSERT_TRUE(committed.has_sigma());
    for (std::size_t c = 0; c < made.channels.size(); ++c) {
      for (std::size_t i = 0; i < made.size(); ++i) {
        // libm's log, cos, sin and exp may differ in their last bit from machine to machine.
        ASSERT_NEAR(committed.values[c][i], made.values[c][i],
                    1e-12 * made.sigma[c][i] + 1e-12 * made.values[c][i]);
        ASSERT_NEAR(committed.sigma[c][i], made.sigma[c][i], 1e-12 * made.sigma[c][i]);
      }
    }
    EXPECT_LE(std::filesystem::file_size(path), 120000U) << "small enough to keep beside";
  }
}

TEST(SyntheticData, EvenTheSharpestLobeIsWellSampled) {
  for (const auto& path : committed_recipes()) {
    SCOPED_TRACE(path.filename());
    const auto t = synthesize(read_recipe(path.string()));
    const double peak = *std::max_element(t.values[0].begin(), t.values[0].end());
    const double floor = *std::min_element(t.values[0].begin(), t.values[0].end());
    // Samples on the lobe's flanks say how wide it is.
    const auto flank = std::count_if(t.values[0].begin(), t.values[0].end(), [&](double f) {
      return f > floor + 0.1 * (peak - floor) && f < floor + 0.9 * (peak - floor);
    });
    EXPECT_GE(flank, 100);
  }
}

}  // namespace
}  // namespace gonio::instrument
