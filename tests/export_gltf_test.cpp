// glTF 2.0: the file's numbers, evaluated as the specification writes its formulas, against the
// material; the structure of the asset; and Khronos' own validator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "export/account.h"
#include "export/gltf.h"
#include "export/gltf_lobe.h"
#include "export/target.h"
#include "tests/exported_material.h"
#include "tests/run_gonio.h"

namespace gonio::exports {
namespace {

using brdf::Direction;
using nlohmann::json;
using std::numbers::pi;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using tests::Rgb;
using tests::rgb_material_of;

material::Material paint() {
  return rgb_material_of(
      "ward-gmd", {{"rho_d", {0.4, 0.2, 0.1}}, {"rho_s", {0.04, 0.05, 0.06}}, {"alpha", {0.2}}});
}

material::Material brushed_metal(double alpha_x, double alpha_y) {
  return rgb_material_of("ward-gmd-aniso", {{"rho_d", {0.1, 0.08, 0.04}},
                                            {"rho_s", {0.33, 0.3, 0.2}},
                                            {"alpha_x", {alpha_x}},
                                            {"alpha_y", {alpha_y}}});
}

material::Material coloured_lacquer() {
  return rgb_material_of("ashikhmin-shirley",
                         {{"Rd", {0.4, 0.3, 0.2}}, {"Rs", {0.04, 0.04, 0.04}}, {"n", {60}}});
}

json material_of(const Exported& exported) {
  return json::parse(exported.files.at(0).text).at("materials").at(0);
}

double mix(double a, double b, double t) { return a * (1 - t) + b * t; }

/// Appendix B of the specification with the three extensions, evaluated from a material's JSON with
/// the specification's names in full; T, B: tangent and bitangent turned by anisotropyRotation.
Rgb specified_f_r(const json& material, const Direction<double>& light,
                  const Direction<double>& view) {
  const json& pbr = material.at("pbrMetallicRoughness");
  const json& extensions = material.at("extensions");
  const json& specular = extensions.at("KHR_materials_specular");
  const json anisotropy = extensions.value("KHR_materials_anisotropy", json::object());
  const double rotation = anisotropy.value("anisotropyRotation", 0.0);
  const double strength = anisotropy.value("anisotropyStrength", 0.0);
  const double ab = std::pow(pbr.at("roughnessFactor").get<double>(), 2);
  const double at = mix(ab, 1, strength * strength);
  const double length = std::hypot(light.x + view.x, light.y + view.y, light.z + view.z);
  const Direction<double> half{(light.x + view.x) / length, (light.y + view.y) / length,
                               (light.z + view.z) / length};
  const auto t_dot = [&](const Direction<double>& w) {
    return w.x * std::cos(rotation) + w.y * std::sin(rotation);
  };
  const auto b_dot = [&](const Direction<double>& w) {
    return w.y * std::cos(rotation) - w.x * std::sin(rotation);
  };
  const double a2 = at * ab;
  const double w2 = a2 / (std::pow(ab * t_dot(half), 2) + std::pow(at * b_dot(half), 2) +
                          std::pow(a2 * half.z, 2));
  const double distribution = a2 * w2 * w2 / pi;
  const double ggx_v = light.z * std::hypot(at * t_dot(view), ab * b_dot(view), view.z);
  const double ggx_l = view.z * std::hypot(at * t_dot(light), ab * b_dot(light), light.z);
  const double specular_brdf = distribution * 0.5 / (ggx_v + ggx_l);
  const double v_dot_h = view.x * half.x + view.y * half.y + view.z * half.z;
  const double fresnel_w = std::pow(1 - std::abs(v_dot_h), 5);
  const double ior = extensions.at("KHR_materials_ior").at("ior");
  const double weight = specular.at("specularFactor");
  Rgb fresnel{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double colour = specular.at("specularColorFactor").at(c);
    const double f0 = std::min(std::pow((1 - ior) / (1 + ior), 2) * colour, 1.0);
    fresnel[c] = weight * mix(f0, 1, fresnel_w);
  }
  const double most = *std::max_element(fresnel.begin(), fresnel.end());
  const double metallic = pbr.at("metallicFactor");
  Rgb f_r{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double base = pbr.at("baseColorFactor").at(c);
    const double dielectric = fresnel[c] * specular_brdf + (1 - most) * base / pi;
    const double metal = specular_brdf * mix(base, 1, fresnel_w);
    f_r[c] = mix(dielectric, metal, metallic);
  }
  return f_r;
}

void expect_stated_loss(const material::Material& material, bool anisotropic) {
  const Exported exported = to_gltf(material);
  const json written = material_of(exported);
  const double plain = tests::plain_rms_loss(
      material, [&](const auto& wi, const auto& wo) { return specified_f_r(written, wi, wo); },
      anisotropic);
  // The sums over the fit's directions are good to about 1 % of the loss.
  EXPECT_NEAR(plain, exported.loss.rms, 0.02 * exported.loss.rms);
  const json& loss = written.at("extras").at("gonio").at("loss");
  EXPECT_EQ(loss.at("rms").get<double>(), exported.loss.rms);
  EXPECT_EQ(loss.at("peak").get<double>(), exported.loss.peak);
  EXPECT_EQ(loss.at("albedo").get<double>(), exported.loss.albedo);
}

TEST(ExportGltf, LosesWhatItSays) {
  expect_stated_loss(paint(), false);
  expect_stated_loss(coloured_lacquer(), false);
}

TEST(ExportGltf, LosesWhatItSaysAlongATangent) {
  expect_stated_loss(brushed_metal(0.1, 0.3), true);
}

// A Lambertian dielectric without highlight is one of glTF's materials.
TEST(ExportGltf, OfALambertianIsExact) {
  const Exported exported = to_gltf(rgb_material_of("lambert", {{"rho_d", {0.4, 0.2, 0.1}}}));
  EXPECT_LT(exported.loss.rms, 1e-6);
}

TEST(ExportGltf, TurnsTheRougherDirectionIntoTheTangent) {
  const auto rotation = [](const material::Material& material) {
    return material_of(to_gltf(material))
        .at("extensions")
        .at("KHR_materials_anisotropy")
        .at("anisotropyRotation")
        .get<double>();
  };
  EXPECT_NEAR(rotation(brushed_metal(0.3, 0.1)), 0, 1e-9);
  EXPECT_NEAR(rotation(brushed_metal(0.1, 0.3)), pi / 2, 1e-9);
  auto turned = brushed_metal(0.3, 0.1);
  turned.parameters.push_back({.name = "psi", .value = {0.5}, .stddev = {}, .interval95 = {}});
  EXPECT_NEAR(rotation(turned), 0.5, 1e-9);
}

TEST(ExportGltf, KeepsEveryNumberInItsRange) {
  for (const auto& material : {paint(), brushed_metal(0.1, 0.3), coloured_lacquer()}) {
    const json written = material_of(to_gltf(material));
    const json& pbr = written.at("pbrMetallicRoughness");
    const json& extensions = written.at("extensions");
    const auto expect_share = [](double value) {
      EXPECT_GE(value, 0);
      EXPECT_LE(value, 1);
    };
    for (const double value : pbr.at("baseColorFactor")) expect_share(value);
    EXPECT_EQ(pbr.at("baseColorFactor").size(), 4);
    EXPECT_EQ(pbr.at("baseColorFactor").at(3), 1);  // opaque
    expect_share(pbr.at("metallicFactor"));
    expect_share(pbr.at("roughnessFactor"));
    expect_share(extensions.at("KHR_materials_specular").at("specularFactor"));
    for (const double value : extensions.at("KHR_materials_specular").at("specularColorFactor")) {
      EXPECT_GE(value, 0);
    }
    EXPECT_GE(extensions.at("KHR_materials_ior").at("ior").get<double>(), 1);
    EXPECT_LE(extensions.at("KHR_materials_ior").at("ior").get<double>(), 2.5);
  }
}

TEST(ExportGltf, IsAnAssetThatNamesItsExtensionsAndItsOrigin) {
  const auto material = brushed_metal(0.1, 0.3);
  const Exported exported = to_gltf(material);
  const json asset = json::parse(exported.files.at(0).text);
  EXPECT_EQ(asset.at("asset").at("version"), "2.0");
  EXPECT_THAT(
      asset.at("extensionsUsed").get<std::vector<std::string>>(),
      ElementsAre("KHR_materials_ior", "KHR_materials_specular", "KHR_materials_anisotropy"));
  const json& written = asset.at("materials").at(0);
  EXPECT_EQ(written.at("name"), "test paint");
  const json& origin = written.at("extras").at("gonio");
  EXPECT_EQ(origin.at("model"), "lambert+ward-gmd-aniso");
  EXPECT_EQ(origin.at("parameters").at("alpha_x").at("value"), 0.1);
  EXPECT_EQ(origin.at("parameters").at("rho_d").at("value"), (std::vector{0.1, 0.08, 0.04}));
  EXPECT_THAT(origin.at("account").get<std::vector<std::string>>(),
              Contains("loss of reflected radiance: " + loss_text(exported.loss)));
  const json plain = json::parse(to_gltf(paint()).files.at(0).text);
  EXPECT_THAT(plain.at("extensionsUsed").get<std::vector<std::string>>(),
              Not(Contains("KHR_materials_anisotropy")));
}

TEST(ExportGltf, SharesOneColourAmongTheChannelsOfAGreyMaterial) {
  auto grey = coloured_lacquer();
  grey.channels = {"L"};
  grey.parameters[0].value = {0.3};
  grey.parameters[1].value = {0.05};
  const json written = material_of(to_gltf(grey));
  for (const json* colour :
       {&written.at("pbrMetallicRoughness").at("baseColorFactor"),
        &written.at("extensions").at("KHR_materials_specular").at("specularColorFactor")}) {
    EXPECT_NEAR(colour->at(0), colour->at(1), 1e-9);
    EXPECT_NEAR(colour->at(0), colour->at(2), 1e-9);
  }
}

/// The exit status of `node validate.mjs FILE`, and what it printed.
std::pair<int, std::string> validated(const std::string& folder, const std::string& path) {
  const std::string command = "node '" + folder + "/validate.mjs' '" + path + "' 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += char(c);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

TEST(ExportGltf, SatisfiesKhronosValidator) {
  const std::string folder = GONIO_SOURCE_DIR "/tests/gltf_validator";
  if (!std::filesystem::exists(folder + "/node_modules/gltf-validator")) {
    GTEST_SKIP() << "Khronos' glTF validator not found: run 'npm install' in " << folder;
  }
  const tests::TemporaryFolder scratch;
  auto named = paint();
  named.name = "quotes \" \\ and \xc3\xa9\n";
  for (const auto& material : {named, brushed_metal(0.1, 0.3), coloured_lacquer()}) {
    const std::string path = scratch.write("material.gltf", to_gltf(material).files.at(0).text);
    EXPECT_EQ(validated(folder, path), std::pair(0, std::string()));
  }
  // What the validator would say of a wrong file.
  json wrong = json::parse(to_gltf(paint()).files.at(0).text);
  wrong["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 2;
  const auto [status, output] = validated(folder, scratch.write("wrong.gltf", wrong.dump()));
  EXPECT_EQ(status, 1);
  EXPECT_THAT(output, HasSubstr("roughnessFactor"));
}

TEST(Targets, OfAMistypedNameSuggestTheOneThatIsMeant) {
  EXPECT_EQ(target_named("gltf").name, "gltf");
  try {
    target_named("radiancee");
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("unknown target 'radiancee', did you mean 'radiance'?"));
    for (const Target& target : all_targets()) EXPECT_THAT(error.what(), HasSubstr(target.name));
  }
}

}  // namespace
}  // namespace gonio::exports
