// What the tables hold and where, what layouts are for a model, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "brdf/listings/ward.h"
#include "lut/table.h"
#include "tests/strauss_reference.h"

namespace gonio::lut {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::Digits;

template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

brdf::BoundModel ward_aniso(double alpha_x, double alpha_y) {
  const std::array<double, 4> p{0.1, 0.2, alpha_x, alpha_y};
  const auto value = [&](std::size_t i) { return std::span(p).subspan(i, 1); };
  const std::array<brdf::NamedValues, 4> named{
      {{"rho_d", value(0)}, {"rho_s", value(1)}, {"alpha_x", value(2)}, {"alpha_y", value(3)}}};
  return {brdf::Model("ward-aniso"), 1, named};
}

brdf::BoundModel strauss(std::string_view name, double t) {
  const std::array<double, 4> p{0.5, 0.6, 0.3, t};
  const auto value = [&](std::size_t i) { return std::span(p).subspan(i, 1); };
  const std::array<brdf::NamedValues, 4> named{
      {{"c", value(0)}, {"s", value(1)}, {"m", value(2)}, {"t", value(3)}}};
  return {brdf::Model(name), 1, named};
}

TEST(LutTable, NamesReadBack) {
  for (const TableKind kind : all_table_kinds) EXPECT_EQ(table_kind_named(name_of(kind)), kind);
  for (const Coordinate c : all_coordinates) EXPECT_EQ(coordinate_named(name_of(c)), c);
  for (const Storage storage : all_storages) EXPECT_EQ(storage_named(name_of(storage)), storage);
  EXPECT_THAT(refusal([] { table_kind_named("ward"); }),
              AllOf(HasSubstr("'ward'"), HasSubstr("ward-exponent"), HasSubstr("strauss-terms")));
}

TEST(LutTable, TheEndsOfAnAxisAreTheCentresOfItsOutermostTexels) {
  for (const Coordinate coordinate :
       {Coordinate::cosine, Coordinate::sqrt, Coordinate::fourth_root}) {
    const Layout layout{.coordinate = coordinate, .reach = 0.02};
    EXPECT_EQ(texture_coordinate(layout, 512, 0.0), 0.5 / 512);
    EXPECT_EQ(texture_coordinate(layout, 512, 0.02), 511.5 / 512);
    EXPECT_GT(texture_coordinate(layout, 512, 0.021), 511.5 / 512);
    for (int i = 0; i < 512; ++i) {
      const double centre = (i + 0.5) / 512;
      EXPECT_NEAR(texture_coordinate(layout, 512, distance_at(layout, i / 511.0)), centre, 1e-15);
    }
  }
}

// distance_at() is the inverse that the texels are baked at: a mistake in both would not show
// there.
TEST(LutTable, CoordinatesAreTheRootsThatTheyAreNamedAfter) {
  const auto coordinate_of = [](Coordinate coordinate) {
    const Layout layout{.coordinate = coordinate, .reach = 0.5};
    return (texture_coordinate(layout, 101, 0.5 * 0.0016) * 101 - 0.5) / 100;
  };
  EXPECT_NEAR(coordinate_of(Coordinate::cosine), 0.0016, 1e-14);
  EXPECT_NEAR(coordinate_of(Coordinate::sqrt), 0.04, 1e-14);
  EXPECT_NEAR(coordinate_of(Coordinate::fourth_root), 0.2, 1e-14);
  const Layout listing{.coordinate = Coordinate::listing};
  EXPECT_EQ(texture_coordinate(listing, 512, 0.25), (0.75 + 1) / 2);  // n.h = 0.75
}

// The decay of the widest lobe at the reach is exp(-16).
TEST(LutTable, TheReachIsWhereTheWidestLobeEnds) {
  for (const double alpha : {1e-4, 0.05, 1.0, 10.0}) {
    const Layout layout{.kind = TableKind::ward_lobe, .lowest = 1e-4, .highest = alpha};
    const double angle = std::atan(4 * alpha);
    EXPECT_NEAR(lobe_reach(layout) / (2 * std::pow(std::sin(angle / 2), 2)), 1, 1e-12);
  }
  const Layout power{.kind = TableKind::blinn_phong_power, .lowest = 50, .highest = 1000};
  EXPECT_NEAR(std::pow(1 - lobe_reach(power), 50), std::exp(-16), 1e-18);
  EXPECT_EQ(lobe_reach({.kind = TableKind::blinn_phong_power, .lowest = 0, .highest = 0}), 1);
  EXPECT_EQ(lobe_reach({.kind = TableKind::strauss_j}), 1);
}

// A cosine and the tangent of its angle, in another way than the table's.
TEST(LutTable, WardTablesHoldTheLobeAtEveryTexel) {
  for (const Coordinate coordinate :
       {Coordinate::cosine, Coordinate::sqrt, Coordinate::fourth_root}) {
    Layout layout{.coordinate = coordinate, .width = 64, .lowest = 0.1, .highest = 0.1};
    layout.reach = lobe_reach(layout);
    const Table exponents = bake(layout);
    layout.kind = TableKind::ward_lobe;
    layout.highest = 0.4;
    layout.height = 16;
    const Table lobes = bake(layout);
    for (int x = 0; x < 63; ++x) {
      const double half_angle = std::asin(std::sqrt(distance_at(layout, x / 63.0) / 2));
      const double tangent2 = std::pow(std::tan(2 * half_angle), 2);
      const auto i = static_cast<std::size_t>(x);
      EXPECT_NEAR(exponents.texture.texels[i], -tangent2, 2e-7 * tangent2);
      for (int y = 0; y < 16; ++y) {
        const double alpha = 0.1 * std::pow(4, y / 15.0);
        EXPECT_NEAR(lobes.texture.texels[static_cast<std::size_t>(y) * 64 + i],
                    std::exp(-tangent2 / (alpha * alpha)), 1e-7);
      }
    }
  }
}

TEST(LutTable, RowsOfALobeAreThoseOfItsParameter) {
  const Layout layout{
      .kind = TableKind::ward_lobe, .width = 16, .height = 17, .lowest = 0.1, .highest = 0.4};
  EXPECT_EQ(row_coordinate(layout, 0.1), 0.5 / 17);
  EXPECT_NEAR(row_coordinate(layout, 0.2), 8.5 / 17, 1e-15);  // the middle in the logarithm
  EXPECT_NEAR(row_coordinate(layout, 0.4), 16.5 / 17, 1e-15);
  EXPECT_EQ(row_coordinate(layout, 0.05), 0.5 / 17);
  EXPECT_NEAR(row_coordinate(layout, 9.0), 16.5 / 17, 1e-15);
}

TEST(LutTable, BlinnPhongsPowersAreThoseOfTheCosine) {
  const Layout layout{
      .kind = TableKind::blinn_phong_power, .width = 32, .height = 16, .lowest = 2, .highest = 200};
  const Table table = bake(layout);
  auto texel = table.texture.texels.begin();
  for (int y = 0; y < 16; ++y) {
    const double exponent = 2 * std::pow(100, y / 15.0);
    for (int x = 0; x < 32; ++x) {
      EXPECT_NEAR(*texel++, std::pow(1 - x / 31.0, exponent), 1e-7);
    }
  }
}

TEST(LutTable, StraussTablesHoldThePrintedFormulas) {
  for (const bool of_cosine : {false, true}) {
    const Layout layout{.kind = TableKind::strauss_j,
                        .coordinate = Coordinate::sqrt,
                        .width = 24,
                        .height = 16,
                        .of_cosine = of_cosine};
    const Table table = bake(layout);
    const auto argument = [&](int i, int size) {
      const Digits c = Digits(i) / (size - 1);
      return of_cosine ? Digits(1 - c * c)
                       : Digits(acos(c * c) / boost::math::constants::half_pi<Digits>());
    };
    auto texel = table.texture.texels.begin();
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 24; ++x) {
        const Digits in = argument(x, 24);
        const Digits out = argument(y, 16);
        const Digits fresnel = tests::reference_fresnel(in);
        const Digits j =
            fresnel * tests::reference_attenuation(in) * tests::reference_attenuation(out);
        EXPECT_NEAR(*texel++, j.convert_to<double>(), 1e-7);
        EXPECT_NEAR(*texel++, (1 - fresnel).convert_to<double>(), 1e-7);
      }
    }
  }
  const Table terms =
      bake({.kind = TableKind::strauss_terms, .width = 16, .height = 16, .transparency = 0.3});
  const auto [diffuse, r] = look_up(terms, 7 / 15.0, 4 / 15.0, Filter::nearest);
  const double cube = std::pow(7 / 15.0, 3);
  EXPECT_NEAR(diffuse, (1 - 4 / 15.0 * 7 / 15.0) * (1 - cube) * 0.7, 1e-7);
  EXPECT_NEAR(r, 0.7 - (1 - cube) * 0.7, 1e-7);
}

TEST(LutTable, TheListingIsThePublishedOneBitForBit) {
  const Table table = bake({.coordinate = Coordinate::listing});
  const auto published = brdf::listings::ward_exponent_texels();
  ASSERT_EQ(table.texture.texels.size(), published.size());
  for (std::size_t i = 0; i < published.size(); ++i) {
    EXPECT_EQ(table.texture.texels[i], published[i]);
  }
  for (int i = 0; i <= 4096; ++i) {
    const float w = static_cast<float>(i) / 4096;  // 1 - w is exact
    EXPECT_EQ(look_up(table, w, 0.0F, Filter::linear)[0],
              brdf::listings::exponent_by_texture(published, 1 - w));
  }
}

TEST(LutTable, BeyondTheReachTheLobeIsExactlyZero) {
  for (const Storage storage : all_storages) {
    Layout layout{.storage = storage, .lowest = 0.05, .highest = 0.05};
    layout.reach = lobe_reach(layout);
    const Table exponents = bake(layout);
    layout.kind = TableKind::ward_lobe;
    const Table lobes = bake(layout);
    for (const float w : {1.0001F * static_cast<float>(layout.reach), 0.1F, 0.5F, 1.0F}) {
      EXPECT_EQ(look_up(exponents, w, 0.0F, Filter::linear)[0], end_of_exponent(exponents.layout));
      EXPECT_EQ(look_up(lobes, w, 0.05F, Filter::linear)[0], 0);
    }
    // The largest 1/alpha^2 leaves the exponent finite.
    EXPECT_TRUE(std::isfinite(end_of_exponent(exponents.layout) * 1e8F));
  }
}

TEST(LutTable, IntegersOfTheExponentCoverTheLobe) {
  const Layout layout{.storage = Storage::unorm16, .lowest = 0.1, .highest = 0.2};
  EXPECT_NEAR(decoding_of(layout)[0].scale, -16 * 0.04, 1e-7);
  EXPECT_EQ(look_up(bake(layout), 0.0, 0.0, Filter::linear)[0], 0);
}

// The scale is a power of two, so that it rounds nothing, and leaves 16 alpha^2 in the upper half
// of the halves' range or just below.
TEST(LutTable, HalfFloatsOfTheExponentAreScaledToTheLobe) {
  for (const double alpha : {1e-4, 0.05, 0.1, 1.0, 10.0}) {
    const Layout layout{.storage = Storage::r16f, .lowest = alpha, .highest = alpha};
    const double scale = decoding_of(layout)[0].scale;
    EXPECT_EQ(std::exp2(std::round(std::log2(scale))), scale);
    EXPECT_LE(16 * alpha * alpha / scale, 0x1p15);
    EXPECT_GT(16 * alpha * alpha / scale, 0x1p14);
    EXPECT_EQ(end_of_exponent(layout), -65504 * scale);
    EXPECT_EQ(look_up(bake(layout), 0.0, 0.0, Filter::linear)[0], 0);
  }
  EXPECT_EQ(decoding_of({.storage = Storage::r32f, .lowest = 1e-4, .highest = 0.1})[0].scale, 1);
}

TEST(LutTable, OnlyFloatsToTheHorizonServeAnyAlpha) {
  EXPECT_TRUE(serves_any_alpha({.lowest = 0.1, .highest = 0.1}));
  EXPECT_TRUE(serves_any_alpha({.coordinate = Coordinate::listing}));
  EXPECT_FALSE(serves_any_alpha({.reach = 0.5}));
  EXPECT_FALSE(serves_any_alpha({.storage = Storage::r16f}));
  EXPECT_FALSE(serves_any_alpha({.storage = Storage::unorm16}));
  EXPECT_FALSE(serves_any_alpha({.kind = TableKind::ward_lobe}));
}

TEST(LutTable, AModelsLayoutServesItsParameters) {
  const Layout brushed = layout_for(ward_aniso(0.05, 0.16), TableKind::ward_lobe);
  EXPECT_EQ(brushed.lowest, 0.05);
  EXPECT_EQ(brushed.highest, 0.16);
  EXPECT_EQ(brushed.height, rows_of_a_range);
  EXPECT_EQ(layout_for(ward_aniso(0.05, 0.16), TableKind::ward_exponent).height, 1);
  EXPECT_EQ(layout_for(ward_aniso(0.1, 0.1), TableKind::ward_lobe).height, 1);
  const Layout listing = layout_for(strauss("strauss-listing", 0.25), TableKind::strauss_terms);
  EXPECT_TRUE(listing.of_cosine);
  EXPECT_EQ(listing.transparency, 0.25);
  EXPECT_EQ(listing.height, listing.width);
  EXPECT_FALSE(layout_for(strauss("strauss", 0), TableKind::strauss_j).of_cosine);
}

TEST(LutTable, AModelHasTheTablesOfItsTerms) {
  EXPECT_THAT(tables_for(brdf::Model("oren-nayar+ward-gmd-aniso")),
              ElementsAre(TableKind::ward_exponent, TableKind::ward_lobe));
  EXPECT_THAT(
      tables_for(brdf::Model("lambert+blinn-phong+ward")),
      ElementsAre(TableKind::ward_exponent, TableKind::ward_lobe, TableKind::blinn_phong_power));
  EXPECT_THAT(tables_for(brdf::Model("strauss")),
              ElementsAre(TableKind::strauss_j, TableKind::strauss_terms));
  // Its exponent is not tan^2 over alpha^2; the others have no such factor.
  for (const char* name : {"ward-approx", "phong", "ashikhmin-shirley", "oren-nayar"}) {
    EXPECT_THAT(tables_for(brdf::Model(name)), IsEmpty()) << name;
  }
  EXPECT_THAT(refusal([] { layout_for(ward_aniso(0.1, 0.1), TableKind::strauss_j); }),
              AllOf(HasSubstr("strauss-j"), HasSubstr("lambert+ward-aniso"),
                    HasSubstr("expected ward-exponent or ward-lobe")));
}

TEST(LutTable, ImpossibleLayoutsAreRefusedWithWhatIsPossible) {
  const auto problem = [](const Layout& layout) { return refusal([&] { check(layout); }); };
  EXPECT_EQ(problem({}), "");
  EXPECT_THAT(problem({.width = 15}), AllOf(HasSubstr("15"), HasSubstr("16 to 4096")));
  EXPECT_THAT(problem({.width = 4097}), HasSubstr("16 to 4096"));
  EXPECT_THAT(problem({.height = 16}), HasSubstr("ward-lobe"));
  EXPECT_THAT(problem({.kind = TableKind::strauss_j}), HasSubstr("16 to 4096"));
  EXPECT_THAT(problem({.reach = 0}), HasSubstr("reach"));
  EXPECT_THAT(problem({.reach = std::nan("")}), HasSubstr("reach"));
  EXPECT_THAT(problem({.lowest = 0.2, .highest = 0.1}), HasSubstr("range"));
  EXPECT_THAT(problem({.lowest = 1e-5, .highest = 0.1}), HasSubstr("0.0001 to 10"));
  EXPECT_THAT(problem({.storage = Storage::r16f, .lowest = 1e-4, .highest = 10}),
              AllOf(HasSubstr("r16f"), HasSubstr("a factor of 2000"), HasSubstr("r32f")));
  EXPECT_EQ(problem({.storage = Storage::r16f, .lowest = 0.005, .highest = 10}), "");
  EXPECT_THAT(problem({.kind = TableKind::ward_lobe, .lowest = 0.1, .highest = 0.2}),
              HasSubstr("rows"));
  EXPECT_THAT(problem({.kind = TableKind::ward_lobe, .height = 64}), HasSubstr("height of 1"));
  EXPECT_THAT(problem({.kind = TableKind::ward_lobe, .coordinate = Coordinate::listing}),
              HasSubstr("ward-exponent only"));
  EXPECT_THAT(problem({.coordinate = Coordinate::listing, .storage = Storage::unorm8}),
              HasSubstr("r32f"));
  EXPECT_THAT(problem({.coordinate = Coordinate::listing, .reach = 0.5}), HasSubstr("full"));
  EXPECT_THAT(problem({.kind = TableKind::strauss_terms, .height = 16, .transparency = 2}),
              HasSubstr("0 to 1"));
}

}  // namespace
}  // namespace gonio::lut
