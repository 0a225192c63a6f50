// `gonio export` as users meet it: files, stdout, the loss that is told, and bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "export/target.h"
#include "material/material_json.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view brass = R"({"format": "gonio-material", "version": 1,
  "name": "rolled brass", "model": "ward-aniso", "channels": ["R", "G", "B"],
  "parameters": {"rho_d": {"value": [0.1, 0.08, 0.0123456789012345678]},
  "rho_s": {"value": [0.33, 0.3, 0.2]}, "alpha_x": {"value": 0.05, "stddev": 1e-4},
  "alpha_y": {"value": 0.16}}})";

TEST(ExportCommand, WritesEveryTargetAndSaysWhatWasLost) {
  const TemporaryFolder folder;
  // Without a tangent: that takes a quarter of the time.
  const std::string material =
      folder.write("paper.json", R"({"format": "gonio-material", "version": 1, "name": "paper",
      "model": "ward", "channels": ["R", "G", "B"],
      "parameters": {"rho_d": {"value": [0.3, 0.2, 0.1]}, "rho_s": {"value": [0.08, 0.08, 0.08]},
      "alpha": {"value": 0.082}}})");
  for (const exports::Target& target : exports::all_targets()) {
    const std::string path = folder / ("out" + target.ending);
    const auto result = run_gonio({"export", material, "--to", target.name, "-o", path, "--json"});
    ASSERT_EQ(result.exit_status, 0) << target.name << ": " << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["target"], target.name);
    EXPECT_EQ(json["files"][0], path);
    for (const std::string file : json["files"]) EXPECT_FALSE(content_of(file).empty()) << file;
    // Ward's own normalisation is in none of the renderers: only the model itself loses nothing.
    const bool is_exact = target.name == "json" || target.name == "hlsl" || target.name == "glsl";
    EXPECT_EQ(json["loss"]["rms"] == 0, is_exact) << target.name;
    EXPECT_EQ(std::string(json["stand_in"]).starts_with("exact"), is_exact) << target.name;
    const auto text = run_gonio({"export", material, "--to", target.name, "-o", path});
    EXPECT_THAT(text.out, AllOf(HasSubstr(path), HasSubstr("stand-in:"), HasSubstr("loss")));
  }
}

TEST(ExportCommand, WritesTheMaterialItselfToTheLastBit) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const std::string path = folder / "again.json";
  ASSERT_EQ(run_gonio({"export", material, "--to", "json", "-o", path}).exit_status, 0);
  EXPECT_EQ(to_json(material::read_material(path)), to_json(material::read_material(material)));
  EXPECT_EQ(material::read_material(path).parameters[0].value[2], 0.0123456789012345678);
}

TEST(ExportCommand, PrintsTheFileToStdoutAndTheLossToStderr) {
  const TemporaryFolder folder;
  const auto result = run_gonio({"export", folder.write("brass.json", brass), "--to", "hlsl"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("float3 brdf_rolled_brass(float3 wi, float3 wo)"),
                                HasSubstr("material: rolled brass"), HasSubstr("0.16"),
                                HasSubstr("0.012345678901234568")));
  EXPECT_THAT(result.err, AllOf(HasSubstr("stand-in: exact"), HasSubstr("loss")));
}

TEST(ExportCommand, GivesAShaderItsWavelengthsAsRedGreenBlue) {
  const TemporaryFolder folder;
  const std::string paint =
      folder.write("paint.json", R"({"format": "gonio-material", "version": 1, "model": "lambert",
      "name": "paint", "channels": ["465nm", "525nm", "630nm"],
      "parameters": {"rho_d": {"value": [0.1, 0.2, 0.3]}}})");
  const auto result = run_gonio({"export", paint, "--to", "glsl"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("vec3(0.3, 0.2, 0.1)"), HasSubstr("channels 630nm, 525nm, 465nm")));
}

TEST(ExportCommand, WarnsOfWhatTheLossDoesNotSay) {
  const TemporaryFolder folder;
  const std::string stretched = folder.write(
      "thin.json", R"({"format": "gonio-material", "version": 1, "model": "ward-gmd-aniso",
      "channels": ["850nm", "940nm", "1550nm"], "parameters": {"rho_d": {"value": [0.1, 0.1, 0.1]},
      "rho_s": {"value": [0.1, 0.1, 0.1]}, "alpha_x": {"value": 0.02}, "alpha_y": {"value": 0.3}}})");
  const auto result = run_gonio({"export", stretched, "--to", "radiance"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("15 times as wide"), HasSubstr("not all wavelengths"),
                                HasSubstr("channels 850nm, 940nm, 1550nm")));
}

TEST(ExportCommand, NamesTheSecondFileOfATargetAfterTheFirst) {
  const TemporaryFolder folder;
  const TemporaryFolder out;
  const auto result = run_gonio({"export", folder.write("brass.json", brass), "--to",
                                 "openmaterial", "-o", out / "metal.xomp"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(out.names(), testing::UnorderedElementsAre("metal.xomp", "metal_brdf.xompt"));
  EXPECT_THAT(content_of(out / "metal.xomp"), HasSubstr("metal_brdf.xompt"));
  EXPECT_THAT(result.out, HasSubstr("warning:"));
}

TEST(ExportCommand, RefusesWrongUsageAndUnusableInputInOneLine) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const auto is_one_line = [](const std::string& text) {
    return text.find('\n') == text.size() - 1;
  };
  const auto unknown = run_gonio({"export", material, "--to", "radianze"});
  EXPECT_EQ(unknown.exit_status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'radiance'?"));
  EXPECT_TRUE(is_one_line(unknown.err));

  const auto two_files = run_gonio({"export", material, "--to", "openmaterial"});
  EXPECT_EQ(two_files.exit_status, 2);
  EXPECT_THAT(two_files.err, HasSubstr("-o FILE is missing"));
  EXPECT_EQ(two_files.out, "");

  std::string newer(brass);
  newer.replace(newer.find("\"version\": 1"), 12, "\"version\": 2");
  const auto version = run_gonio({"export", folder.write("newer.json", newer), "--to", "json"});
  EXPECT_EQ(version.exit_status, 3);
  EXPECT_THAT(version.err, HasSubstr("newer"));
  EXPECT_TRUE(is_one_line(version.err));

  const std::string two_channels =
      folder.write("two.json", R"({"format": "gonio-material", "version": 1, "model": "lambert",
      "channels": ["A", "B"], "parameters": {"rho_d": {"value": [0.1, 0.2]}}})");
  const auto channels = run_gonio({"export", two_channels, "--to", "gltf"});
  EXPECT_EQ(channels.exit_status, 3);
  EXPECT_TRUE(is_one_line(channels.err)) << channels.err;
  EXPECT_EQ(run_gonio({"export", two_channels, "--to", "glsl"}).exit_status, 0);

  const auto overwriting = run_gonio({"export", material, "--to", "gltf", "-o", material});
  EXPECT_EQ(overwriting.exit_status, 2);
  EXPECT_EQ(content_of(material), brass);

  const std::string huge =
      folder.write("huge.json", R"({"format": "gonio-material", "version": 1, "model": "ward",
      "channels": ["Y"], "parameters": {"rho_d": {"value": [0.1]}, "rho_s": {"value": [1e300]},
      "alpha": {"value": 0.1}}})");
  const auto bright = run_gonio({"export", huge, "--to", "gltf"});
  EXPECT_EQ(bright.exit_status, 3);
  EXPECT_THAT(bright.err, HasSubstr("no renderer shows"));

  const auto nowhere = run_gonio({"export", material, "--to", "json", "-o", "/nowhere/x.json"});
  EXPECT_EQ(nowhere.exit_status, 3);
  EXPECT_THAT(nowhere.err, HasSubstr("/nowhere/x.json"));
}

/// Bakes a table as a user would; its path.
std::string baked(std::vector<std::string> arguments, const std::string& path) {
  arguments.insert(arguments.begin(), {"lut", "bake"});
  arguments.insert(arguments.end(), {"-o", path});
  EXPECT_EQ(run_gonio(arguments).exit_status, 0);
  return path;
}

TEST(ExportCommand, WritesAShaderThatReadsABakedTable) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const std::string table = baked({material}, folder / "lobe.exr");
  for (const std::string target : {"hlsl", "glsl"}) {
    const std::string path = folder / ("brass." + target);
    const auto result =
        run_gonio({"export", material, "--to", target, "--table", table, "-o", path, "--json"});
    ASSERT_EQ(result.exit_status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    // The table's own error, of weights in steps of 1/256: export_table_test.cpp bounds it.
    EXPECT_GT(json["loss"]["peak"], 0);
    EXPECT_THAT(json["stand_in"],
                testing::StartsWith("the model with ward-exponent read from lobe.exr"));
    EXPECT_THAT(content_of(path),
                AllOf(HasSubstr("4 brdf_rolled_brass_table("), HasSubstr("texture: lobe.exr: 512"),
                      HasSubstr("loss of reflected radiance: peak")));
  }
}

TEST(ExportCommand, RefusesATableThatTheShaderCannotRead) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const std::string lobe = baked({material}, folder / "lobe.exr");
  const auto expect_refusal = [&](const std::string& of, const std::string& target,
                                  const std::string& table, int status,
                                  const std::string& expected) {
    const auto result = run_gonio({"export", of, "--to", target, "--table", table});
    EXPECT_EQ(result.exit_status, status) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(expected));
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  };
  expect_refusal(material, "gltf", lobe, 2, "only glsl and hlsl read a table");
  expect_refusal(material, "hlsl", material, 3, material + ": no look-up table of gonio");
  expect_refusal(material, "hlsl", folder / "none.exr", 3, folder / "none.exr");
  expect_refusal(material, "hlsl", "", 3, "no such file");
  expect_refusal(material, "hlsl",
                 baked({"--table", "ward-lobe", "--alpha", "0.3:0.5"}, folder / "rough.exr"), 2,
                 "0.05 to 0.16");
  expect_refusal(material, "glsl",
                 baked({"--table", "blinn-phong-power", "--exponent", "30"}, folder / "power.exr"),
                 2, "expected ward-exponent or ward-lobe");
  const std::string matt =
      folder.write("matt.json", R"({"format": "gonio-material", "version": 1, "model": "lambert",
      "channels": ["Y"], "parameters": {"rho_d": {"value": [0.1]}}})");
  expect_refusal(matt, "glsl", lobe, 2, "lambert");

  const std::string before = content_of(lobe);
  const auto overwriting =
      run_gonio({"export", material, "--to", "hlsl", "--table", lobe, "-o", lobe});
  EXPECT_EQ(overwriting.exit_status, 2);
  EXPECT_EQ(content_of(lobe), before);
}

}  // namespace
}  // namespace gonio::tests
