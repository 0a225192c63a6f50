// gonio table, and the options with which every command reads one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "table/read.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"
#include "tests/small_tables.h"

namespace gonio::tests {
namespace {

using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string brass = std::string(GONIO_SOURCE_DIR) + "/data/synthetic/rolled_brass.csv";

/// The small table of a format, written into the folder.
std::string small_file(const TemporaryFolder& folder, const std::string& format) {
  std::string path;
  for (const SmallTable& small : small_tables()) {
    if (small.format != format) continue;
    const std::string written = folder.write(small.file, small.bytes);
    if (path.empty()) path = written;
  }
  return path;
}

CommandResult convert(const std::string& from, const std::string& to,
                      const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"table", "convert", from, to};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_gonio(arguments);
}

/// Equal but for roundings of the directions of 1e-15.
void expect_same(const SampleTable& a, const SampleTable& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.channels, b.channels);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(a.wi.x[i], b.wi.x[i], 1e-15);
    ASSERT_NEAR(a.wi.z[i], b.wi.z[i], 1e-15);
    ASSERT_NEAR(a.wo.x[i], b.wo.x[i], 1e-15);
    ASSERT_NEAR(a.wo.y[i], b.wo.y[i], 1e-15);
    for (std::size_t c = 0; c < a.values.size(); ++c) {
      const double x = a.values[c][i];
      const double y = b.values[c][i];
      ASSERT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << i << ": " << x << ", " << y;
    }
  }
  ASSERT_EQ(a.sigma.size(), b.sigma.size());
  for (std::size_t c = 0; c < a.sigma.size(); ++c) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const bool is_hole = std::isnan(a.sigma[c][i]) && std::isnan(b.sigma[c][i]);
      ASSERT_TRUE(is_hole || a.sigma[c][i] == b.sigma[c][i]) << i;
    }
  }
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.mask, b.mask);
}

TEST(TableConvert, CsvToExrAndBackIsTheSameText) {
  const TemporaryFolder folder;
  const CommandResult there = convert(brass, folder / "brass.exr");
  ASSERT_EQ(there.exit_status, 0) << there.err;
  EXPECT_THAT(there.out, IsEmpty());
  EXPECT_THAT(there.err, HasSubstr("brass.exr: exr, 1696 samples, 1 channel"));
  ASSERT_EQ(convert(folder / "brass.exr", folder / "back.csv").exit_status, 0);
  const SampleTable first = table::read(brass);
  expect_same(first, table::read(folder / "brass.exr"));
  expect_same(first, table::read(folder / "back.csv"));
  EXPECT_LT(content_of(folder / "brass.exr").size(), content_of(brass).size());
}

TEST(TableConvert, AFitDoesNotNoticeTheFormat) {
  const TemporaryFolder folder;
  ASSERT_EQ(convert(brass, folder / "brass.exr").exit_status, 0);
  const auto parameters = [](const std::string& path) {
    const CommandResult result = run_gonio({"fit", path, "-m", "ward-aniso", "--json"});
    return nlohmann::json::parse(result.out)["parameters"];
  };
  EXPECT_EQ(parameters(brass), parameters(folder / "brass.exr"));
}

TEST(TableConvert, EveryFormatBecomesCsvAndExr) {
  const TemporaryFolder folder;
  for (const char* const format :
       {"gonio_csv", "astm", "merl", "rgl", "zemax", "exr", "openmaterial"}) {
    const std::string path = small_file(folder, format);
    for (const char* const ending : {".csv", ".exr"}) {
      const CommandResult result = convert(path, folder / (std::string("out_") + format + ending));
      EXPECT_EQ(result.exit_status, 0) << format << ": " << result.err;
    }
    expect_same(table::read(path), table::read(folder / (std::string("out_") + format + ".exr")));
    EXPECT_EQ(run_gonio({"info", folder / (std::string("out_") + format + ".csv")}).exit_status, 0)
        << format;
  }
}

TEST(TableConvert, SaysWhatTheFormatCannotHold) {
  const TemporaryFolder folder;
  const CommandResult to_csv = convert(small_file(folder, "merl"), folder / "merl.csv");
  EXPECT_THAT(to_csv.err, HasSubstr("below the horizon, which hold no measurement, are left out"));
  const CommandResult single = convert(brass, folder / "single.exr", {"--single"});
  EXPECT_EQ(single.exit_status, 0);
  EXPECT_THAT(single.err, HasSubstr("6e-08"));
  EXPECT_LT(content_of(folder / "single.exr").size(), 60'000U);
  const CommandResult to_merl = convert(brass, folder / "brass.binary");
  EXPECT_EQ(to_merl.exit_status, 3);
  EXPECT_THAT(to_merl.err, HasSubstr("three channels"));
  EXPECT_THAT(folder.names(), testing::Not(testing::Contains("brass.binary")));
}

TEST(TableConvert, RefusesWrongUse) {
  const TemporaryFolder folder;
  const std::string path = small_file(folder, "gonio_csv");
  EXPECT_EQ(convert(path, folder / "out.dat").exit_status, 2);
  EXPECT_THAT(convert(path, folder / "out.dat").err, HasSubstr("--to"));
  EXPECT_EQ(convert(path, folder / "out.csv", {"--to", "parquet"}).exit_status, 2);
  EXPECT_EQ(convert(path, path).exit_status, 2);
  EXPECT_EQ(convert(folder / "absent.csv", folder / "out.csv").exit_status, 3);
  EXPECT_EQ(convert(path, folder / "out.dat", {"--to", "csv"}).exit_status, 0);
  EXPECT_EQ(run_gonio({"table"}).exit_status, 2);
}

TEST(TableConvert, ColoursGoWhereMerlHasThem) {
  const TemporaryFolder folder;
  const std::string path = small_file(folder, "merl");
  ASSERT_EQ(convert(path, folder / "rgb.binary").exit_status, 0);
  ASSERT_EQ(convert(path, folder / "bgr.binary", {"--channels", "B,G,R"}).exit_status, 0);
  EXPECT_TRUE(content_of(folder / "rgb.binary") == content_of(folder / "bgr.binary"));
}

TEST(TableConvert, RefusesOptionsThatTheFormatHasNoUseFor) {
  const TemporaryFolder folder;
  const std::string path = small_file(folder, "gonio_csv");
  EXPECT_EQ(convert(path, folder / "out.csv", {"--single"}).exit_status, 2);
  EXPECT_EQ(convert(path, folder / "out.exr", {"--license", "MIT"}).exit_status, 2);
  EXPECT_EQ(convert(path, "-", {"--to", "csv"}).exit_status, 2);
}

TEST(TableCrop, KeepsAnglesAndChannels) {
  const TemporaryFolder folder;
  const CommandResult result =
      run_gonio({"table", "crop", small_file(folder, "exr"), folder / "part.csv", "--max-theta",
                 "45", "--wavelengths", "400:500"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const SampleTable table = table::read(folder / "part.csv");
  EXPECT_THAT(table.channels, ElementsAre("465nm"));
  EXPECT_EQ(table.size(), 5U);
  EXPECT_EQ(
      run_gonio({"table", "crop", folder / "part.csv", folder / "none.csv", "--max-theta", "5"})
          .exit_status,
      3);
  EXPECT_EQ(run_gonio({"table", "crop", folder / "part.csv", folder / "none.csv", "--wavelengths",
                       "500:400"})
                .exit_status,
            2);
  EXPECT_EQ(
      run_gonio({"table", "crop", folder / "part.csv", folder / "none.csv", "--channels", "630nm"})
          .exit_status,
      2);
}

TEST(TableMerge, PutsTablesTogether) {
  const TemporaryFolder folder;
  const std::string path = small_file(folder, "gonio_csv");
  const CommandResult result = run_gonio({"table", "merge", path, path, "-o", folder / "both.csv"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(table::read(folder / "both.csv").size(), 2 * table::read(path).size());
  EXPECT_EQ(run_gonio({"table", "merge", path, brass, "-o", folder / "no.csv"}).exit_status, 3);
}

TEST(TableSample, GivesARowPerDirectionInOrder) {
  const TemporaryFolder folder;
  const std::string directions = folder.write(
      "at.csv",
      "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n20.50,0,30,180\n0,0,10,5\n20,0,90,0\n");
  const CommandResult result =
      run_gonio({"table", "sample", small_file(folder, "rgl"), "--at", directions});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("# quantity: brdf\n# angles: deg\n"),
                                HasSubstr("theta_i,phi_i,theta_o,phi_o,R,G,B\n20.50,0,30,180,"),
                                HasSubstr("\n0,0,10,5,"), HasSubstr("\n20,0,90,0,,,\n")));
  EXPECT_THAT(result.err, HasSubstr("1 of 3 directions lie outside"));
  const CommandResult scattered = run_gonio({"table", "sample", brass, "--at", directions});
  EXPECT_EQ(scattered.exit_status, 3);
  EXPECT_THAT(scattered.err, HasSubstr("stand on no grid"));
}

TEST(TableSample, GivesWhatTheReferenceLoaderGave) {
  GONIO_REAL_DATA_OR_SKIP(table_path, "rgl/paper_white_rgb.bsdf");
  GONIO_REAL_DATA_OR_SKIP(reference_path, "rgl/paper_white_rgb.csv");
  const TemporaryFolder folder;
  const CommandResult result = run_gonio(
      {"table", "sample", table_path, "--at", reference_path, "-o", folder / "sampled.csv"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const SampleTable sampled = table::read(folder / "sampled.csv");
  table::ReadOptions options;
  options.quantity = table::Quantity::brdf;
  const SampleTable reference = table::read(reference_path, options);
  ASSERT_EQ(sampled.size(), reference.size());
  double peak = 0;
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      peak = std::max(peak, reference.values[c][i]);
      worst = std::max(worst, std::abs(sampled.values[c][i] - reference.values[c][i]));
    }
  }
  EXPECT_LE(worst, 1e-4 * peak);
}

TEST(TableOptions, AForeignCsvIsFittedWithThem) {
  const TemporaryFolder folder;
  std::string text = content_of(brass);
  text = text.substr(text.find("theta_i"));  // without the declaration
  const std::string path = folder.write("foreign.csv", text);
  const CommandResult refused = run_gonio({"fit", path, "-m", "ward-aniso"});
  EXPECT_EQ(refused.exit_status, 3);
  EXPECT_THAT(refused.err, HasSubstr("--quantity"));
  const CommandResult result = run_gonio(
      {"fit", path, "-m", "ward-aniso", "--quantity", "brdf", "--angles", "deg", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const double alpha_x =
      nlohmann::json::parse(result.out)["parameters"]["alpha_x"]["value"].get<double>();
  EXPECT_NEAR(alpha_x, 0.05, 5e-4);
}

TEST(TableOptions, MasksAndChannelsAreSaidOnEveryCommand) {
  const TemporaryFolder folder;
  const CommandResult info =
      run_gonio({"info", brass, "--mask-retro", "12", "--mask-wo", "40,90,8", "--json"});
  ASSERT_EQ(info.exit_status, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_GT(json["masked"]["retro"].get<int>(), 0);
  EXPECT_GT(json["masked"]["blind-spot"].get<int>(), 0);
  EXPECT_EQ(run_gonio({"info", brass, "--mask-retro", "-1"}).exit_status, 2);
  EXPECT_EQ(run_gonio({"info", brass, "--mask-wo", "40,90"}).exit_status, 2);
  EXPECT_EQ(run_gonio({"info", brass, "--channels", "R"}).exit_status, 2);
  EXPECT_EQ(run_gonio({"info", brass, "--quantity", "radiance"}).exit_status, 2);
  EXPECT_EQ(run_gonio({"info", brass, "--material", "1"}).exit_status, 3);
}

TEST(Info, DrawsTheCoverageWithALegend) {
  const CommandResult info = run_gonio({"info", brass, "--mask-retro", "12"});
  EXPECT_THAT(info.out, AllOf(HasSubstr("theta_o 0"), HasSubstr("#############"),
                              HasSubstr("r masked as retro")));
}

TEST(Info, WarnsOfAReflectanceFactorTakenForABrdf) {
  const TemporaryFolder folder;
  const auto white = [&](const std::string& name, double value) {
    std::string text =
        "# gonio-table 1\n# quantity: brdf\n# angles: deg\n"
        "theta_i,phi_i,theta_o,phi_o,R\n";
    for (int theta = 0; theta < 85; theta += 5) {
      for (int phi = 0; phi < 360; phi += 15) {
        text += fmt::format("20,0,{},{},{}\n", theta, phi, value);
      }
    }
    return folder.write(name, text);
  };
  EXPECT_THAT(run_gonio({"info", white("factor.csv", 0.9)}).out,
              HasSubstr("reflects 2.83 times the light"));
  EXPECT_THAT(run_gonio({"info", white("small.csv", 1e-5)}).out, HasSubstr("implausibly small"));
  EXPECT_THAT(run_gonio({"info", white("right.csv", 0.9 / 3.14159)}).out,
              testing::Not(HasSubstr("warnings")));
  // One viewer: no hemisphere to take an albedo from.
  const std::string header =
      "# gonio-table 1\n# quantity: brdf\n# angles: deg\ntheta_i,phi_i,theta_o,phi_o,R\n";
  EXPECT_THAT(run_gonio({"info", folder.write("few.csv", header + "20,0,0,0,1\n30,0,0,0,1\n")}).out,
              HasSubstr("implausibly large"));
  EXPECT_THAT(
      run_gonio({"info", folder.write("dark.csv", header + "20,0,0,0,1e-5\n30,0,0,0,2e-5\n")}).out,
      HasSubstr("implausibly small"));
}

}  // namespace
}  // namespace gonio::tests
