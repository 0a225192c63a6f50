// Shaders that read a lobe from a look-up table, run on a Vulkan device, against the same model in
// double (lut/table_model.h): the same formulas around the same texels.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/float_direction.h"
#include "lut/table_model.h"
#include "shader/evaluate.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

using brdf::BoundModel;
using brdf::Frame;
using brdf::Model;
using lut::Coordinate;
using lut::Filter;
using lut::Layout;
using lut::Storage;
using lut::TableKind;
using lut::Weights;
using shader::Language;

using Pair = brdf::DirectionPair<float>;

struct Named {
  std::string_view name;
  std::vector<double> values;
};

BoundModel material_of(const Model& model, const std::vector<Named>& parameters) {
  std::vector<brdf::NamedValues> named;
  for (const Named& p : parameters) named.push_back({p.name, p.values});
  return {model, 3, named};
}

BoundModel isotropic(std::string_view model, double alpha) {
  return material_of(Model(model),
                     {{"rho_d", {0.1, 0.2, 0.3}}, {"rho_s", {0.3, 0.2, 0.1}}, {"alpha", {alpha}}});
}

BoundModel anisotropic(std::string_view model, double alpha_x, double alpha_y) {
  return material_of(Model(model), {{"rho_d", {0.1, 0.2, 0.3}},
                                    {"rho_s", {0.3, 0.2, 0.1}},
                                    {"alpha_x", {alpha_x}},
                                    {"alpha_y", {alpha_y}}});
}

BoundModel strauss(std::string_view model, double s, double m, double t) {
  return material_of(Model(model), {{"c", {0.9, 0.6, 0.2}}, {"s", {s}}, {"m", {m}}, {"t", {t}}});
}

/// A material of every term that a table serves; turned ones and two lobes among them.
std::vector<BoundModel> materials() {
  return {isotropic("ward", 0.05),
          isotropic("ward-duer", 0.2),
          isotropic("ward-gmd", 0.5),
          anisotropic("ward-aniso", 0.05, 0.16),  // rolled brass, Ward 1992, table 1
          anisotropic("ward-duer-aniso", 0.3, 0.1),
          anisotropic("ward-gmd-aniso", 0.1, 0.11),
          material_of(Model("ward-gmd-aniso", Frame::free), {{"rho_d", {0.1, 0.2, 0.3}},
                                                             {"rho_s", {0.3, 0.2, 0.1}},
                                                             {"alpha_x", {0.08}},
                                                             {"alpha_y", {0.3}},
                                                             {"psi", {0.7}}}),
          material_of(Model("oren-nayar+ward+ward-aniso"), {{"rho_d", {0.1, 0.2, 0.3}},
                                                            {"sigma", {0.4}},
                                                            {"rho_s", {0.3, 0.2, 0.1}},
                                                            {"alpha", {0.3}},
                                                            {"rho_s_2", {0.1, 0.2, 0.3}},
                                                            {"alpha_x_2", {0.1}},
                                                            {"alpha_y_2", {0.2}}}),
          material_of(Model("blinn-phong"),
                      {{"rho_d", {0.1, 0.2, 0.3}}, {"ks", {3, 2, 1}}, {"exponent", {80}}}),
          material_of(Model("lambert+blinn-phong+blinn-phong"), {{"rho_d", {0.1, 0.2, 0.3}},
                                                                 {"ks", {3, 2, 1}},
                                                                 {"exponent", {500}},
                                                                 {"ks_2", {1, 2, 3}},
                                                                 {"exponent_2", {10}}}),
          strauss("strauss", 0.7, 0.6, 0.1),
          strauss("strauss-listing", 0.4, 0.9, 0)};
}

/// The incidences of a goniometer, half vectors dense in the lobe and beyond it, the mirror
/// direction, and views below the horizon.
std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (const double incidence : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 89.0}) {
    const auto wi = brdf::direction_from_degrees(incidence, 20);
    for (int azimuth = 0; azimuth < 360; azimuth += 24) {
      for (int step = 0; step <= 60; ++step) {
        const double polar = 85.0 * std::pow(step / 60.0, 2);
        const auto h = brdf::direction_from_degrees(polar, azimuth);
        const double wi_h = wi.x * h.x + wi.y * h.y + wi.z * h.z;
        const brdf::Direction<double> wo{2 * wi_h * h.x - wi.x, 2 * wi_h * h.y - wi.y,
                                         2 * wi_h * h.z - wi.z};
        all.push_back({brdf::in_float(wi), brdf::in_float(wo)});
      }
    }
  }
  return all;
}

/// [pair][channel]
std::vector<double> expected_of(const BoundModel& material, const lut::Table& table, Filter filter,
                                Weights weights, const std::vector<Pair>& all) {
  const lut::TableModel model(material, table, filter, weights);
  const std::size_t channels = material.channel_count();
  std::vector<double> values(all.size() * channels);
  for (std::size_t i = 0; i < all.size(); ++i) {
    model.f_r(brdf::in_double(all[i].wi), brdf::in_double(all[i].wo),
              std::span(values).subspan(i * channels, channels));
  }
  return values;
}

/// The largest value of any channel at angles up to 60 degrees, as shader_accuracy takes the peak.
double peak_of(const std::vector<double>& values, const std::vector<Pair>& all) {
  double peak = 0;
  const std::size_t channels = values.size() / all.size();
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Pair& pair = all[k / channels];
    if (pair.wi.z >= 0.5F && pair.wo.z >= 0.5F) peak = std::max(peak, values[k]);
  }
  return peak;
}

/// How far a device's filter may put a value from the model's with the exact one, [pair][channel]:
/// the model's own arithmetic is not in it.
struct Expected {
  std::vector<double> exact;
  std::vector<double> lowest;
  std::vector<double> highest;
};

/// The largest distance from what is expected as a fraction of the peak, or of the value where that
/// is larger; infinite if a value is not finite, or not 0 below the horizon.
double worst_error(const std::vector<float>& found, const Expected& expected,
                   const std::vector<Pair>& all) {
  const double peak = peak_of(expected.exact, all);
  const std::size_t channels = expected.exact.size() / all.size();
  double worst = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Pair& pair = all[k / channels];
    const bool is_lit = pair.wi.z > 0 && pair.wo.z > 0;
    const double value = double(found[k]);
    if (!std::isfinite(value) || (!is_lit && value != 0)) {
      return std::numeric_limits<double>::infinity();
    }
    const double outside = std::max(expected.lowest[k] - value, value - expected.highest[k]);
    worst = std::max(worst, outside / std::max(peak, expected.highest[k]));
  }
  return worst;
}

/// The table with so much added to every texel of the channels.
lut::Table shifted(lut::Table table, const std::array<double, lut::most_channels>& by) {
  const auto channels = static_cast<std::size_t>(table.texture.channels);
  for (std::size_t i = 0; i < table.texture.texels.size(); ++i) {
    table.texture.texels[i] += static_cast<float>(by[i % channels]);
  }
  return table;
}

/// What a filter gives whose values are off by `step` at most: the models of the tables that are
/// all off by it, either way, for each is monotonic in what is read.
Expected expected_within(const BoundModel& material, const lut::Table& table, double step,
                         const std::vector<Pair>& all) {
  const auto exact = expected_of(material, table, Filter::linear, Weights::exact, all);
  Expected expected{exact, exact, exact};
  for (const double first : {-step, step}) {
    for (const double second : {-step, step}) {
      const auto off = expected_of(material, shifted(table, {first, second}), Filter::linear,
                                   Weights::exact, all);
      for (std::size_t k = 0; k < exact.size(); ++k) {
        expected.lowest[k] = std::min(expected.lowest[k], off[k]);
        expected.highest[k] = std::max(expected.highest[k], off[k]);
      }
    }
  }
  return expected;
}

/// What a filter gives whose weights are rounded to 1/256 or cut: twice what rounding does to any
/// value, as a fraction of the peak or the value.
Expected expected_with_coarse_weights(const BoundModel& material, const lut::Table& table,
                                      const std::vector<Pair>& all) {
  const auto exact = expected_of(material, table, Filter::linear, Weights::exact, all);
  const auto rounded = expected_of(material, table, Filter::linear, Weights::quantised, all);
  const double peak = peak_of(exact, all);
  double spread = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    spread = std::max(spread, std::abs(rounded[k] - exact[k]) / std::max(peak, exact[k]));
  }
  Expected expected{exact, exact, exact};
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double allowed = 2 * spread * std::max(peak, exact[k]);
    expected.lowest[k] -= allowed;
    expected.highest[k] += allowed;
  }
  return expected;
}

/// What the device's linear filter (vulkan_texture_test.cpp) makes of the model with the table.
Expected expected_on(const shader::DeviceDescription& device, const BoundModel& material,
                     const lut::Table& table, const std::vector<Pair>& all) {
  if (device.type != shader::DeviceType::cpu) {
    return expected_with_coarse_weights(material, table, all);
  }
  const bool is_lavapipe = device.name.find("llvmpipe") != std::string::npos;
  const bool is_coarse = is_lavapipe && table.layout.storage == Storage::unorm8;
  const double axes = table.layout.height == 1 ? 1 : 2;
  // A step of an integer of 8 bits for each axis.
  return expected_within(material, table, is_coarse ? axes / 255 : 0, all);
}

/// The layout that serves the material, with this coordinate and storage.
Layout layout_of(const BoundModel& material, TableKind kind, Coordinate coordinate,
                 Storage storage) {
  Layout layout = lut::layout_for(material, kind);
  layout.coordinate = coordinate;
  layout.storage = storage;
  if (coordinate != Coordinate::listing) layout.reach = lut::lobe_reach(layout);
  return layout;
}

bool is_possible(const Layout& layout) {
  try {
    lut::check(layout);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

/// Every coordinate, and every storage with one of them.
std::vector<Layout> layouts_of(const BoundModel& material) {
  std::vector<Layout> layouts;
  const auto add = [&](const Layout& layout) {
    if (is_possible(layout)) layouts.push_back(layout);
  };
  for (const TableKind kind : lut::tables_for(material.model())) {
    for (const Coordinate coordinate : lut::all_coordinates) {
      add(layout_of(material, kind, coordinate, Storage::r32f));
    }
    for (const Storage storage : {Storage::r16f, Storage::unorm16, Storage::unorm8}) {
      add(layout_of(material, kind, Coordinate::cosine, storage));
    }
  }
  return layouts;
}

/// How far the shader may be from the model for the rounding of its numbers.
double allowed_error(const Layout& layout) {
  // The published coordinate is 1 at the lobe's peak, so it moves in steps of 2^-24, 3e-5 of a
  // texel; from one texel to the next the exponent of alpha 0.05 changes by 3.
  return layout.coordinate == Coordinate::listing ? 1e-4 : 1e-5;
}

std::string text_of(const BoundModel& material, const Layout& layout) {
  return fmt::format("{}, {} {} x {}, {}, {}", material.model().name(), name_of(layout.kind),
                     layout.width, layout.height, name_of(layout.coordinate),
                     name_of(layout.storage));
}

class EveryTableLanguage : public testing::TestWithParam<Language> {};
INSTANTIATE_TEST_SUITE_P(ShaderTable, EveryTableLanguage,
                         testing::Values(Language::hlsl, Language::glsl), [](const auto& tested) {
                           return tested.param == Language::hlsl ? "hlsl" : "glsl";
                         });

TEST_P(EveryTableLanguage, ComputesWhatTheModelWithTheTableDoes) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const std::vector<Pair> all = pairs();
  for (const BoundModel& material : materials()) {
    for (const Layout& layout : layouts_of(material)) {
      SCOPED_TRACE(text_of(material, layout));
      const lut::Table table = lut::bake(layout);
      const auto found =
          shader::evaluate(device, material, {table, Filter::linear}, all, GetParam());
      const auto expected = expected_on(device.description(), material, table, all);
      EXPECT_LE(worst_error(found, expected, all), allowed_error(layout));
    }
  }
}

/// The lobes at the bounds of their parameters.
std::vector<BoundModel> extreme_materials() {
  const auto blinn_phong = [](double exponent) {
    return material_of(Model("blinn-phong"),
                       {{"rho_d", {0.1, 0.2, 0.3}}, {"ks", {3, 2, 1}}, {"exponent", {exponent}}});
  };
  return {isotropic("ward", 1e-4),
          isotropic("ward-duer", 10),
          isotropic("ward-gmd", 1e-4),
          anisotropic("ward-gmd-aniso", 1e-4, 10),
          anisotropic("ward-duer-aniso", 10, 1e-4),
          blinn_phong(0),
          blinn_phong(1e6),
          strauss("strauss", 1, 1, 0),
          strauss("strauss-listing", 0, 0, 1),
          strauss("strauss", 1, 0, 0)};
}

/// Directions at the normal, grazing and on the horizon, opposite each other and the same.
std::vector<Pair> extreme_pairs() {
  std::vector<Pair> all;
  const std::array z{1.F, 0.5F, 1e-3F, 1e-12F, 1e-30F, 1.2e-38F, 1e-44F, 0.F, -1e-44F};
  const std::array<std::array<float, 2>, 4> azimuths{{{1, 0}, {-1, 0}, {0, 1}, {0.6F, 0.8F}}};
  const auto direction = [](float cosine, const std::array<float, 2>& azimuth) {
    const float sine = std::sqrt((1 - cosine) * (1 + cosine));
    return brdf::Direction<float>{sine * azimuth[0], sine * azimuth[1], cosine};
  };
  for (const float zi : z) {
    for (const float zo : z) {
      for (const auto& azimuth_i : azimuths) {
        for (const auto& azimuth_o : azimuths) {
          all.push_back({direction(zi, azimuth_i), direction(zo, azimuth_o)});
        }
      }
    }
  }
  return all;
}

TEST_P(EveryTableLanguage, StaysFiniteAtTheExtremes) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const std::vector<Pair> all = extreme_pairs();
  for (const BoundModel& material : extreme_materials()) {
    for (const Layout& layout : layouts_of(material)) {
      SCOPED_TRACE(text_of(material, layout));
      const lut::Table table = lut::bake(layout);
      const auto found = shader::evaluate(device, material, {table}, all, GetParam());
      for (std::size_t k = 0; k < found.size(); ++k) {
        const Pair& pair = all[k / material.channel_count()];
        const bool is_lit = pair.wi.z > 0 && pair.wo.z > 0;
        ASSERT_TRUE(std::isfinite(found[k]) && found[k] >= 0)
            << found[k] << " for " << pair.wi.z << ' ' << pair.wo.z;
        ASSERT_TRUE(is_lit || found[k] == 0) << pair.wi.z << ' ' << pair.wo.z;
      }
    }
  }
}

TEST(ShaderTable, MeetsTheParameterOfAnIsotropicLobeInItsRow) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  // A table for a range of alphas, read at one that is between two rows.
  const BoundModel material = isotropic("ward", 0.13);
  Layout layout = layout_of(material, TableKind::ward_lobe, Coordinate::sqrt, Storage::r32f);
  layout.lowest = 0.05;
  layout.highest = 0.5;
  layout.height = 64;
  layout.reach = lut::lobe_reach(layout);
  const lut::Table table = lut::bake(layout);
  const std::vector<Pair> all = pairs();
  const auto found = shader::evaluate(device, material, {table}, all);
  const auto expected = expected_on(device.description(), material, table, all);
  EXPECT_LE(worst_error(found, expected, all), allowed_error(layout));
}

TEST(ShaderTable, TakesTheNearestTexelIfAsked) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const BoundModel material = isotropic("ward", 0.2);
  const lut::Table table =
      lut::bake(layout_of(material, TableKind::ward_lobe, Coordinate::sqrt, Storage::r32f));
  const std::vector<Pair> all = pairs();
  const auto found = shader::evaluate(device, material, {table, Filter::nearest}, all);
  const auto nearest = expected_of(material, table, Filter::nearest, Weights::exact, all);
  const auto linear = expected_of(material, table, Filter::linear, Weights::exact, all);
  // The filters differ by up to half a step between texels, 3.4e-3 of the peak: exp(-16 c^2) is at
  // most 3.4 steep, and c has 511 steps.
  const double peak = peak_of(nearest, all);
  std::size_t like_nearest = 0;
  std::size_t like_linear = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (std::abs(nearest[k] - linear[k]) < 1e-3 * peak) continue;
    like_nearest += std::abs(double(found[k]) - nearest[k]) < 1e-4 * peak ? 1 : 0;
    like_linear += std::abs(double(found[k]) - linear[k]) < 1e-4 * peak ? 1 : 0;
  }
  EXPECT_GT(like_nearest, 100);
  EXPECT_EQ(like_linear, 0);
}

TEST(ShaderTable, ServesSpectraToo) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const std::vector<double> rho_d(7, 0.1);  // more channels than a shader's vector has
  const std::vector<double> rho_s{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
  const std::vector<double> alpha{0.2};
  const std::array<brdf::NamedValues, 3> named{
      {{"rho_d", rho_d}, {"rho_s", rho_s}, {"alpha", alpha}}};
  const BoundModel material(Model("ward"), 7, named);
  const Layout layout =
      layout_of(material, TableKind::ward_exponent, Coordinate::cosine, Storage::r32f);
  const lut::Table table = lut::bake(layout);
  const std::vector<Pair> all = pairs();
  for (const Language language : {Language::hlsl, Language::glsl}) {
    const auto found = shader::evaluate(device, material, {table}, all, language);
    const auto expected = expected_on(device.description(), material, table, all);
    EXPECT_LE(worst_error(found, expected, all), allowed_error(layout));
  }
}

}  // namespace
}  // namespace gonio::tests
