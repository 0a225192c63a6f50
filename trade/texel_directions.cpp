#include "trade/texel_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "material/comparison.h"

namespace gonio::trade {
namespace {

using Direction = brdf::Direction<double>;
using Pair = brdf::DirectionPair<double>;
using std::numbers::pi;

constexpr double largest_incidence_deg = 75;

double cosine_of_degrees(double degrees) { return std::cos(degrees * (pi / 180)); }

const double least_cos_o = cosine_of_degrees(material::largest_compared_theta_deg);
const double least_cos_i = cosine_of_degrees(largest_incidence_deg);

/// Along an axis of `size` texels, in texels from the first one's centre: the centres, and of every
/// `parts`-th between two the places beside it where a GPU's weight is rounded the furthest.
std::vector<double> positions(int size, int parts) {
  constexpr double beside = 0.49 / 256;
  std::vector<double> along;
  for (int texel = 0; texel < size; ++texel) {
    along.push_back(texel);
    if (texel + 1 == size) break;
    for (int part = 1; part < parts; ++part) {
      along.push_back(texel + double(part) / parts - beside);
      along.push_back(texel + double(part) / parts + beside);
    }
  }
  return along;
}

/// Into how many parts the way between two texels is cut: where a curve is no parabola there, the
/// middle is not where it is the furthest from its chord, and with few texels it is none.
int parts_for(int size) {
  if (size <= 128) return 8;
  return size <= 512 ? 4 : 2;
}

/// The w of an axis' positions, those of 0..1.
std::vector<double> distances(const lut::Layout& layout, int size) {
  const bool is_listing = layout.coordinate == lut::Coordinate::listing;
  std::vector<double> found;
  for (const double p : positions(size, parts_for(size))) {
    const double c = is_listing ? (p + 0.5) / size : p / (size - 1);
    const double w = lut::distance_at(layout, c);
    if (w <= 1) found.push_back(w);
  }
  return found;
}

/// The alphas between two at which a table is read the furthest from what it holds.
std::vector<double> alphas_between(const lut::Layout& layout, double lowest, double highest) {
  std::vector<double> alphas{lowest, highest};
  if (layout.height > 1) {
    const double range = std::log(layout.highest / layout.lowest);
    for (const double p : positions(layout.height, 2)) {
      const double alpha = layout.lowest * std::exp(range * p / (layout.height - 1));
      if (alpha > lowest && alpha < highest) alphas.push_back(alpha);
    }
    return alphas;
  }
  // What an error of the exponent x makes of exp(-x / alpha^2) falls by 3 % within half a step.
  constexpr double step = 0.25;
  const double range = std::log(highest / lowest);
  const int steps = int(std::ceil(range / step));
  for (int k = 1; k < steps; ++k) alphas.push_back(lowest * std::exp(range * k / steps));
  return alphas;
}

/// The azimuth at which 1/alpha^2 = cos^2/alpha_x^2 + sin^2/alpha_y^2.
double azimuth_of(double alpha, double alpha_x, double alpha_y) {
  const double along_x = 1 / (alpha_x * alpha_x);
  const double along_y = 1 / (alpha_y * alpha_y);
  const double sin2 = (1 / (alpha * alpha) - along_x) / (along_y - along_x);
  return std::asin(std::sqrt(std::clamp(sin2, 0.0, 1.0)));
}

/// Azimuths of half vectors that show all alphas of the lobes that the table serves.
std::vector<double> azimuths_of_half_vectors(const brdf::BoundModel& model,
                                             const lut::Layout& layout) {
  std::vector<double> azimuths;
  std::span<const double> shape_of_rest = model.shape();
  for (const brdf::TermEntry* term : model.model().terms()) {
    const std::span<const double> shape = shape_of_rest.first(term->shape.size());
    shape_of_rest = shape_of_rest.subspan(shape.size());
    const bool has_alphas = lut::is_served(term->description, layout.kind) &&
                            term->description.anisotropic && shape[0] != shape[1];
    if (!has_alphas) continue;
    const double tangent = shape.size() > 2 ? shape[2] : 0;
    const auto [lowest, highest] = std::minmax(shape[0], shape[1]);
    for (const double alpha : alphas_between(layout, lowest, highest)) {
      azimuths.push_back(tangent + azimuth_of(alpha, shape[0], shape[1]));
    }
  }
  return azimuths.empty() ? std::vector<double>{0} : azimuths;
}

std::vector<double> incidences() {
  std::vector<double> theta;
  for (double deg = 0; deg <= largest_incidence_deg; deg += 15) theta.push_back(deg * (pi / 180));
  return theta;
}

/// A light and which of the two extreme viewers, for a half vector of an azimuth.
struct View {
  double theta_i;  // in radians
  double azimuth;
  bool is_grazing;
};

std::vector<View> views_of(const std::vector<double>& azimuths) {
  std::vector<View> views;
  for (const double azimuth : azimuths) {
    for (const double theta_i : incidences()) {
      for (const bool is_grazing : {false, true}) views.push_back({theta_i, azimuth, is_grazing});
    }
  }
  return views;
}

/// Adds the pair whose half vector is at 1 - n.h = w, if there is one. About the half vector the
/// viewer's cosine is 2 (wi.h) n.h - cos_i: smallest and largest in the plane of incidence.
void add_pair(std::vector<Pair>& pairs, double w, const View& view) {
  const double cos_h = 1 - w;
  const double sin_h = std::sqrt(w * (2 - w));
  const double sin_i = std::sin(view.theta_i);
  const double cos_i = std::cos(view.theta_i);
  if (view.is_grazing && !(sin_i * sin_h > 0)) return;
  double cos_turn = 1;  // of the light's azimuth from the half vector's
  if (view.is_grazing) {
    const double wi_dot_h_at_least = (least_cos_o + cos_i) / (2 * cos_h);
    cos_turn = std::max((wi_dot_h_at_least - cos_h * cos_i) / (sin_h * sin_i), -1.0);
  }
  if (!(cos_turn <= 1)) return;
  const double azimuth_i = view.azimuth + std::acos(cos_turn);
  const Direction h{sin_h * std::cos(view.azimuth), sin_h * std::sin(view.azimuth), cos_h};
  const Direction wi{sin_i * std::cos(azimuth_i), sin_i * std::sin(azimuth_i), cos_i};
  const double twice = 2 * (wi.x * h.x + wi.y * h.y + wi.z * h.z);
  const Direction wo{twice * h.x - wi.x, twice * h.y - wi.y, twice * h.z - wi.z};
  constexpr double rounding = 1e-9;
  if (wo.z >= least_cos_o - rounding) pairs.push_back({wi, wo});
}

/// Every how many views are taken, so that there are some 100000 pairs: prime to their number, by
/// which the texels take turns, and with all incidences at each texel.
std::size_t stride_of(std::size_t distances, std::size_t views) {
  constexpr std::size_t most_pairs = 100000;
  constexpr std::size_t views_of_an_azimuth = 12;
  const std::size_t of_each = std::max(most_pairs / distances, views_of_an_azimuth);
  std::size_t stride = std::max<std::size_t>(1, views / of_each);
  while (std::gcd(stride, views_of_an_azimuth) > 1) --stride;
  return stride;
}

std::vector<Pair> across_lobe(const brdf::BoundModel& model, const lut::Layout& layout,
                              std::size_t every) {
  std::vector<double> along = distances(layout, layout.width);
  // The last half vectors that there are, for every incidence.
  for (const double theta_i : incidences()) {
    along.push_back(1 - std::cos((theta_i + std::acos(least_cos_o)) / 2));
  }
  const std::vector<View> views = views_of(azimuths_of_half_vectors(model, layout));
  const std::size_t stride = stride_of(along.size(), views.size());
  std::vector<Pair> pairs;
  std::size_t place = 0;
  for (std::size_t i = 0; i < along.size(); ++i) {
    for (std::size_t v = i % stride; v < views.size(); v += stride) {
      if (place++ % every == 0) add_pair(pairs, along[i], views[v]);
    }
  }
  return pairs;
}

/// The direction in the plane of incidence at a place of a strauss-j axis.
Direction direction_at(double w, bool of_cosine, double side) {
  const double z = of_cosine ? 1 - w : w;
  const double sin2 = of_cosine ? w * (2 - w) : (1 - w) * (1 + w);
  return {side * std::sqrt(sin2), 0, z};
}

bool is_lower(const Direction& a, const Direction& b) { return a.z < b.z; }

/// The lowest first.
std::vector<Direction> directions_along(const lut::Layout& layout, int size, double least_cosine,
                                        double side) {
  std::vector<Direction> directions;
  for (const double w : distances(layout, size)) {
    const Direction direction = direction_at(w, layout.of_cosine, side);
    if (direction.z >= least_cosine) directions.push_back(direction);
  }
  std::sort(directions.begin(), directions.end(), is_lower);
  return directions;
}

std::vector<Pair> across_cosines(const lut::Layout& layout, std::size_t every) {
  const std::vector<Direction> lights = directions_along(layout, layout.width, least_cos_i, 1);
  const std::vector<Direction> viewers = directions_along(layout, layout.height, least_cos_o, -1);
  std::vector<Pair> pairs;
  std::size_t place = 0;
  const auto add = [&](const Direction& wi, const Direction& wo) {
    if (place++ % every == 0) pairs.push_back({wi, wo});
  };
  for (const Direction& wi : lights) {
    const auto mirrored = std::lower_bound(viewers.begin(), viewers.end(), wi, is_lower);
    const std::ptrdiff_t before = mirrored - viewers.begin();
    const std::ptrdiff_t after = viewers.end() - mirrored;
    for (std::ptrdiff_t away = 0; away < std::max(before + 1, after);
         away = std::max(away + 1, away * 6 / 5)) {
      if (away < after) add(wi, mirrored[away]);
      if (away > 0 && away <= before) add(wi, mirrored[-away]);
    }
  }
  return pairs;
}

}  // namespace

std::vector<Pair> texel_directions(const brdf::BoundModel& model, const lut::Layout& layout,
                                   std::size_t every) {
  switch (layout.kind) {
    case lut::TableKind::ward_exponent:
    case lut::TableKind::ward_lobe:
    case lut::TableKind::blinn_phong_power:
      return across_lobe(model, layout, every);
    case lut::TableKind::strauss_j:
      return across_cosines(layout, every);
    case lut::TableKind::strauss_terms:
      return {};
  }
  return {};
}

}  // namespace gonio::trade
