#include "lut/table.h"

#include <algorithm>
#include <cmath>

#include "brdf/listings/ward.h"
#include "brdf/strauss.h"

namespace gonio::lut {
namespace {

bool is_integer(Storage storage) {
  return storage == Storage::unorm16 || storage == Storage::unorm8;
}

/// The coordinate 0..1 of the i-th of `size` texels.
double share_of(int i, int size) { return static_cast<double>(i) / static_cast<double>(size - 1); }

/// tan^2 of the angle between normal and half vector, for w = 1 - n.h; infinite at w = 1.
double tangent_squared(double w) {
  const double cosine = 1 - w;
  return w * (2 - w) / (cosine * cosine);
}

/// The alpha or exponent of a row.
double parameter_of_row(const Layout& layout, int row) {
  if (layout.height == 1) return layout.lowest;
  return layout.lowest * std::pow(layout.highest / layout.lowest, share_of(row, layout.height));
}

/// The texels of ward-exponent in the published way.
double listed_exponent(const Layout& layout, int column) {
  const float share = static_cast<float>(column) / static_cast<float>(layout.width);
  return static_cast<double>(brdf::listings::exponent_by_angle(2 * share - 1));
}

double ward_exponent(const Layout& layout, int column) {
  if (layout.coordinate == Coordinate::listing) return listed_exponent(layout, column);
  if (column == layout.width - 1) return end_of_exponent(layout);
  return -tangent_squared(distance_at(layout, share_of(column, layout.width)));
}

/// The lobe at a texel: 0 in the last column, for what lies beyond the reach.
double lobe(const Layout& layout, int column, int row) {
  const double w = distance_at(layout, share_of(column, layout.width));
  const double parameter = parameter_of_row(layout, row);
  if (layout.kind == TableKind::blinn_phong_power) {
    const bool is_beyond = column == layout.width - 1 && layout.reach < 1;
    return is_beyond ? 0 : std::pow(1 - w, parameter);
  }
  if (column == layout.width - 1) return 0;
  return std::exp(-tangent_squared(w) / (parameter * parameter));
}

/// The argument of F and G for the w of an axis of strauss-j.
brdf::strauss_detail::Argument<double> argument_at(const Layout& layout, double w) {
  if (layout.of_cosine) return {1 - w, w, 1, 1};
  const double sine = std::sqrt((1 - w) * (1 + w));
  return {brdf::quarter_turns(sine, w), brdf::quarter_turns(w, sine), 1, 1};
}

std::array<double, most_channels> strauss_j(const Layout& layout, int column, int row) {
  using namespace brdf::strauss_detail;  // NOLINT(google-build-using-namespace)
  const auto at = [&](int i, int size) {
    return argument_at(layout, distance_at(layout, share_of(i, size)));
  };
  const Argument<double> in = at(column, layout.width);
  const Argument<double> out = at(row, layout.height);
  const Fresnel<double> f = fresnel(in);
  return {f.per_x * in.x * attenuation(in) * attenuation(out),
          f.complement_per_complement * in.complement};
}

/// (1 - m s)(1 - s^3)(1 - t) and s^3 (1 - t), cancelling nothing.
std::array<double, most_channels> strauss_terms(const Layout& layout, int column, int row) {
  const double s = share_of(column, layout.width);
  const double m = share_of(row, layout.height);
  const double opaque = 1 - layout.transparency;
  const double dull = 1 - m + m * (1 - s);
  return {dull * (1 - s) * (1 + s + s * s) * opaque, s * s * s * opaque};
}

std::array<double, most_channels> value_at(const Layout& layout, int column, int row) {
  switch (layout.kind) {
    case TableKind::ward_exponent:
      return {ward_exponent(layout, column)};
    case TableKind::ward_lobe:
    case TableKind::blinn_phong_power:
      return {lobe(layout, column, row)};
    case TableKind::strauss_j:
      return strauss_j(layout, column, row);
    case TableKind::strauss_terms:
      return strauss_terms(layout, column, row);
  }
  return {};
}

}  // namespace

std::array<Decoding, most_channels> decoding_of(const Layout& layout) {
  if (layout.kind != TableKind::ward_exponent || layout.storage == Storage::r32f) return {};
  const double end = -negligible_decay * layout.highest * layout.highest;
  if (is_integer(layout.storage)) return {Decoding{.scale = static_cast<float>(end)}};
  // A power of two: it leaves the comparison with the end exact.
  constexpr double largest_power_of_half = 0x1p15;
  const double scale = std::exp2(std::ceil(std::log2(-end / largest_power_of_half)));
  return {Decoding{.scale = static_cast<float>(scale)}};
}

float end_of_exponent(const Layout& layout) {
  const float last_texel = is_integer(layout.storage) ? 1 : stored(-1e30, layout.storage);
  return decoding_of(layout)[0].scale * last_texel;
}

Table bake(const Layout& layout) {
  check(layout);
  Table table{.layout = layout,
              .texture = {.width = layout.width,
                          .height = layout.height,
                          .channels = channels_of(layout.kind),
                          .storage = layout.storage,
                          .texels = {}},
              .decoding = decoding_of(layout)};
  const auto channels = static_cast<std::size_t>(table.texture.channels);
  table.texture.texels.reserve(static_cast<std::size_t>(layout.width) *
                               static_cast<std::size_t>(layout.height) * channels);
  for (int row = 0; row < layout.height; ++row) {
    for (int column = 0; column < layout.width; ++column) {
      const std::array<double, most_channels> values = value_at(layout, column, row);
      for (std::size_t c = 0; c < channels; ++c) {
        const double texel = values[c] / static_cast<double>(table.decoding[c].scale);
        table.texture.texels.push_back(stored(texel, layout.storage));
      }
    }
  }
  return table;
}

template <class T>
std::array<T, most_channels> look_up(const Table& table, T first, T second, Filter filter,
                                     Weights weights) {
  const Layout& layout = table.layout;
  const T u = texture_coordinate(layout, layout.width, first);
  const T v = is_strauss(layout.kind) ? texture_coordinate(layout, layout.height, second)
                                      : row_coordinate(layout, second);
  std::array<T, most_channels> values = sample(table.texture, u, v, filter, weights);
  for (std::size_t c = 0; c < values.size(); ++c) {
    values[c] *= static_cast<T>(table.decoding[c].scale);
  }
  return values;
}

template std::array<float, most_channels> look_up(const Table&, float, float, Filter, Weights);
template std::array<double, most_channels> look_up(const Table&, double, double, Filter, Weights);

}  // namespace gonio::lut
