// Where evaluators are compared: in floats that are the same for all, and at the directions where a
// table errs the most, against a search of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lut/table_model.h"
#include "tests/trade_material.h"
#include "tests/vulkan_device_or_skip.h"
#include "trade/table_check.h"
#include "trade/texel_directions.h"

namespace gonio::trade {
namespace {

using std::numbers::pi;
using Direction = brdf::Direction<double>;

/// A thousand times as long as wide, and turned.
brdf::BoundModel stretched_model() {
  material::Material material;
  material.model = "lambert+ward-aniso";
  material.channels = {"Y"};
  material.parameters = {{"rho_d", {0.1}, {}, {}},
                         {"rho_s", {0.2}, {}, {}},
                         {"alpha_x", {1e-4}, {}, {}},
                         {"alpha_y", {0.1}, {}, {}},
                         {"psi", {0.7}, {}, {}}};
  return material::bind(material);
}

brdf::BoundModel strauss_model(const std::string& name, double s) {
  material::Material material;
  material.model = name;
  material.channels = {"Y"};
  material.parameters = {
      {"c", {0.5}, {}, {}}, {"s", {s}, {}, {}}, {"m", {0.5}, {}, {}}, {"t", {0.}, {}, {}}};
  return material::bind(material);
}

void expect_floats(const Reference& reference) {
  ASSERT_EQ(reference.pairs.size(), reference.pairs_in_float.size());
  for (std::size_t i = 0; i < reference.pairs.size(); ++i) {
    const auto& [wi, wo] = reference.pairs[i];
    const auto& in_float = reference.pairs_in_float[i];
    for (const auto& [wide, narrow] : {std::pair{wi, in_float.wi}, std::pair{wo, in_float.wo}}) {
      ASSERT_EQ(wide.x, double(narrow.x)) << i;
      ASSERT_EQ(wide.y, double(narrow.y)) << i;
      ASSERT_EQ(wide.z, double(narrow.z)) << i;
    }
  }
}

TEST(Reference, HasTheComponentsThatAShaderIsGiven) {
  for (const brdf::BoundModel& model : {stretched_model(), strauss_model("strauss", 1)}) {
    const Reference reference = reference_on_grid(model);
    expect_floats(reference);
    const auto layout = lut::layout_for(model, lut::tables_for(model.model()).front());
    expect_floats(joined(reference_at_texels(model, layout, reference.gauge), reference));
  }
}

TEST(Reference, LetsADeviceReachTheFigureOfNarrowLobes) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  for (const brdf::BoundModel& model : {stretched_model(), strauss_model("strauss", 1)}) {
    TableChoice table{lut::layout_for(model, lut::tables_for(model.model()).front())};
    const TableCheck check = check_table(model, reference_on_grid(model), table, &device);
    EXPECT_LE(check.analytic.value().largest, 2e-5) << model.model().name();  // every shader's
  }
}

/// The largest error by a search at random, of pairs that `pair_at` draws.
template <class PairAt>
double searched(const brdf::BoundModel& model, const LobeGauge& gauge, const lut::Table& table,
                lut::Weights weights, const PairAt& pair_at) {
  const lut::TableModel by_table(model, table, lut::Filter::linear, weights);
  std::mt19937_64 random(1);
  double largest = 0;
  std::vector<double> read(1);
  std::vector<double> expected(1);
  for (int i = 0; i < 400000; ++i) {
    const auto pair = pair_at(random);
    if (!(pair.wo.z >= std::cos(80 * pi / 180))) continue;
    by_table.f_r(pair.wi, pair.wo, read);
    model.f_r(pair.wi, pair.wo, expected);
    largest = std::max(largest, std::abs(read[0] - expected[0]) / gauge.at(0, expected[0]));
  }
  return largest;
}

template <class PairAt>
void expect_found(const brdf::BoundModel& model, const lut::Layout& layout, const PairAt& pair_at) {
  SCOPED_TRACE(testing::Message() << lut::name_of(layout.kind) << ' ' << layout.width << " x "
                                  << layout.height << ' ' << lut::name_of(layout.coordinate));
  const Reference reference = reference_on_grid(model);
  const lut::Table table = lut::bake(layout);
  const TableCheck check = check_table(model, reference, table, lut::Filter::linear, nullptr);
  const auto search = [&](lut::Weights weights) {
    return searched(model, reference.gauge, table, weights, pair_at);
  };
  EXPECT_GE(check.predicted.largest, 0.95 * search(lut::Weights::exact));
  EXPECT_GE(check.predicted_quantised.largest, 0.95 * search(lut::Weights::quantised));
}

double uniform(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

TEST(TexelDirections, FindTheLargestErrorOfStraussTables) {
  // In the plane of incidence, most of them within 4 degrees of the mirror direction.
  const auto pair_at = [](std::mt19937_64& random) {
    const double theta_i = uniform(random, 0, 75);
    const bool is_near = uniform(random, 0, 1) < 0.7;
    const double theta_o =
        std::abs(is_near ? theta_i + uniform(random, -4, 4) : uniform(random, 0, 80));
    return brdf::DirectionPair<double>{brdf::direction_from_degrees(theta_i, 0),
                                       brdf::direction_from_degrees(theta_o, 180)};
  };
  for (const char* name : {"strauss", "strauss-listing"}) {
    const auto model = strauss_model(name, 0.9);
    for (const auto coordinate : {lut::Coordinate::cosine, lut::Coordinate::fourth_root}) {
      for (const int size : {32, 128}) {
        lut::Layout layout = lut::layout_for(model, lut::TableKind::strauss_j);
        layout.width = layout.height = size;
        layout.coordinate = coordinate;
        expect_found(model, layout, pair_at);
      }
    }
  }
}

TEST(TexelDirections, FindTheLargestErrorBetweenTheRowsOfABrushedLobe) {
  constexpr double alpha_x = 0.3;
  constexpr double alpha_y = 0.02;
  const auto model = tests::brushed_model(0.1, 0.2, alpha_x, alpha_y);
  // Half vectors evenly spread over the lobe's slopes, half of the lights in their plane.
  const auto pair_at = [](std::mt19937_64& random) {
    const double r = 4 * std::sqrt(uniform(random, 0, 1));
    const double psi = uniform(random, 0, 2 * pi);
    const double x = alpha_x * r * std::cos(psi);
    const double y = alpha_y * r * std::sin(psi);
    const double z = 1 / std::sqrt(1 + x * x + y * y);
    const bool in_plane = uniform(random, 0, 1) < 0.5;
    const double phi = in_plane ? std::atan2(y, x) : uniform(random, 0, 2 * pi);
    const Direction wi = brdf::direction_from_radians(uniform(random, 60, 75) * pi / 180, phi);
    const double twice = 2 * z * (wi.x * x + wi.y * y + wi.z);
    return brdf::DirectionPair<double>{
        wi, {twice * z * x - wi.x, twice * z * y - wi.y, twice * z - wi.z}};
  };
  for (const int rows : {16, 64}) {
    lut::Layout layout = lut::layout_for(model, lut::TableKind::ward_lobe);
    layout.width = 128;
    layout.height = rows;
    layout.coordinate = lut::Coordinate::sqrt;
    layout.reach = lut::lobe_reach(layout);
    expect_found(model, layout, pair_at);
  }
}

TEST(TexelDirections, MeetEveryTexelAndTheMiddleBetweenAnyTwo) {
  const auto model = tests::ward_model(0.1, 0.2, 0.05);
  for (const auto coordinate : {lut::Coordinate::cosine, lut::Coordinate::fourth_root}) {
    for (const int width : {64, 512, 4096}) {
      lut::Layout layout = lut::layout_for(model, lut::TableKind::ward_exponent);
      layout.width = width;
      layout.coordinate = coordinate;
      layout.reach = lut::lobe_reach(layout);
      std::vector<bool> is_met(std::size_t(2 * width - 1));
      for (const auto& [wi, wo] : texel_directions(model, layout)) {
        const Direction h = brdf::half_vector(wi, wo);
        const double length = std::hypot(h.x, h.y, h.z);
        const double w = (h.x * h.x + h.y * h.y) / (length * (length + h.z));
        const double half_texels = 2 * (lut::texture_coordinate(layout, width, w) * width - 0.5);
        const double nearest = std::round(half_texels);
        // 0.49 / 256 of a texel beside the middle is 1/256 of half a texel.
        if (nearest < 2 * width - 1 && std::abs(half_texels - nearest) < 0.005) {
          is_met[std::size_t(nearest)] = true;
        }
      }
      EXPECT_EQ(std::count(is_met.begin(), is_met.end(), false), 0) << width;
    }
  }
}

TEST(TexelDirections, StayWithinTheAnglesOfAFit) {
  for (const brdf::BoundModel& model : {stretched_model(), strauss_model("strauss", 0.5)}) {
    for (const lut::TableKind kind : lut::tables_for(model.model())) {
      for (const auto& [wi, wo] : texel_directions(model, lut::layout_for(model, kind))) {
        ASSERT_GE(wi.z, std::cos(75.001 * pi / 180));
        ASSERT_GE(wo.z, std::cos(80.001 * pi / 180));
      }
    }
  }
}

}  // namespace
}  // namespace gonio::trade
