// The batches of a model's terms, made of packs of four doubles, against the terms evaluated one
// pair of directions at a time.
#include "fit/batch_model.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "brdf/model.h"
#include "brdf/terms.h"
#include "fit/scale.h"

namespace gonio::tests {
namespace {

/// Directions all over the sphere of `count` pairs: every other half vector near the normal, within
/// most lobes, some directions below the horizon, some grazing.
fit::DirectionChunk directions(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  fit::DirectionChunk chunk;
  chunk.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta_i = draw(0, i % 8 == 5 ? 120 : 89.9);
    const double phi_i = draw(-180, 180);
    const bool near_mirror = i % 2 == 0;
    const auto wi = brdf::direction_from_degrees(theta_i, phi_i);
    const auto wo =
        near_mirror ? brdf::direction_from_degrees(theta_i + draw(-8, 8), phi_i + 180 + draw(-8, 8))
                    : brdf::direction_from_degrees(draw(0, 95), draw(-180, 180));
    chunk.wi_x[i] = wi.x;
    chunk.wi_y[i] = wi.y;
    chunk.wi_z[i] = wi.z;
    chunk.wo_x[i] = wo.x;
    chunk.wo_y[i] = wo.y;
    chunk.wo_z[i] = wo.z;
  }
  chunk.pad();
  return chunk;
}

brdf::Direction<double> wi_of(const fit::DirectionChunk& chunk, std::size_t i) {
  return {chunk.wi_x[i], chunk.wi_y[i], chunk.wi_z[i]};
}
brdf::Direction<double> wo_of(const fit::DirectionChunk& chunk, std::size_t i) {
  return {chunk.wo_x[i], chunk.wo_y[i], chunk.wo_z[i]};
}

/// The derivatives of a model's basis functions by its shape, [basis][shape], by scalar Jets.
using JetTable = std::vector<std::vector<double>>;

template <class T>
void add_jets(std::size_t& first_basis, std::size_t& shape_index, const std::vector<double>& shape,
              const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
              JetTable& derivatives) {
  constexpr std::size_t shape_count = T::shape.size();
  if constexpr (shape_count > 0) {
    using Jet = ceres::Jet<double, int(shape_count)>;
    std::array<Jet, shape_count> theta;
    for (std::size_t j = 0; j < shape_count; ++j) theta[j] = Jet(shape[shape_index + j], int(j));
    const auto basis = T::template basis<Jet, double>(theta, wi, wo);
    for (std::size_t k = 0; k < basis.size(); ++k) {
      for (std::size_t j = 0; j < shape_count; ++j) {
        derivatives[first_basis + k][shape_index + j] = basis[k].v[Eigen::Index(j)];
      }
    }
  }
  first_basis += brdf::basis_size<T>;
  shape_index += shape_count;
}

template <std::size_t... I>
JetTable jets_of(const brdf::Model& model, const std::vector<double>& shape,
                 const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                 std::index_sequence<I...> /*terms*/) {
  JetTable derivatives(model.basis_size(), std::vector<double>(shape.size()));
  std::size_t first_basis = 0;
  std::size_t shape_index = 0;
  for (const brdf::TermEntry* term : model.terms()) {
    ((term->index == I ? add_jets<std::tuple_element_t<I, brdf::EvaluatedTerms>>(
                             first_basis, shape_index, shape, wi, wo, derivatives)
                       : void()),
     ...);
  }
  return derivatives;
}

/// A shape inside the search ranges, at a different share of each: no two parameters are alike, and
/// those along x and y differ by a factor of less than 4.
std::vector<double> some_shape(const brdf::Model& model) {
  std::vector<double> shape;
  for (const brdf::ModelParameter& parameter : model.shape()) {
    const brdf::Parameter& p = parameter.descriptor;
    const double share = 0.55 + 0.07 * double(shape.size());
    shape.push_back(fit::parameter_between(p.scale, p.search_lower, p.search_upper, share));
  }
  return shape;
}

/// A model and where its tangent points.
struct Composition {
  std::string model;
  brdf::Frame frame = brdf::Frame::of_table;
};

/// Every model, the anisotropic ones in a free frame as well, and sums of terms whose authors did
/// not know each other.
std::vector<Composition> compositions() {
  std::vector<Composition> all;
  for (const std::string& name : brdf::model_names()) {
    all.push_back({name});
    if (brdf::Model(name).is_anisotropic()) all.push_back({name, brdf::Frame::free});
  }
  for (const char* name : {"lambert+ashikhmin-shirley", "oren-nayar+phong", "oren-nayar-full+ward",
                           "lambert+ward+ashikhmin-shirley", "oren-nayar-full+phong+blinn-phong"}) {
    all.push_back({name});
  }
  for (const char* name :
       {"lambert+ashikhmin-shirley-aniso", "oren-nayar-full+ward-gmd-aniso",
        "lambert+ward+ward-gmd-aniso", "oren-nayar+ashikhmin-shirley-aniso+ward-aniso"}) {
    all.push_back({name});
    all.push_back({name, brdf::Frame::free});
  }
  return all;
}

class BatchOf : public testing::TestWithParam<Composition> {
 protected:
  // An exponent of up to 27.6 and the slopes in it err by some 1e-15 each, the value by that share.
  static constexpr double rounding = 1e-12;
  static constexpr double dark = 1e-12;  // exp(-27.6)

  static void compare(const brdf::Model& model, const std::vector<double>& shape,
                      const fit::DirectionChunk& chunk, const Eigen::MatrixXd& columns,
                      int& compared) {
    const fit::BatchModel batch(model);
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const auto row = Eigen::Index(i);
      std::vector<double> basis(model.basis_size());
      model.basis(shape, wi_of(chunk, i), wo_of(chunk, i), basis);
      const JetTable jets =
          jets_of(model, shape, wi_of(chunk, i), wo_of(chunk, i),
                  std::make_index_sequence<std::tuple_size_v<brdf::EvaluatedTerms>>());
      for (std::size_t k = 0; k < basis.size(); ++k) {
        const double value = columns(row, Eigen::Index(k));
        ASSERT_NEAR(value, basis[k], rounding * basis[k] + dark * dark);
        ASSERT_TRUE(value == 0 || (chunk.wi_z[i] > 0 && chunk.wo_z[i] > 0)) << "below the horizon";
      }
      for (std::size_t d = 0; d < batch.derivatives().size(); ++d) {
        const auto [function, j] = batch.derivatives()[d];
        const double derivative = columns(row, Eigen::Index(basis.size() + d));
        if (basis[function] < dark) {
          ASSERT_TRUE(std::isfinite(derivative));
          continue;
        }
        // The parts of a derivative, at most 2 * 27.6 / parameter times the value, may cancel:
        // rounding is held to their size. psi turns x / y + y / x < 4 times the exponent.
        const bool is_angle = model.shape()[j].descriptor.scale == brdf::Scale::periodic;
        const double size = basis[function] * 60 * (is_angle ? 4 : 1 / shape[j]);
        ASSERT_NEAR(derivative, jets[function][j], rounding * size)
            << model.shape()[j].name << " of function " << function;
        ++compared;
      }
    }
  }
};

TEST_P(BatchOf, HoldsTheTermsAndTheirDerivativesWhateverItsLength) {
  const brdf::Model model(GetParam().model, GetParam().frame);
  const fit::BatchModel batch(model);
  const std::vector<double> shape = some_shape(model);
  int compared = 0;
  for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 511U, 512U}) {
    const fit::DirectionChunk chunk = directions(count, count);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(
        fit::column_stride, Eigen::Index(batch.column_count(true)), std::nan(""));
    batch.evaluate(chunk, shape, true, columns);
    compare(model, shape, chunk, columns, compared);
    // Padding is evaluated as well, so that nobody reads what nobody wrote; nothing is beyond it.
    const auto padded = Eigen::Index((count + 3) / 4 * 4);
    EXPECT_TRUE(columns.topRows(padded).allFinite()) << count;
    EXPECT_TRUE(columns.bottomRows(fit::column_stride - padded).array().isNaN().all()) << count;

    Eigen::MatrixXd values_only(fit::column_stride, Eigen::Index(batch.column_count(false)));
    batch.evaluate(chunk, shape, false, values_only);
    for (Eigen::Index k = 0; k < values_only.cols(); ++k) {
      for (Eigen::Index i = 0; i < Eigen::Index(count); ++i) {
        // Jets divide by way of the reciprocal: an exponent of up to 745 is another by 3e-16 of it.
        EXPECT_NEAR(values_only(i, k), columns(i, k), rounding * values_only(i, k) + dark * dark);
      }
    }
  }
  EXPECT_GT(compared, shape.empty() ? -1 : 300) << "the directions miss the lobe";
}

TEST_P(BatchOf, IsFiniteAtTheExtremes) {
  const brdf::Model model(GetParam().model, GetParam().frame);
  const fit::BatchModel batch(model);
  fit::DirectionChunk chunk = directions(8, 1);
  const std::array<double, 8> cosines{1, 1e-3, 1e-10, 1e-160, 5e-324, 0, -1e-3, -1};
  for (const double cos_o : cosines) {
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      chunk.wi_x[i] = std::sqrt(1 - cosines[i] * cosines[i]);
      chunk.wi_y[i] = 0;
      chunk.wi_z[i] = cosines[i];
      chunk.wo_x[i] = -std::sqrt(1 - cos_o * cos_o);
      chunk.wo_y[i] = 0;
      chunk.wo_z[i] = cos_o;
    }
    // Every corner of the shape's bounds.
    for (std::size_t corner = 0; corner < std::size_t(1) << model.shape().size(); ++corner) {
      std::vector<double> shape;
      for (std::size_t j = 0; j < model.shape().size(); ++j) {
        const brdf::Parameter& p = model.shape()[j].descriptor;
        shape.push_back((corner >> j & 1) != 0 ? p.upper : p.lower);
      }
      Eigen::MatrixXd columns(fit::column_stride, Eigen::Index(batch.column_count(true)));
      batch.evaluate(chunk, shape, true, columns);
      EXPECT_TRUE(columns.topRows(8).allFinite()) << cos_o << " corner " << corner;
      EXPECT_TRUE((columns.topLeftCorner(8, Eigen::Index(batch.basis_size())).array() >= 0).all())
          << cos_o << " corner " << corner;
      EXPECT_TRUE((columns.middleRows(5, 3).array() == 0).all()) << "below the horizon";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryModel, BatchOf, testing::ValuesIn(compositions()),
                         [](const auto& instance) {
                           std::string name = instance.param.model;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name + (instance.param.frame == brdf::Frame::free ? "_free" : "");
                         });

}  // namespace
}  // namespace gonio::tests
