// Writing OpenMATERIAL 3D tables: what is read back, what is lost, and the standard's own schema.
#include "table/formats/openmaterial_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/formats/openmaterial.h"
#include "tests/json_schema.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using nlohmann::json;
using table::MaskReason;
using table::OpenMaterialLoss;
using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Written {
  std::string text;
  OpenMaterialLoss loss;
  std::vector<std::string> sentences;
};

Written written(const SampleTable& table, const table::OpenMaterialMetadata& metadata = {}) {
  Written result;
  result.loss = table::write_openmaterial(table, metadata,
                                          [&](std::string_view piece) { result.text += piece; });
  result.sentences = table::describe(result.loss);
  return result;
}

SampleTable read_back(const Written& file) {
  EXPECT_TRUE(table::is_openmaterial(file.text));
  return table::read_openmaterial(file.text, "t.xompt", {});
}

void add_sample(SampleTable& table, const Direction<double>& wi, const Direction<double>& wo,
                const std::vector<double>& values) {
  table.wi.push_back(wi);
  table.wo.push_back(wo);
  table.values.resize(values.size());
  for (std::size_t c = 0; c < values.size(); ++c) table.values[c].push_back(values[c]);
  table.mask.push_back(MaskReason::none);
}

/// Of `count` random pairs of directions, the light at azimuth 0.
SampleTable random_table(std::size_t count) {
  SampleTable table;
  table.name = "random";
  table.channels = {"465nm", "525nm", "630.5nm"};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    add_sample(table, brdf::direction_from_radians(1.57 * unit(random), 0),
               brdf::direction_from_radians(1.57 * unit(random), 6.28 * unit(random)),
               {unit(random), 1e-300 * unit(random), 1e300 * unit(random)});
  }
  return table;
}

double distance(const Direction<double>& a, const Direction<double>& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// What is read back --------------------------------------------------------------------------

TEST(OpenMaterialWriter, ValuesReadBackToTheSameBitsAndDirectionsTo1e15) {
  const SampleTable table = random_table(2000);
  const Written file = written(table);
  EXPECT_THAT(file.sentences, IsEmpty());
  const SampleTable back = read_back(file);
  EXPECT_EQ(back.name, "random");
  EXPECT_EQ(back.channels, table.channels);
  ASSERT_EQ(back.size(), table.size());
  // Rows are sorted: their first values, which are all different, tell which is which.
  std::vector<std::size_t> order(table.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto found = std::find(table.values[0].begin(), table.values[0].end(), back.values[0][i]);
    ASSERT_NE(found, table.values[0].end());
    const auto at = static_cast<std::size_t>(found - table.values[0].begin());
    EXPECT_EQ(back.values[1][i], table.values[1][at]);
    EXPECT_EQ(back.values[2][i], table.values[2][at]);
    EXPECT_LT(distance(back.wi[i], table.wi[at]), 1e-15);
    EXPECT_LT(distance(back.wo[i], table.wo[at]), 1e-15);
  }
}

TEST(OpenMaterialWriter, AGridInDegreesIsReadBackAsAGrid) {
  SampleTable table;
  table.channels = {"550nm"};
  // The light at 180 deg, so that all angles have passed through rounding.
  for (int theta_i = 0; theta_i <= 80; theta_i += 20) {
    for (int theta_o = 10; theta_o <= 80; theta_o += 10) {
      for (int phi = 0; phi < 360; phi += 30) {
        add_sample(table, brdf::direction_from_degrees(theta_i, 180),
                   brdf::direction_from_degrees(theta_o, 180 + phi), {theta_i + theta_o + 0.5});
      }
    }
  }
  const Written file = written(table);
  EXPECT_THAT(file.sentences, ElementsAre(HasSubstr("the azimuth of the light")));
  const SampleTable back = read_back(file);
  ASSERT_EQ(back.size(), table.size());
  EXPECT_EQ(back.weight.size(), back.size());
  const auto grid = table::read_openmaterial_grid(file.text, "t.xompt");
  double f_r = 0;
  grid.f_r(brdf::direction_from_degrees(35, 77), brdf::direction_from_degrees(42, -120), {&f_r, 1});
  EXPECT_NEAR(f_r, 35 + 42 + 0.5, 1e-11);
}

TEST(OpenMaterialWriter, RowsAreSortedAsTheStandardDemands) {
  SampleTable table = random_table(300);
  table.channels = {"R", "G", "B"};  // falling wavelengths
  const json rows = json::parse(written(table).text)["brdf"]["lookupTable"];
  ASSERT_EQ(rows.size(), 900U);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), [](const json& a, const json& b) {
    return a.get<std::vector<double>>() < b.get<std::vector<double>>();
  }));
}

TEST(OpenMaterialWriter, TheAzimuthIsFromTheLightToTheViewer) {
  SampleTable table;
  table.channels = {"550nm"};
  add_sample(table, brdf::direction_from_degrees(40, 70), brdf::direction_from_degrees(30, 100),
             {1});
  add_sample(table, brdf::direction_from_degrees(40, 70), brdf::direction_from_degrees(40, 250),
             {2});  // the mirror direction
  const json rows = json::parse(written(table).text)["brdf"]["lookupTable"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0][3].get<double>(), std::numbers::pi / 6, 1e-15);
  EXPECT_NEAR(rows[1][3].get<double>(), std::numbers::pi, 1e-15);
}

// What is lost -------------------------------------------------------------------------------

TEST(OpenMaterialWriter, LightsOfSeveralAzimuthsAreAveraged) {
  SampleTable table;
  table.channels = {"550nm", "650nm"};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double phi : {0.0, 45.0, 90.0, 237.0}) {
    add_sample(table, brdf::direction_from_degrees(40, phi),
               brdf::direction_from_degrees(30, phi + 120), {1 + phi, phi < 60 ? 2 + phi : nan});
  }
  const Written file = written(table);
  EXPECT_EQ(file.loss.averaged, 4U);
  EXPECT_EQ(file.loss.averages, 1U);
  EXPECT_THAT(file.sentences,
              ElementsAre(HasSubstr("the azimuth of the light"),
                          HasSubstr("4 samples that share their angles became 1, their means")));
  const SampleTable back = read_back(file);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_NEAR(back.values[0][0], 1 + (45.0 + 90 + 237) / 4, 1e-12);
  EXPECT_NEAR(back.values[1][0], 2 + 45.0 / 2, 1e-12);
}

TEST(OpenMaterialWriter, CountsWhatIsLeftOut) {
  SampleTable table = random_table(10);
  table.mask[2] = MaskReason::retro;
  table.mask[5] = MaskReason::hole;
  table.values[1][3] = std::numeric_limits<double>::quiet_NaN();
  table.values[2][4] = -1e-3;
  table.wo.set(6, brdf::direction_from_degrees(89.99999, 30));
  table.wo.set(7, brdf::direction_from_radians(0.5, -1e-7));
  table.sigma = table.values;
  table.weight.assign(10, 1.0);
  table.channels[2] = "r";
  const Written file = written(table);
  EXPECT_THAT(
      file.sentences,
      ElementsAre(HasSubstr("2 masked samples"), HasSubstr("1 samples at the horizon"),
                  HasSubstr("1 values that were not measured"), HasSubstr("1 negative values"),
                  HasSubstr("1 samples are moved by"), HasSubstr("standard deviations"),
                  HasSubstr("weights"), HasSubstr("read back under such names: r as 611.4nm")));
  const SampleTable back = read_back(file);
  EXPECT_THAT(back.channels, ElementsAre("465nm", "525nm", "611.4nm"));
  EXPECT_EQ(back.size(), 7U);
  EXPECT_EQ(std::count_if(back.values[1].begin(), back.values[1].end(),
                          [](double v) { return std::isnan(v); }),
            1);
  EXPECT_EQ(std::count(back.values[2].begin(), back.values[2].end(), 0.0), 1);
  const std::string description = json::parse(file.text)["metadata"]["description"];
  EXPECT_THAT(description, HasSubstr("Lost on writing: 2 masked samples are left out; 1 samples"));
}

TEST(OpenMaterialWriter, AnyOtherSingleChannelHasNoWavelength) {
  SampleTable table = random_table(3);
  table.channels = {"mean"};
  table.values.resize(1);
  const Written file = written(table);
  EXPECT_THAT(file.sentences, ElementsAre(HasSubstr("mean as brdf")));
  const json brdf = json::parse(file.text)["brdf"];
  EXPECT_THAT(brdf["wavelengths"], IsEmpty());
  EXPECT_TRUE(brdf["lookupTable"][0][0].is_null());
  EXPECT_THAT(read_back(file).channels, ElementsAre("brdf"));
}

std::string refusal(const SampleTable& table) {
  std::string text;
  try {
    table::write_openmaterial(table, {}, [&](std::string_view piece) { text += piece; });
  } catch (const table::FileError& error) {
    EXPECT_EQ(text, "");
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

TEST(OpenMaterialWriter, RefusesWhatTheFormatCannotBeMadeFrom) {
  SampleTable table = random_table(3);
  table.channels = {"465nm", "Solar", "630nm"};
  EXPECT_THAT(refusal(table), AllOf(HasSubstr("found 'Solar'"), HasSubstr("take those channels")));
  table.channels = {"465nm", "611.4nm", "R"};
  EXPECT_THAT(refusal(table), HasSubstr("found '611.4nm' and 'R', which stand for the same"));
  table.channels = {"465nm", "525nm", "0.5nm"};
  EXPECT_THAT(refusal(table), HasSubstr("found '0.5nm', expected a wavelength from 1 nm"));
  table.channels = {"465nm", "525nm", "630nm"};
  table.mask.assign(3, MaskReason::hole);
  EXPECT_THAT(refusal(table), HasSubstr("found none that is measured"));
}

// Metadata -----------------------------------------------------------------------------------

json metadata_of(const Written& file) { return json::parse(file.text)["metadata"]; }

TEST(OpenMaterialWriter, SaysWhatItIsToldAndElseThatItDoesNotKnow) {
  SampleTable table = random_table(3);
  table.provenance.path = "/measurements/paint.csv";
  table.provenance.format = "ASTM text";
  const json unknown = metadata_of(written(table));
  EXPECT_EQ(unknown["license"], "NOASSERTION");
  EXPECT_THAT(unknown["copyrights"], ElementsAre("NOASSERTION"));
  EXPECT_THAT(unknown["authors"], ElementsAre("unknown"));
  EXPECT_EQ(unknown["sources"], "paint.csv, ASTM text");
  const json known = metadata_of(written(table, {.name = "red \"paint\"\xff",
                                                 .description = "[]",
                                                 .license = "MIT",
                                                 .copyright = "2024 we",
                                                 .author = "me",
                                                 .sources = "measured"}));
  EXPECT_EQ(known["name"], "red \"paint\"\xEF\xBF\xBD");
  EXPECT_EQ(known["description"], "[]");
  EXPECT_EQ(known["license"], "MIT");
  EXPECT_THAT(known["copyrights"], ElementsAre("2024 we"));
  EXPECT_EQ(known["sources"], "measured");
  table.name = "";
  EXPECT_EQ(metadata_of(written(table))["name"], "paint");
  table.provenance = {};
  EXPECT_EQ(metadata_of(written(table))["name"], "unnamed");
}

TEST(OpenMaterialWriter, TheIdentityIsThatOfTheNumbers) {
  const SampleTable table = random_table(20);
  const auto uuid = [](const SampleTable& t) { return metadata_of(written(t))["uuid"]; };
  EXPECT_EQ(written(table).text, written(table).text);
  const std::regex shape("[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}");
  EXPECT_TRUE(std::regex_match(uuid(table).get<std::string>(), shape));
  SampleTable other = table;
  other.values[0][7] = std::nextafter(other.values[0][7], 1);
  EXPECT_NE(uuid(other), uuid(table));
  other = table;
  other.channels[1] = "526nm";
  EXPECT_NE(uuid(other), uuid(table));
}

/// What the standard's own schema says; it is far from this project's schemas.
std::string complaint(const std::string& schema, const std::string& text) {
  const auto here = std::filesystem::path(GONIO_SOURCE_DIR) / "schema";
  return Schema(std::filesystem::relative(schema, here).string()).complaint(json::parse(text));
}

TEST(OpenMaterialWriter, HoldsTheStandardsOwnSchema) {
  GONIO_REAL_DATA_OR_SKIP(schema, "openmaterial/material_brdf_schema.json");
  SampleTable table = random_table(200);
  table.values[0][3] = -1;
  // Beyond the standard's largest zenith, which is less than pi/2, and its largest azimuth.
  table.wi.set(5, brdf::direction_from_radians(1.5707962, 0));
  table.wo.set(6, brdf::direction_from_radians(0.5, -1e-7));
  table.wo.set(7, brdf::direction_from_radians(0.5, -1e-17));
  EXPECT_EQ(complaint(schema, written(table).text), "");
  SampleTable grey = random_table(5);
  grey.channels = {"grey"};
  grey.values.resize(1);
  EXPECT_EQ(complaint(schema, written(grey).text), "");
  // The schema is one that refuses.
  json broken = json::parse(written(grey).text);
  broken["brdf"]["lookupTable"][0][4] = -1;
  EXPECT_NE(complaint(schema, broken.dump()), "");
}

TEST(OpenMaterialWriter, ThePublishedExamplesPassThroughUnchanged) {
  for (const std::string example : {"camera", "lidar"}) {
    GONIO_REAL_DATA_OR_SKIP(path, "openmaterial/example_material_" + example + "_brdf.xompt");
    const std::string content = content_of(path);
    SampleTable table = table::read_openmaterial(content, path, {});
    const json before = json::parse(content)["brdf"];
    const json after = json::parse(written(table).text)["brdf"];
    EXPECT_EQ(before["wavelengths"], after["wavelengths"]);
    std::size_t k = 0;
    for (const json& row : before["lookupTable"]) {
      if (row[1] >= 1.570796 || row[2] >= 1.570796) continue;
      const json& other = after["lookupTable"][k++];
      for (std::size_t column = 0; column < 5; ++column) {
        ASSERT_NEAR(row[column].get<double>(), other[column].get<double>(),
                    column == 4 ? 0 : 1e-15);
      }
    }
    EXPECT_EQ(k, after["lookupTable"].size());
  }
}

}  // namespace
}  // namespace gonio::tests
