// Exported shaders that read a look-up table: the text, as it is handed to a user, with a small
// kernel around it, run on a Vulkan device with the table's texture bound; against the same model
// in double (lut/table_model.h).
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "export/shader_text.h"
#include "lut/table_exr.h"
#include "lut/table_model.h"
#include "material/comparison.h"
#include "shader/spirv.h"
#include "tests/exported_material.h"
#include "tests/run_gonio.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

using lut::Coordinate;
using lut::Storage;
using lut::TableKind;
using shader::Language;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Ward 1992, Table 1, with a colour.
material::Material rolled_brass() {
  return rgb_material_of("ward-aniso", {{"rho_d", {0.1, 0.08, 0.05}},
                                        {"rho_s", {0.33, 0.3, 0.2}},
                                        {"alpha_x", {0.05}},
                                        {"alpha_y", {0.16}}});
}

lut::Layout layout_of(const material::Material& material, TableKind kind, Coordinate coordinate,
                      Storage storage) {
  lut::Layout layout = lut::layout_for(material::bind(material), kind);
  layout.coordinate = coordinate;
  layout.storage = storage;
  if (coordinate != Coordinate::listing) layout.reach = lut::lobe_reach(layout);
  return layout;
}

/// The table as a user gets it: baked, written, and read back from the file.
exports::ShaderTable table_from_file(const lut::Layout& layout) {
  const TemporaryFolder folder;
  return exports::read_shader_table(folder.write("lobe.exr", lut::exr_of(lut::bake(layout))));
}

exports::Exported exported(const material::Material& material, const exports::ShaderTable& table,
                           Language language) {
  return language == Language::hlsl ? exports::to_hlsl_with_table(material, table)
                                    : exports::to_glsl_with_table(material, table);
}

/// What a user of HLSL writes around the function of the material 'test paint'.
constexpr std::string_view hlsl_around = R"(
[[vk::binding(0, 0)]] StructuredBuffer<float> directions;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> values;
[[vk::binding(2, 0)]] Texture2D<float4> lobe;
[[vk::binding(3, 0)]] SamplerState linear_clamp;
struct Pairs { uint count; };
[[vk::push_constant]] ConstantBuffer<Pairs> pairs;

float4 brdf_test_paint_table(float2 uv) { return lobe.SampleLevel(linear_clamp, uv, 0.0); }

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
  if (id.x >= pairs.count) return;
  uint d = 6 * id.x;
  float3 f_r = brdf_test_paint(float3(directions[d], directions[d + 1], directions[d + 2]),
                               float3(directions[d + 3], directions[d + 4], directions[d + 5]));
  for (uint c = 0; c < 3; ++c) values[3 * id.x + c] = f_r[c];
}
)";

/// The same in GLSL, with a combined sampler's two halves.
constexpr std::string_view glsl_around = R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Directions { float directions[]; };
layout(set = 0, binding = 1) writeonly buffer Values { float values[]; };
layout(set = 0, binding = 2) uniform texture2D lobe;
layout(set = 0, binding = 3) uniform sampler linear_clamp;
layout(push_constant) uniform Pairs { uint count; } pairs;

vec4 brdf_test_paint_table(vec2 uv) {
  return textureLod(sampler2D(lobe, linear_clamp), uv, 0.0);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= pairs.count) return;
  uint d = 6u * i;
  vec3 f_r = brdf_test_paint(vec3(directions[d], directions[d + 1u], directions[d + 2u]),
                             vec3(directions[d + 3u], directions[d + 4u], directions[d + 5u]));
  for (uint c = 0u; c < 3u; ++c) values[3u * i + c] = f_r[c];
}
)";

std::string kernel_of(const std::string& function, Language language) {
  if (language == Language::hlsl) return function + std::string(hlsl_around);
  return "#version 450\n" + function + std::string(glsl_around);
}

/// The directions on which materials are compared, dense in the lobe, rounded to float.
std::vector<float> directions_for(const material::Material& material) {
  const brdf::BoundModel model = material::bind(material);
  const auto samples = material::sample(material::reflectance_of(model), material.channels,
                                        material::default_incidence(model.model()));
  std::vector<float> components;
  for (std::size_t i = 0; i < samples.wi.size(); ++i) {
    const brdf::Direction<double> wi = samples.wi[i];
    const brdf::Direction<double> wo = samples.wo[i];
    for (const double c : {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}) {
      components.push_back(static_cast<float>(c));
    }
  }
  return components;
}

/// The largest difference, as a fraction of the brightest f_r at angles up to 60 degrees or of f_r
/// where that is larger.
double worst_error(std::span<const float> found, const lut::TableModel& expected,
                   std::span<const float> directions) {
  constexpr std::size_t channels = 3;
  std::vector<double> values(found.size());
  double peak = 0;
  for (std::size_t i = 0; i < found.size() / channels; ++i) {
    const auto d = directions.subspan(6 * i, 6);
    const auto f_r = std::span(values).subspan(channels * i, channels);
    expected.f_r({double{d[0]}, double{d[1]}, double{d[2]}},
                 {double{d[3]}, double{d[4]}, double{d[5]}}, f_r);
    if (d[2] < 0.5F || d[5] < 0.5F) continue;
    peak = std::max(peak, *std::max_element(f_r.begin(), f_r.end()));
  }
  double worst = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!std::isfinite(found[k])) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, std::abs(double{found[k]} - values[k]) / std::max(peak, values[k]));
  }
  return worst;
}

/// The rounding of floats, and on a GPU that of the weights to 1/256, which the narrow side of
/// rolled brass makes ten times as much of as the 6e-5 that docs/lut.md states for one alpha.
double allowed_error(const shader::DeviceDescription& device) {
  return device.type == shader::DeviceType::cpu ? 1e-5 : 1e-3;
}

class ExportedTableShader : public testing::TestWithParam<Language> {};
INSTANTIATE_TEST_SUITE_P(Languages, ExportedTableShader,
                         testing::Values(Language::hlsl, Language::glsl), [](const auto& tested) {
                           return tested.param == Language::hlsl ? "hlsl" : "glsl";
                         });

TEST_P(ExportedTableShader, ComputesTheModelWithTheTablesLobe) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const material::Material phong = rgb_material_of(
      "lambert+blinn-phong", {{"rho_d", {0.1, 0.2, 0.3}}, {"ks", {3, 2, 1}}, {"exponent", {80}}});
  const material::Material strauss = rgb_material_of(
      "strauss", {{"c", {0.9, 0.6, 0.2}}, {"s", {0.7}}, {"m", {0.6}}, {"t", {0.1}}});
  struct Case {
    const material::Material& material;
    TableKind kind;
    Coordinate coordinate;
    Storage storage;
  };
  const material::Material brass = rolled_brass();
  // Every kind, and every storage that lavapipe filters in float; two channels with rows.
  const std::vector<Case> cases{
      {brass, TableKind::ward_exponent, Coordinate::cosine, Storage::r32f},
      {brass, TableKind::ward_exponent, Coordinate::sqrt, Storage::r16f},
      {brass, TableKind::ward_lobe, Coordinate::sqrt, Storage::unorm16},
      {phong, TableKind::blinn_phong_power, Coordinate::fourth_root, Storage::r32f},
      {strauss, TableKind::strauss_j, Coordinate::cosine, Storage::r16f},
      {strauss, TableKind::strauss_terms, Coordinate::cosine, Storage::r32f}};
  for (const auto& [material, kind, coordinate, storage] : cases) {
    SCOPED_TRACE(fmt::format("{} by {} of {}", material.model, name_of(kind), name_of(storage)));
    const exports::ShaderTable table =
        table_from_file(layout_of(material, kind, coordinate, storage));
    const std::string text = exported(material, table, GetParam()).files.front().text;
    const auto directions = directions_for(material);
    const auto count = static_cast<std::uint32_t>(directions.size() / 6);
    const shader::SampledTexture texture{table.table.texture};
    const auto found = device.run(shader::compile(kernel_of(text, GetParam()), GetParam()),
                                  directions, std::size_t{3} * count, count, &texture);
    const lut::TableModel expected(material::bind(material), table.table, lut::Filter::linear,
                                   lut::Weights::exact);
    EXPECT_LE(worst_error(found, expected, directions), allowed_error(device.description()));
  }
}

TEST(ExportTable, SaysWhatHasToBeBoundAndNoFolder) {
  const material::Material brass = rolled_brass();
  const auto header_of = [&](TableKind kind, Storage storage) {
    return exported(brass, table_from_file(layout_of(brass, kind, Coordinate::sqrt, storage)),
                    Language::hlsl)
        .files.front()
        .text;
  };
  const std::string floats = header_of(TableKind::ward_exponent, Storage::r32f);
  EXPECT_THAT(
      floats,
      AllOf(HasSubstr("texture: lobe.exr: 512 x 1 texels of 32-bit float: VK_FORMAT_R32_SFLOAT, "
                      "DXGI_FORMAT_R32_FLOAT, GL_R32F\n"),
            HasSubstr("clamped to the edge"), HasSubstr("no mipmaps"), HasSubstr("no decoding of"),
            HasSubstr("OES_texture_float_linear"), HasSubstr("alpha 0.05 to 0.16"),
            HasSubstr("float4 brdf_test_paint_table(float2 uv);"), HasSubstr("loss of reflected")));
  // Paths of this machine are nobody's business: the folder of the file is a temporary one.
  EXPECT_THAT(floats, Not(AnyOf(HasSubstr("/lobe.exr"), HasSubstr("/tmp"))));

  const std::string integers = header_of(TableKind::ward_lobe, Storage::unorm16);
  EXPECT_THAT(integers, AllOf(HasSubstr("512 x 64 texels"), HasSubstr("GL_R16\n"),
                              HasSubstr("times 65535"), HasSubstr("EXT_texture_norm16"),
                              HasSubstr("the first scan line of the file is at v = 0")));
}

TEST(ExportTable, TakesWavelengthsAsRedGreenBlue) {
  const material::Material rgb = rolled_brass();
  material::Material wavelengths = rgb;
  wavelengths.channels = {"465nm", "525nm", "630nm"};
  for (auto& parameter : wavelengths.parameters) {
    std::reverse(parameter.value.begin(), parameter.value.end());
  }
  const exports::ShaderTable table =
      table_from_file(layout_of(rgb, TableKind::ward_exponent, Coordinate::cosine, Storage::r32f));
  const auto code_of = [&](const material::Material& material) {
    const std::string text = exported(material, table, Language::glsl).files.front().text;
    return text.substr(text.find("#ifndef"));
  };
  EXPECT_EQ(code_of(wavelengths), code_of(rgb));
}

TEST(ExportTable, TellsTheLossOfTheTableAsAGpuFiltersIt) {
  const material::Material brass = rolled_brass();
  const auto exported_with = [&](Coordinate coordinate) {
    return exported(
        brass,
        table_from_file(layout_of(brass, TableKind::ward_exponent, coordinate, Storage::r32f)),
        Language::hlsl);
  };
  // docs/lut.md: 6e-5 of the peak with weights of 1/256, where the narrow side makes ten times as
  // much of it; without the 1/256 it is below 1e-5.
  const exports::Exported good = exported_with(Coordinate::cosine);
  EXPECT_GT(good.loss.peak, 1e-5);
  EXPECT_LT(good.loss.peak, 6e-4);
  EXPECT_TRUE(good.warnings.empty());

  // Plain sums over other directions, of a table bad enough to be told apart from them.
  const exports::Exported listing = exported_with(Coordinate::listing);
  const exports::ShaderTable table = table_from_file(
      layout_of(brass, TableKind::ward_exponent, Coordinate::listing, Storage::r32f));
  const lut::TableModel model(material::bind(brass), table.table, lut::Filter::linear,
                              lut::Weights::quantised);
  const double plain = plain_rms_loss(
      brass,
      [&](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
        Rgb f_r{};
        model.f_r(wi, wo, f_r);
        return f_r;
      },
      true);
  EXPECT_NEAR(listing.loss.rms, plain, 0.1 * plain);
  ASSERT_EQ(listing.warnings.size(), 1U);
  EXPECT_THAT(listing.warnings[0], HasSubstr("lut check --recommend"));
  EXPECT_THAT(listing.files[0].text, HasSubstr(listing.warnings[0]));
}

}  // namespace
}  // namespace gonio::tests
