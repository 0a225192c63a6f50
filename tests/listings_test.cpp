// Where the published listings of Ashikhmin-Shirley, Strauss, Oren-Nayar and Phong depart from the
// models, and by how much. The Ward listings: listings_ward_test.cpp.
//
// Tolerances are those of float: some 1e-6 of the value at hand.
#include "brdf/listings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
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
using listings::Geometry;

constexpr double pi = std::numbers::pi;
constexpr Geometry facing{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

using AshikhminShirley = brdf::CoupledAshikhminShirley<brdf::AnisotropicExponents>;

// The exponents act along the other axes than their names say: nu is the model's nv.
TEST(ListingsTest, AshikhminShirleyIsTheModelWithOneRsTooManyAndWithoutTheCosine) {
  ListingDraws draws;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(0.3, 0.1) : draws.anywhere();
    const double diffuse = brdf::ashikhmin_shirley_detail::diffuse(draw.wi, draw.wo) * 0.5 * 0.7;
    const double specular = f_r<AshikhminShirley>({0, 0.3}, {10, 100}, draw.wi, draw.wo);
    EXPECT_NEAR(listings::ashikhmin_shirley(draw.at, {.diffuse = 0.5F, .nu = 100, .nv = 10}),
                diffuse + 0.3 * specular, 2e-5 * (diffuse + 0.3 * specular) + 1e-7);
  }
}
