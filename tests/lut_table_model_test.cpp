// Models by tables against the models themselves: every term, and directions where arithmetic ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lut/table_model.h"
#include "lut/table_text.h"
#include "tests/directions.h"
#include "tests/extreme_directions.h"

namespace gonio::lut {
namespace {

using testing::HasSubstr;
using Direction = brdf::Direction<double>;

/// Amplitudes 0.3 and shapes as listed, in the order of the model's shape, for one channel.
brdf::BoundModel bound(std::string_view name, const std::vector<double>& shape,
                       brdf::Frame frame = brdf::Frame::of_table) {
  const brdf::Model model(name, frame);
  const double amplitude = 0.3;
  std::vector<brdf::NamedValues> values;
  for (const auto& p : model.amplitudes()) values.push_back({p.name, std::span(&amplitude, 1)});
  for (std::size_t i = 0; i < shape.size(); ++i) {
    values.push_back({model.shape()[i].name, std::span(shape).subspan(i, 1)});
  }
  return {model, 1, values};
}

struct Case {
  std::string name;
  std::vector<double> shape;
  brdf::Frame frame = brdf::Frame::of_table;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"ward", {0.1}},
      {"ward-duer", {0.2}},
      {"ward-gmd", {0.05}},
      {"ward-aniso", {0.05, 0.16}},
      {"ward-gmd-aniso", {0.3, 0.1}},
      {"ward-aniso", {0.05, 0.16, 0.7}, brdf::Frame::free},
      {"oren-nayar+ward-duer-aniso", {0.4, 0.1, 0.2}},
      {"lambert+ward+ward-aniso", {0.3, 0.05, 0.1}},
      {"lambert+blinn-phong+ward", {40, 0.1}},
      {"blinn-phong", {300}},
      {"lambert+blinn-phong+blinn-phong", {20, 200}},
      {"strauss", {0.8, 0.6, 0.1}},
      {"strauss-listing", {0.6, 0.3, 0}},
  };
  return all;
}

double value_of(const auto& model, const Direction& wi, const Direction& wo) {
  double value = -1;
  model.f_r(wi, wo, std::span(&value, 1));
  return value;
}

Table table_for(const brdf::BoundModel& model, TableKind kind, int size, Storage storage) {
  Layout layout = layout_for(model, kind);
  layout.width = size;
  if (layout.height > 1) layout.height = size;
  layout.storage = storage;
  if (kind == TableKind::strauss_j) layout.coordinate = Coordinate::sqrt;
  // For the narrower of two lobes in one table.
  if (layout.lowest < layout.highest) layout.coordinate = Coordinate::fourth_root;
  layout.reach = lobe_reach(layout);
  return bake(layout);
}

/// Two directions whose half vector is in or about the lobes: slopes up to 0.6.
struct Pair {
  Direction wi, wo;
};
std::vector<Pair> pairs_in_lobes() {
  std::vector<Pair> pairs;
  for (const double theta : {0.0, 20.0, 45.0, 70.0}) {
    const Direction wi = brdf::direction_from_degrees(theta, 30);
    for (int i = 0; i < 40; ++i) {
      const double slope = 0.6 * std::pow(i / 39.0, 2);
      for (int k = 0; k < 12; ++k) {
        const double phi = k * std::numbers::pi / 6 + 0.1;
        const Direction wo =
            tests::mirrored_about_slopes(wi, slope * std::cos(phi), slope * std::sin(phi));
        if (wo.z > 0.05) pairs.push_back({wi, wo});
      }
    }
  }
  return pairs;
}

// 1024 texels each way leave 2e-5 of the peak at most (docs/lut.md: 512 err by 2e-5 in one
// dimension), and in two dimensions a little more; the peak of the lobe is over these pairs.
TEST(LutTableModel, IsTheModelToTheTablesError) {
  const std::vector<Pair> pairs = pairs_in_lobes();
  for (const Case& c : cases()) {
    const brdf::BoundModel model = bound(c.name, c.shape, c.frame);
    double peak = 0;
    for (const Pair& p : pairs) peak = std::max(peak, value_of(model, p.wi, p.wo));
    for (const TableKind kind : tables_for(model.model())) {
      SCOPED_TRACE(c.name + " by " + std::string(name_of(kind)));
      const Table table = table_for(model, kind, 1024, Storage::r32f);
      const TableModel by_table(model, table, Filter::linear, Weights::exact);
      double worst = 0;
      for (const Pair& p : pairs) {
        worst =
            std::max(worst, std::abs(value_of(by_table, p.wi, p.wo) - value_of(model, p.wi, p.wo)));
      }
      EXPECT_LT(worst, 4e-5 * peak);
      EXPECT_GT(worst, 0) << "no term was read from the table";
    }
  }
}

TEST(LutTableModel, ACoarseTableErrsMoreThanAFineOne) {
  const brdf::BoundModel model = bound("ward-aniso", {0.05, 0.16});
  const std::vector<Pair> pairs = pairs_in_lobes();
  const auto worst_with = [&](int size, Filter filter) {
    const Table table = table_for(model, TableKind::ward_lobe, size, Storage::r32f);
    const TableModel by_table(model, table, filter, Weights::exact);
    double worst = 0;
    for (const Pair& p : pairs) {
      worst =
          std::max(worst, std::abs(value_of(by_table, p.wi, p.wo) - value_of(model, p.wi, p.wo)));
    }
    return worst;
  };
  // Linear: the error falls with the square of the texel, 16 for 4; nearest: with the texel.
  EXPECT_GT(worst_with(64, Filter::linear), 10 * worst_with(256, Filter::linear));
  EXPECT_GT(worst_with(256, Filter::nearest), 10 * worst_with(256, Filter::linear));
}

TEST(LutTableModel, IsFiniteEverywhereAndZeroBelowTheHorizon) {
  for (const Case& c : cases()) {
    const brdf::BoundModel model = bound(c.name, c.shape, c.frame);
    for (const TableKind kind : tables_for(model.model())) {
      SCOPED_TRACE(c.name + " by " + std::string(name_of(kind)));
      const Table table = table_for(model, kind, 64, Storage::unorm16);
      const TableModel by_table(model, table, Filter::linear, Weights::quantised);
      tests::DirectionPairs<double> pairs(1, 1e-300);
      for (int i = 0; i < 3000; ++i) {
        const auto [wi, wo] = pairs.next();
        const double value = value_of(by_table, wi, wo);
        EXPECT_TRUE(std::isfinite(value) && value >= 0)
            << value << " at " << wi.x << " " << wi.y << " " << wi.z << ", " << wo.x << " " << wo.y
            << " " << wo.z;
        EXPECT_EQ(value_of(by_table, {wi.x, wi.y, -wi.z}, wo), 0);
        EXPECT_EQ(value_of(by_table, wi, {wo.x, wo.y, 0}), 0);
      }
    }
  }
}

// Retro-reflected at 89 deg the numerator of GMD's lobe is exp(-1e6) of 1, and 1/hz^4 is 7e5: what
// a table holds for 0 has to be 0.
TEST(LutTableModel, NothingIsLeftFarBeyondALobe) {
  const brdf::BoundModel model = bound("ward-gmd", {0.05});
  const Direction grazing = brdf::direction_from_degrees(89, 0);
  for (const TableKind kind : tables_for(model.model())) {
    for (const Storage storage : all_storages) {
      const Table table = table_for(model, kind, 512, storage);
      const TableModel by_table(model, table, Filter::linear, Weights::quantised);
      EXPECT_DOUBLE_EQ(value_of(by_table, grazing, grazing), 0.3 / std::numbers::pi);
    }
  }
}

// The recipe that is printed has to hold at the exact mirror direction, where h is the normal:
// there the ratio of an anisotropic lobe's 1/alpha^2 is 0/0.
TEST(LutTableModel, IsThePeakWhereTheHalfVectorIsTheNormal) {
  const Direction wi = brdf::direction_from_degrees(30, 0);
  const Direction wo{-wi.x, -wi.y, wi.z};
  const brdf::BoundModel model = bound("ward-aniso", {0.05, 0.16});
  for (const TableKind kind : tables_for(model.model())) {
    const Table table = table_for(model, kind, 64, Storage::r32f);
    const TableModel by_table(model, table, Filter::linear, Weights::exact);
    EXPECT_DOUBLE_EQ(value_of(by_table, wi, wo), value_of(model, wi, wo));
    EXPECT_THAT(sampling_text(table.layout), HasSubstr("q > 1e-30 ?"));
  }
}

TEST(LutTableModel, RefusesATableOfAnotherMaterial) {
  const auto refusal = [](const brdf::BoundModel& model, const Table& table) -> std::string {
    try {
      require_serves(model, table);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const Table lobe = bake({.kind = TableKind::ward_lobe, .lowest = 0.1, .highest = 0.1});
  EXPECT_EQ(refusal(bound("ward", {0.1}), lobe), "");
  EXPECT_THAT(refusal(bound("ward", {0.2}), lobe),
              HasSubstr("for alpha 0.1, the material has alpha 0.2;"));
  for (const Storage storage : all_storages) {
    // Too narrow, too wide; floats to the horizon serve any.
    const Table exponent = bake({.storage = storage, .lowest = 0.1, .highest = 0.2});
    EXPECT_EQ(refusal(bound("ward", {0.15}), exponent), "");
    for (const double alpha : {0.01, 0.5}) {
      const std::string problem = refusal(bound("ward", {alpha}), exponent);
      if (storage == Storage::r32f) {
        EXPECT_EQ(problem, "");
      } else {
        EXPECT_THAT(problem,
                    HasSubstr("the table is for alpha 0.1 to 0.2, the material has alpha"));
      }
    }
  }
  EXPECT_THAT(refusal(bound("ward", {0.5}), bake({.reach = 0.1, .lowest = 0.1, .highest = 0.2})),
              HasSubstr("the table is for alpha 0.1 to 0.2"));
  EXPECT_THAT(refusal(bound("phong", {20}), lobe), HasSubstr("lambert+phong has no table"));
  const Table power = bake({.kind = TableKind::blinn_phong_power, .lowest = 20, .highest = 20});
  EXPECT_THAT(refusal(bound("blinn-phong", {30}), power),
              HasSubstr("for exponent 20, the material has exponent 30"));
  const Table j = bake({.kind = TableKind::strauss_j, .width = 16, .height = 16});
  EXPECT_THAT(refusal(bound("strauss-listing", {0.5, 0.5, 0}), j), HasSubstr("strauss-listing"));
  const Table terms = bake({.kind = TableKind::strauss_terms, .width = 16, .height = 16});
  EXPECT_THAT(refusal(bound("strauss", {0.5, 0.5, 0.25}), terms), HasSubstr("0.25"));
}

}  // namespace
}  // namespace gonio::lut
