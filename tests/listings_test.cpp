// Where the published listings of Ashikhmin-Shirley, Strauss, Oren-Nayar and Phong depart from the
// models, and by how much. The Ward listings: listings_ward_test.cpp.
#include "brdf/listings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/ashikhmin_shirley.h"
#include "brdf/lambert.h"
#include "brdf/oren_nayar.h"
#include "brdf/phong.h"
#include "brdf/strauss.h"
#include "tests/listing_draws.h"

namespace gonio::tests {
namespace {

namespace listings = brdf::listings;
using brdf::Direction;
using listings::Float3;
using listings::Geometry;

constexpr double pi = std::numbers::pi;
constexpr Geometry facing{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

using AshikhminShirley = brdf::CoupledAshikhminShirley<brdf::AnisotropicExponents>;

// Rd = 0.5 and Rs = 0.3; the exponents act along the other axes than their names say. 1e-4: float,
// whose rounding of 1 - (n.h)^2 the exponent multiplies.
TEST(ListingsTest, AshikhminShirleyIsTheModelWithOneRsTooManyAndWithoutTheCosine) {
  ListingDraws draws;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(0.3, 0.1) : draws.anywhere();
    const double specular = f_r<AshikhminShirley>({0, 0.3}, {10, 100}, draw.wi, draw.wo);
    const double diffuse =
        f_r<AshikhminShirley>({0.5, 0.3}, {10, 100}, draw.wi, draw.wo) - specular;
    const double expected = diffuse + 0.3 * specular;
    EXPECT_NEAR(listings::ashikhmin_shirley(draw.at, {.diffuse = 0.5F, .nu = 100, .nv = 10}),
                expected, 1e-4 * expected);
  }
}

// The listing against the radiance f_r cos_i. With Rs = 1 there is no diffuse part, and its one Rs
// too many does nothing: what is left at 60 degrees is twice the light.
TEST(ListingsTest, AshikhminShirleyIsTooBrightByOneOverTheCosine) {
  const ListingDraw draw =
      with_normal_z(brdf::direction_from_degrees(60, 90), brdf::direction_from_degrees(61, 270));
  const auto over_radiance = [&](double rs) {
    const double radiance =
        draw.wi.z * f_r<AshikhminShirley>({0, rs}, {100, 100}, draw.wi, draw.wo);
    const listings::AshikhminShirleyMaterial material{
        .diffuse = 0, .specular = static_cast<float>(rs), .nu = 100, .nv = 100};
    return listings::ashikhmin_shirley(draw.at, material) / radiance;
  };
  EXPECT_NEAR(over_radiance(1), 2, 2e-4);
  EXPECT_NEAR(over_radiance(0.3), 0.3 * 2, 2e-4);
}

TEST(ListingsTest, AshikhminShirleyIsNotANumberInMostOfTheHighlightsCentre) {
  const listings::AshikhminShirleyMaterial material{.diffuse = 1, .nu = 100, .nv = 100};
  EXPECT_TRUE(std::isnan(listings::ashikhmin_shirley(facing, material)));
  ListingDraws draws;
  constexpr int count = 10000;
  int lost = 0;
  for (int i = 0; i < count; ++i) {
    if (std::isnan(listings::ashikhmin_shirley(draws.within_lobe(1e-4, 1e-4).at, material))) ++lost;
  }
  EXPECT_GT(lost, count / 2);
  EXPECT_LT(lost, count);
}

double mirror_cosine_of(const ListingDraw& draw) {
  return draw.wi.z * draw.wo.z - draw.wi.x * draw.wo.x - draw.wi.y * draw.wo.y;
}

// s up to 0.95; the exponent there, 60, multiplies float's rounding to 1e-5.
TEST(ListingsTest, StraussIsPiTimesTheRadianceOfTheModelOrNotANumber) {
  ListingDraws draws;
  int not_a_number = 0;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(0.2, 0.2) : draws.anywhere();
    const listings::StraussMaterial material{
        static_cast<float>(draws.uniform(0, 1)), static_cast<float>(draws.uniform(0, 0.95)),
        static_cast<float>(draws.uniform(0, 1)), static_cast<float>(draws.uniform(0, 1))};
    const float value = listings::strauss(draw.at, material);
    if (mirror_cosine_of(draw) < 0) {
      EXPECT_TRUE(std::isnan(value));
      ++not_a_number;
    } else {
      const double model = f_r<brdf::StraussListing>(
          {material.c}, {material.smoothness, material.metalness, material.transparency}, draw.wi,
          draw.wo);
      EXPECT_NEAR(value, pi * draw.wi.z * model, 1e-5);
    }
  }
  EXPECT_GT(not_a_number, 500);  // about a third of viewers anywhere
}

// A perfect mirror that faces light and viewer: n.l = 1, so that r = 1, j = 0 and the model is 1.
TEST(ListingsTest, StraussDividesByZeroAtSmoothnessOne) {
  const listings::StraussMaterial mirror{1, 1, 0, 0};
  EXPECT_TRUE(std::isnan(listings::strauss(facing, mirror)));
  EXPECT_NEAR(pi * f_r<brdf::StraussListing>({1}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}), 1, 1e-12);
  const ListingDraw beside = with_normal_z({0, 0, 1}, brdf::direction_from_degrees(1, 0));
  EXPECT_EQ(listings::strauss(beside.at, mirror), 0);
}

// A red-less metal's highlight, c = 0: the article leaves it black where light falls straight, as
// F(0) = 0, and white at grazing. By the cosine it is the other way round.
TEST(ListingsTest, StraussTurnsTheFresnelEffectRound) {
  const auto at = [](double theta) {
    return with_normal_z(brdf::direction_from_degrees(theta, 0),
                         brdf::direction_from_degrees(theta, 180));
  };
  const auto listing = [&](double theta) {
    return listings::strauss(at(theta).at, {0, 0.9F, 1, 0});
  };
  const auto article = [&](double theta) {
    const ListingDraw draw = at(theta);
    return pi * draw.wi.z * f_r<brdf::Strauss>({0}, {0.9, 1, 0}, draw.wi, draw.wo);
  };
  EXPECT_GT(listing(1), 0.7);
  EXPECT_LT(article(1), 0.001);
  EXPECT_LT(listing(89), 0.01);
  EXPECT_GT(article(89), 0.7);
}

constexpr float sigma = 0.7F;

double oren_nayar_model(const ListingDraw& draw) {
  return pi * draw.wi.z * f_r<brdf::OrenNayar>({1}, {sigma}, draw.wi, draw.wo);
}

TEST(ListingsTest, OrenNayarsRewriteEqualsTheStableFormAwayFromTheNormal) {
  ListingDraws draws;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = draws.anywhere();
    const double model = oren_nayar_model(draw);
    EXPECT_NEAR(listings::oren_nayar(draw.at, sigma), model, 5e-6 * model);
  }
}

/// The worst relative error for light at 0.5 to 1 times this angle from the normal.
double worst_near_normal(double degrees) {
  ListingDraws draws;
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Direction<double> wi =
        brdf::direction_from_degrees(degrees * draws.uniform(0.5, 1), draws.uniform(0, 360));
    const ListingDraw draw = with_normal_z(wi, draws.direction());
    worst = std::max(worst,
                     std::abs(listings::oren_nayar(draw.at, sigma) / oren_nayar_model(draw) - 1));
  }
  return worst;
}

TEST(ListingsTest, OrenNayarsRewriteLosesDigitsNearTheNormalAndIsNotANumberAtIt) {
  EXPECT_LT(worst_near_normal(10), 1e-6);
  EXPECT_GT(worst_near_normal(0.01), 5e-5);
  EXPECT_LT(worst_near_normal(0.01), 2e-4);
  const Float3 n{0, 0, 1};
  const Float3 slanted{0.6F, 0, 0.8F};
  EXPECT_TRUE(std::isnan(listings::oren_nayar({n, n, slanted}, sigma)));
  EXPECT_TRUE(std::isnan(listings::oren_nayar({n, slanted, n}, sigma)));
}

TEST(ListingsTest, OrenNayarsRewriteIsNotDarkBelowTheHorizon) {
  const Float3 n{0, 0, 1};
  const Float3 above{0.6F, 0, 0.8F};
  const Float3 below{0.6F, 0, -0.8F};
  EXPECT_TRUE(std::isnan(listings::oren_nayar({n, below, below}, sigma)));
  EXPECT_GT(listings::oren_nayar({n, above, below}, sigma), 0.4);
  EXPECT_EQ(listings::oren_nayar({n, below, above}, sigma), 0);
}

constexpr listings::PhongLight light{.ambient = 0.1F, .diffuse = 0.8F, .specular = 0.9F};

template <class Term>
double phong_model(const ListingDraw& draw, double exponent) {
  const double diffuse = f_r<brdf::Lambert>({0.8 * 0.5}, {}, draw.wi, draw.wo);
  const double specular = f_r<Term>({0.9 / pi}, {exponent}, draw.wi, draw.wo);
  return 0.1 * 0.5 + pi * (draw.wi.z * diffuse + specular);
}

// c = 0.5. 4e-7: float's rounding of the cosine, which the exponent multiplies.
TEST(ListingsTest, PhongAndBlinnPhongAreTheModelsWithoutTheCosineOnTheHighlight) {
  ListingDraws draws;
  for (const float exponent : {1.0F, 25.0F, 255.0F}) {
    SCOPED_TRACE(exponent);
    const listings::PhongMaterial material{.c = 0.5F, .exponent = exponent, .gloss = 1};
    for (int i = 0; i < 2000; ++i) {
      const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(0.2, 0.2) : draws.anywhere();
      EXPECT_NEAR(listings::phong(draw.at, material, light),
                  phong_model<brdf::Phong>(draw, exponent), 4e-7 * (1 + exponent));
      EXPECT_NEAR(listings::blinn_phong(draw.at, material, light),
                  phong_model<brdf::BlinnPhong>(draw, exponent), 4e-7 * (1 + exponent));
    }
  }
}

constexpr listings::PhongLight highlight_only{.ambient = 0, .diffuse = 0, .specular = 1};

// The exponent is the one of the figures that people know.
constexpr listings::PhongMaterial usual{.c = 1, .exponent = 25, .gloss = 1};

// Equal at normal incidence, by ks = Ls/pi; at 60 degrees the listing's is 2 times brighter.
TEST(ListingsTest, PhongsHighlightIsBrighterThanTheModelsByOneOverTheCosine) {
  const ListingDraw slanted =
      with_normal_z(brdf::direction_from_degrees(60, 0), brdf::direction_from_degrees(55, 180));
  const double radiance =
      slanted.wi.z * f_r<brdf::Phong>({1}, {25}, slanted.wi, slanted.wo);  // for Ls = pi
  EXPECT_NEAR(listings::phong(slanted.at, usual, highlight_only) / radiance, 2, 1e-4);
  EXPECT_NEAR(listings::phong(facing, usual, highlight_only), 1, 1e-6);
}

TEST(ListingsTest, PhongCutsTheHighlightAtTheGlossAndShowsOnlyAmbientLightFromBehind) {
  const listings::PhongMaterial dull{.c = 0.5F, .exponent = 25, .gloss = 0.25F};
  const Geometry from_behind{{0, 0, 1}, {0.6F, 0, -0.8F}, {0, 0, 1}};
  for (const auto listing :
       {listings::phong, listings::blinn_phong, listings::blinn_phong_by_lit}) {
    EXPECT_FLOAT_EQ(listing(facing, dull, highlight_only), 0.25F);
    EXPECT_FLOAT_EQ(listing(from_behind, dull, light), 0.05F);
  }
}

// The model is 0 there.
TEST(ListingsTest, PhongDoesNotLookWhetherTheViewerIsBelowTheHorizon) {
  const Geometry grazing{{0, 0, 1}, {0.98F, 0, 0.2F}, {-0.999F, 0, -0.04F}};
  EXPECT_GT(listings::phong(grazing, usual, highlight_only), 0.3);
  EXPECT_GT(listings::blinn_phong(grazing, usual, highlight_only), 0.3);
}

// Straight light: the half vector turns half as far as the viewer.
TEST(ListingsTest, BlinnPhongsHighlightIsTwiceAsWideInThePlaneOfIncidence) {
  for (const double angle : {5.0, 10.0, 20.0}) {
    const auto seen_from = [](double theta) {
      return with_normal_z({0, 0, 1}, brdf::direction_from_degrees(theta, 0)).at;
    };
    EXPECT_NEAR(listings::blinn_phong(seen_from(2 * angle), usual, highlight_only),
                listings::phong(seen_from(angle), usual, highlight_only), 1e-5);
  }
}

/// -ln of the highlight for a viewer 1 degree across the plane of incidence, Phong's over
/// Blinn-Phong's: the square of how much wider the latter is.
double width_ratio_squared_across(double theta) {
  const Geometry at =
      with_normal_z(brdf::direction_from_degrees(theta, 0),
                    brdf::direction_from_degrees(theta, 180 + 1 / std::sin(theta * pi / 180)))
          .at;
  const listings::PhongMaterial sharp{.c = 1, .exponent = 255, .gloss = 1};
  return std::log(listings::phong(at, sharp, highlight_only)) /
         std::log(listings::blinn_phong(at, sharp, highlight_only));
}

TEST(ListingsTest, BlinnPhongsHighlightIsTheNarrowerAcrossThePlaneBeyondSixtyDegrees) {
  for (const double theta : {30.0, 60.0, 75.0}) {
    SCOPED_TRACE(theta);
    const double ratio = 2 * std::cos(theta * pi / 180);
    EXPECT_NEAR(std::sqrt(width_ratio_squared_across(theta)), ratio, 0.01 * ratio);
  }
}

TEST(ListingsTest, LitGivesBlinnPhongBitForBitButOnTheHorizon) {
  ListingDraws draws;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(0.2, 0.2) : draws.anywhere();
    const listings::PhongMaterial material{
        .c = 0.5F, .exponent = static_cast<float>(draws.uniform(1, 255)), .gloss = 0.9F};
    EXPECT_EQ(listings::blinn_phong_by_lit(draw.at, material, light),
              listings::blinn_phong(draw.at, material, light));
  }
  const Geometry on_horizon{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(listings::blinn_phong(on_horizon, usual, highlight_only), 0);
  EXPECT_NEAR(listings::blinn_phong_by_lit(on_horizon, usual, highlight_only),
              std::pow(std::sqrt(0.5), 25), 1e-9);
}

}  // namespace
}  // namespace gonio::tests
