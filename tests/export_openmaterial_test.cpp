// OpenMATERIAL 3D: the files are what the standard's schemas ask for, their numbers are the
// material's, and the loss that they state is the one a reader has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "export/openmaterial.h"
#include "export/relative_azimuth_table.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/channel_wavelength.h"
#include "table/file_error.h"
#include "table/formats/openmaterial.h"
#include "table/uuid.h"
#include "tests/json_schema.h"
#include "tests/real_data.h"

namespace gonio::exports {
namespace {

using nlohmann::json;
using table::url_uuid;
using table::wavelength_of_channel;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double pi = std::numbers::pi;
/// pi as written, and half of the last digit.
constexpr double last_unmirrored = 3.1415935;

/// A material of that model; amplitudes a little different in each channel.
material::Material material_of(const std::string& model, const std::vector<std::string>& channels,
                               const std::map<std::string, double>& values) {
  const brdf::Model parsed(model);
  material::Material m;
  m.name = "test paint";
  m.model = parsed.name();
  m.channels = channels;
  for (const brdf::OrderedParameter& p : brdf::ordered_parameters(parsed)) {
    material::ParameterValue value;
    value.name = p.parameter->name;
    const double first = values.at(value.name);
    for (std::size_t c = 0; c < (p.per_channel ? channels.size() : 1); ++c) {
      value.value.push_back(first / (1 + 0.1 * static_cast<double>(c)));
    }
    m.parameters.push_back(value);
  }
  return m;
}

material::Material glossy_paint() {
  return material_of("oren-nayar+ward-gmd", {"R", "G", "B"},
                     {{"rho_d", 0.3}, {"sigma", 0.4}, {"rho_s", 0.1}, {"alpha", 0.12}});
}

material::Material brushed_metal() {
  return material_of("ward-aniso", {"G", "R", "B"},
                     {{"rho_d", 0.1}, {"rho_s", 0.33}, {"alpha_x", 0.05}, {"alpha_y", 0.16}});
}

/// One row of the look-up table: wavelength, zeniths, azimuth, f_r.
using Row = std::array<double, 5>;

std::vector<Row> rows_of(const Exported& exported) {
  std::vector<Row> rows;
  const json table = json::parse(exported.files.at(1).text);
  for (const json& row : table["brdf"]["lookupTable"]) {
    rows.push_back({row[0].is_null() ? 0.0 : row[0].get<double>(), row[1].get<double>(),
                    row[2].get<double>(), row[3].get<double>(), row[4].get<double>()});
  }
  return rows;
}

double f_r(const brdf::BoundModel& model, std::size_t channel, double theta_i, double phi_i,
           double theta_o, double phi_o) {
  std::vector<double> values(model.channel_count());
  model.f_r(brdf::direction_from_radians(theta_i, phi_i),
            brdf::direction_from_radians(theta_o, phi_o), values);
  return values[channel];
}

std::string refusal(const material::Material& material) {
  try {
    to_openmaterial(material, "paint");
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

/// What the standard's own schema says about a text; it is far from this project's schemas.
std::string complaint(const std::string& schema, const std::string& text) {
  const auto here = std::filesystem::path(GONIO_SOURCE_DIR) / "schema";
  return tests::Schema(std::filesystem::relative(schema, here).string())
      .complaint(json::parse(text));
}

TEST(OpenMaterial, HoldsTheStandardsOwnSchemas) {
  GONIO_REAL_DATA_OR_SKIP(material_schema, "openmaterial/material_schema.json");
  GONIO_REAL_DATA_OR_SKIP(brdf_schema, "openmaterial/material_brdf_schema.json");
  const material::Material one_channel =
      material_of("blinn-phong", {"grey"}, {{"rho_d", 0.3}, {"ks", 0.5}, {"exponent", 40}});
  for (const material::Material& material : {glossy_paint(), brushed_metal(), one_channel}) {
    const Exported exported = to_openmaterial(material, "paint");
    ASSERT_EQ(exported.files.size(), 2U);
    EXPECT_EQ(complaint(material_schema, exported.files[0].text), "");
    EXPECT_EQ(complaint(brdf_schema, exported.files[1].text), "");
    // The schema is one that refuses.
    json without_uuid = json::parse(exported.files[0].text);
    without_uuid["metadata"].erase("uuid");
    EXPECT_NE(complaint(material_schema, without_uuid.dump()), "");
  }
}

TEST(OpenMaterial, FollowsTheCheckerRulesThatNoSchemaStates) {
  const Exported exported = to_openmaterial(glossy_paint(), "my paint");
  // asam.net:xom:1.0.0:general.schema_references: on the second line.
  EXPECT_THAT(exported.files[0].text,
              StartsWith("{\n  \"$schema\": \"https://raw.githubusercontent.com/asam-ev/"
                         "OpenMATERIAL-3D/refs/tags/v1.0.0/schemas/material_schema.json\","));
  EXPECT_THAT(exported.files[1].text, HasSubstr("/v1.0.0/schemas/material_brdf_schema.json\","));
  // ..general.uris_exist: the table under the name that it is to be written with.
  EXPECT_EQ(exported.files[1].suffix, "_brdf.xompt");
  const json material = json::parse(exported.files[0].text);
  EXPECT_EQ(material["materialProperties"]["brdfUris"], json::array({"my paint_brdf.xompt"}));
  // ..xompt.tables_sorted_correctly; no row stands twice either.
  const std::vector<Row> rows = rows_of(exported);
  const auto same_place = [](const Row& a, const Row& b) {
    return std::equal(a.begin(), a.begin() + 4, b.begin());
  };
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end(), same_place), rows.end());
}

TEST(OpenMaterial, HoldsTheMaterialsValuesAtTheAnglesOfItsRows) {
  const material::Material material = glossy_paint();
  const brdf::BoundModel model = material::bind(material);
  const Exported exported = to_openmaterial(material, "paint");
  // Dominant wavelengths of the primaries of sRGB, shortest first: B, G, R.
  const std::map<double, std::size_t> channel_of{{464.3e-9, 2}, {549.1e-9, 1}, {611.4e-9, 0}};
  EXPECT_THAT(json::parse(exported.files[1].text)["brdf"]["wavelengths"].get<std::vector<double>>(),
              ElementsAre(4.643e-07, 5.491e-07, 6.114e-07));
  const std::vector<Row> rows = rows_of(exported);
  EXPECT_LE(rows.size(), 3 * 40000U);
  EXPECT_GE(rows.size(), 3 * 10000U);
  for (const Row& row : rows) {
    const auto nearest = channel_of.lower_bound(row[0] * (1 - 1e-12));
    ASSERT_NE(nearest, channel_of.end());
    const double value = f_r(model, nearest->second, row[1], 0, row[2], row[3]);
    // 12 digits; beyond pi the value of the mirrored azimuth, which is 1e-6 rad off at most: at
    // grazing angles, where the lobe is 0.01 rad wide in azimuth, some 1e-4 of its flank.
    ASSERT_NEAR(row[4], value, value * (row[3] < last_unmirrored ? 1e-11 : 1e-3))
        << row[1] << " " << row[2];
  }
}

/// Linear interpolation of the rows of one wavelength, written apart from the exporter's: through
/// nested maps.
class RowsReader {
 public:
  explicit RowsReader(const std::vector<Row>& rows, double wavelength) {
    for (const Row& row : rows) {
      if (std::abs(row[0] - wavelength) < 1e-12) nodes_[row[1]][row[2]][row[3]] = row[4];
    }
  }
  double f_r(double theta_i, double theta_o, double phi) const {
    return at(nodes_, theta_i, [&](const auto& exits) {
      return at(exits, theta_o, [&](const auto& azimuths) {
        return at(azimuths, phi, [](double value) { return value; });
      });
    });
  }

 private:
  template <class Nodes, class Inner>
  static double at(const Nodes& nodes, double place, const Inner& inner) {
    const auto above = nodes.lower_bound(place);
    if (above == nodes.begin()) return inner(above->second);
    const auto below = std::prev(above);
    if (above == nodes.end()) return inner(below->second);
    const double share = (place - below->first) / (above->first - below->first);
    return (1 - share) * inner(below->second) + share * inner(above->second);
  }

  std::map<double, std::map<double, std::map<double, double>>> nodes_;
};

TEST(OpenMaterial, StatesTheLossThatAReaderOfTheRowsHas) {
  const material::Material material = glossy_paint();
  const brdf::BoundModel model = material::bind(material);
  const Exported exported = to_openmaterial(material, "paint");
  const RowsReader reader(rows_of(exported), 611.4e-9);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> zenith(0, 79.5 * pi / 180);
  std::normal_distribution<double> off(0, 0.1);  // about the lobe's width
  double brightest = 0;
  double worst = 0;
  for (int draw = 0; draw < 200'000; ++draw) {
    const double theta_i = zenith(generator);
    const double theta_o = std::clamp(theta_i + 2 * off(generator), 0.0, 79.5 * pi / 180);
    const double phi = pi + 3 * off(generator);
    const double value = f_r(model, 0, theta_i, 0, theta_o, phi);
    brightest = std::max(brightest, value * std::cos(theta_i));
    worst =
        std::max(worst, std::abs(reader.f_r(theta_i, theta_o, phi) - value) * std::cos(theta_i));
  }
  // The stated peak is of 30 lights midway between the table's; any light and any viewer, drawn
  // 200,000 times, may come a little worse, and must come near.
  EXPECT_LT(worst / brightest, 1.5 * exported.loss.peak);
  EXPECT_GT(worst / brightest, 0.5 * exported.loss.peak);
  // A table of 40,000 rows holds a highlight of roughness 0.12 to about 1 %.
  EXPECT_LT(exported.loss.peak, 0.02);
  EXPECT_LT(exported.loss.rms, 0.01);
  EXPECT_LT(std::abs(exported.loss.albedo), 0.005);
  const json written = json::parse(exported.files[0].text);
  EXPECT_EQ(written["materialProperties"]["customProperties"]["gonio"]["loss"]["peak"],
            exported.loss.peak);
  for (const ExportedFile& file : exported.files) {
    EXPECT_THAT(json::parse(file.text)["metadata"]["description"].get<std::string>(),
                HasSubstr("Loss of reflected radiance"));
  }
}

TEST(OpenMaterial, LosesLessWithMoreRows) {
  OpenMaterialOptions options;
  double last = 1;
  for (const std::size_t rows : {2500U, 10000U, 40000U}) {
    options.most_rows_per_wavelength = rows;
    const Exported exported = to_openmaterial(glossy_paint(), "paint", options);
    EXPECT_LE(rows_of(exported).size(), 3 * rows);
    // The error of linear interpolation in three dimensions falls as rows^(-2/3): 2.5 for four
    // times as many; incidences come in powers of two, so that not every step is as good.
    EXPECT_LT(exported.loss.rms, last / 1.5);
    last = exported.loss.rms;
  }
}

TEST(OpenMaterial, HoldsADiffuseMaterialExactly) {
  const Exported exported =
      to_openmaterial(material_of("lambert", {"R", "G", "B"}, {{"rho_d", 0.6}}), "paint");
  EXPECT_THAT(exported.fitted_as, StartsWith("exact"));
  for (const Row& row : rows_of(exported)) {
    ASSERT_LE(row[4], 0.6 / pi * (1 + 1e-11));
    ASSERT_GE(row[4], 0.6 / 1.2 / pi * (1 - 1e-11));
  }
}

TEST(OpenMaterial, IsTheMeanOverAllLightsOfAMaterialWithATangent) {
  const material::Material material = brushed_metal();
  const brdf::BoundModel model = material::bind(material);
  const Exported exported = to_openmaterial(material, "paint");
  const std::vector<Row> rows = rows_of(exported);
  constexpr int azimuths = 960;  // over the whole circle: ten times as dense as the exporter's
  for (std::size_t r = 0; r < rows.size(); r += 97) {
    const Row& row = rows[r];
    if (row[0] < 600e-9 || row[3] > last_unmirrored) continue;  // R, the second channel
    double mean = 0;
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * pi * k / azimuths;
      mean += f_r(model, 1, row[1], phi, row[2], phi + row[3]) / azimuths;
    }
    ASSERT_NEAR(row[4], mean, 1e-9 * (1 + mean)) << row[1] << " " << row[2] << " " << row[3];
  }
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("the format has no tangent")));
  // The roughness varies by 3.2 around the circle, which no isotropic table can show.
  EXPECT_GT(exported.loss.rms, 0.2);
  EXPECT_LT(exported.loss.rms, 1);
}

TEST(OpenMaterial, TakesWavelengthsFromTheNamesOfChannels) {
  EXPECT_DOUBLE_EQ(wavelength_of_channel("465nm").value(), 465e-9);
  EXPECT_DOUBLE_EQ(wavelength_of_channel("630.5 nm").value(), 630.5e-9);
  EXPECT_DOUBLE_EQ(wavelength_of_channel("g").value(), 549.1e-9);
  for (const char* name : {"", "grey", "nm", "465", "465um", "-465nm", "465nm2", "Re", "1e999nm"}) {
    EXPECT_FALSE(wavelength_of_channel(name).has_value()) << name;
  }
  const Exported infrared =
      to_openmaterial(material_of("lambert", {"940nm", "550nm"}, {{"rho_d", 0.6}}), "paint");
  const std::vector<Row> rows = rows_of(infrared);
  EXPECT_EQ(rows.front()[0], 5.5e-07);
  EXPECT_NEAR(rows.front()[4], 0.6 / 1.1 / pi, 1e-11);
  EXPECT_EQ(rows.back()[0], 9.4e-07);
  EXPECT_NEAR(rows.back()[4], 0.6 / pi, 1e-11);
}

TEST(OpenMaterial, LeavesTheWavelengthOfAGreyChannelOpen) {
  const Exported exported =
      to_openmaterial(material_of("lambert", {"grey"}, {{"rho_d", 0.6}}), "paint");
  const json table = json::parse(exported.files[1].text);
  EXPECT_THAT(table["brdf"]["wavelengths"], IsEmpty());
  EXPECT_TRUE(table["brdf"]["lookupTable"][0][0].is_null());
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("'grey' is no wavelength")));
}

TEST(OpenMaterial, RefusesChannelsThatTheTableHasNoPlaceFor) {
  const auto lambert = [](const std::vector<std::string>& channels) {
    return refusal(material_of("lambert", channels, {{"rho_d", 0.6}}));
  };
  EXPECT_THAT(lambert({"R", "gloss"}), HasSubstr("channels: found 'gloss', expected R, G and B"));
  EXPECT_THAT(lambert({"550nm", "550.0nm"}), HasSubstr("the same wavelength"));
  EXPECT_THAT(lambert({"0.5nm"}), HasSubstr("expected a wavelength from 1 nm to 17.16 mm"));
}

TEST(OpenMaterial, RefusesAHighlightTooNarrowForATable) {
  // A tenth of a degree wide: between the rows there would be nothing of it.
  EXPECT_THAT(
      refusal(material_of("ward", {"R"}, {{"rho_d", 0.1}, {"rho_s", 0.3}, {"alpha", 0.0005}})),
      HasSubstr("its highlight is too narrow for a table of"));
}

TEST(OpenMaterial, BearsTheMaterialItselfAndWhereItCameFrom) {
  material::Material material = glossy_paint();
  material.provenance = material::MaterialProvenance{.table = "/measured/by/somebody/paint.astm",
                                                     .sha256 = "abc",
                                                     .gonio = "",
                                                     .command = "gonio fit /measured/by/somebody"};
  const Exported exported = to_openmaterial(material, "paint");
  const json file = json::parse(exported.files[0].text);
  const json& own = file["materialProperties"]["customProperties"]["gonio"]["material"];
  const material::Material back = material::parse_material(own.dump(), "paint.xomp");
  for (std::size_t p = 0; p < back.parameters.size(); ++p) {
    EXPECT_EQ(back.parameters[p].value, material.parameters[p].value);
  }
  const std::string sources = json::parse(exported.files[1].text)["metadata"]["sources"];
  EXPECT_THAT(sources, HasSubstr("fitted to paint.astm (SHA-256 abc)"));
  // Where the table lies on a disk is nobody else's business.
  for (const ExportedFile& part : exported.files) {
    EXPECT_THAT(part.text, testing::Not(HasSubstr("somebody")));
  }
}

TEST(OpenMaterial, IsReadBackAsItWasTabulated) {
  const material::Material paint = glossy_paint();
  const auto grid =
      table::read_openmaterial_grid(to_openmaterial(paint, "paint").files[1].text, "paint");
  EXPECT_THAT(grid.channels, ElementsAre("464.3nm", "549.1nm", "611.4nm"));
  const brdf::BoundModel model = material::bind(paint);
  const RelativeAzimuthTable tabulated =
      tabulate(at_azimuth_zero(material::reflectance_of(model)), 3,
               OpenMaterialOptions().most_rows_per_wavelength);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto any_direction = [&] {
    return brdf::direction_from_degrees(88.9 * unit(random), 360 * unit(random));
  };
  std::vector<double> read(3);
  std::vector<double> expected(3);
  for (int i = 0; i < 2000; ++i) {
    const auto wi = any_direction();
    const auto wo = any_direction();
    grid.f_r(wi, wo, read);
    interpolate(tabulated, wi, wo, expected);
    // The other half of the circle is written to 7 digits.
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(read[2 - c], expected[c], 2e-4 * expected[c]);
  }
}

TEST(OpenMaterial, NamesTheSameMaterialTheSame) {
  const auto uuid = [](const Exported& exported, std::size_t file) {
    return json::parse(exported.files[file].text)["metadata"]["uuid"].get<std::string>();
  };
  const Exported first = to_openmaterial(glossy_paint(), "paint");
  const Exported again = to_openmaterial(glossy_paint(), "paint");
  EXPECT_EQ(first.files[0].text, again.files[0].text);
  EXPECT_EQ(first.files[1].text, again.files[1].text);
  material::Material other = glossy_paint();
  other.parameters[0].value[0] = std::nextafter(other.parameters[0].value[0], 1);
  EXPECT_NE(uuid(first, 0), uuid(to_openmaterial(other, "paint"), 0));
  EXPECT_NE(uuid(first, 0), uuid(first, 1));
  // Of version 5, of the variant of RFC 9562.
  const std::regex shape("[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}");
  EXPECT_TRUE(std::regex_match(uuid(first, 0), shape)) << uuid(first, 0);
  // As Python's uuid.uuid5(uuid.NAMESPACE_URL, ..) has them.
  EXPECT_EQ(url_uuid("https://www.rfc-editor.org/rfc/rfc9562"),
            "3349c653-56d8-5f05-8876-e348e193dc56");
  EXPECT_EQ(url_uuid(""), "1b4db7eb-4057-5ddf-91e0-36dec72071f5");
}

TEST(OpenMaterial, SaysWhatItDoesNotKnowUnlessItIsTold) {
  const auto is_about_licence = HasSubstr("the format asks for author, copyright and licence");
  EXPECT_THAT(to_openmaterial(glossy_paint(), "paint").warnings, Contains(is_about_licence));
  const OpenMaterialOptions options{
      .copyright = "2024 A. Painter", .license = "CC0-1.0", .author = "A. Painter"};
  const Exported exported = to_openmaterial(glossy_paint(), "paint", options);
  EXPECT_THAT(exported.warnings, testing::Not(Contains(is_about_licence)));
  for (const ExportedFile& file : exported.files) {
    const json metadata = json::parse(file.text)["metadata"];
    EXPECT_EQ(metadata["license"], "CC0-1.0");
    EXPECT_EQ(metadata["copyrights"], json::array({"2024 A. Painter"}));
    EXPECT_EQ(metadata["authors"], json::array({"A. Painter"}));
  }
}

TEST(RelativeAzimuthTable, IsDarkBelowTheHorizonAndHeldBeyondItsLastZenith) {
  const material::Material material = glossy_paint();
  const brdf::BoundModel model = material::bind(material);
  const auto table = tabulate(at_azimuth_zero(material::reflectance_of(model)), 3, 5000);
  std::array<double, 3> values{};
  const auto wi = brdf::direction_from_degrees(30, 40);
  interpolate(table, wi, brdf::direction_from_degrees(90.5, 10), values);
  EXPECT_THAT(values, ElementsAre(0, 0, 0));
  std::array<double, 3> last{};
  interpolate(table, wi, brdf::direction_from_degrees(89.0001, 200), last);
  interpolate(table, wi, brdf::direction_from_degrees(89.9, 200), values);
  EXPECT_EQ(values, last);
  EXPECT_GT(last[0], 0);
}

}  // namespace
}  // namespace gonio::exports
