#include "bench/shader_directions.h"

#include <cmath>
#include <numbers>

#include "bench/random_source.h"
#include "tests/directions.h"

namespace gonio::bench {
namespace {

using Direction = brdf::Direction<double>;
using Pair = DirectionPair<double>;

constexpr Direction normal{0, 0, 1};

Direction mirrored(const Direction& w) { return {-w.x, -w.y, w.z}; }
Direction below_horizon(const Direction& w) { return {w.x, w.y, -w.z}; }

class PairSource {
 public:
  PairSource(const ShaderMaterial& material, std::uint64_t seed)
      : lobes_(material.lobes.empty() ? std::vector<LobeScale>{{1, 1}} : material.lobes),
        random_(seed, 0) {}

  /// The n-th pair is of the kind that n says.
  Pair draw(std::size_t n) {
    switch (n % 8) {
      case 0:
      case 1:
        return {anywhere(), anywhere()};
      case 2:
      case 3:
      case 4:
        return near_mirror(anywhere());
      case 5:
        return at_grazing();
      case 6:
        return at_normal();
      default:
        return special();
    }
  }

 private:
  double azimuth() { return random_.uniform(0, 2 * std::numbers::pi); }

  /// Uniform over the hemisphere.
  Direction anywhere() {
    const double cosine = 1 - random_.unit();
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    const double phi = azimuth();
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
  }

  Direction grazing() {
    return brdf::direction_from_radians((90 - random_.magnitude(0.01, 10)) * std::numbers::pi / 180,
                                        azimuth());
  }

  /// wo about the mirror image of wi, up to four times as far as the lobe is wide.
  Pair near_mirror(const Direction& wi) {
    const LobeScale& lobe = lobes_[random_.index(lobes_.size())];
    const double distance = random_.uniform(0, 4);
    const double phi = azimuth();
    const double x = lobe.x * distance * std::cos(phi);
    const double y = lobe.y * distance * std::sin(phi);
    const double c = std::cos(lobe.psi);
    const double s = std::sin(lobe.psi);
    return {wi, tests::mirrored_about_slopes(wi, c * x - s * y, s * x + c * y)};
  }

  Pair in_either_order(const Pair& pair) { return random_.coin() ? pair : Pair{pair.wo, pair.wi}; }

  Pair at_grazing() {
    const Direction wi = grazing();
    switch (random_.index(3)) {
      case 0:
        return in_either_order({wi, anywhere()});
      case 1:
        return {wi, grazing()};
      default:
        return in_either_order(near_mirror(wi));
    }
  }

  Pair at_normal() {
    return in_either_order(random_.coin() ? near_mirror(normal) : Pair{normal, anywhere()});
  }

  Pair special() {
    const Direction wi = random_.coin() ? anywhere() : grazing();
    switch (random_.index(6)) {
      case 0:
        return {wi, mirrored(wi)};
      case 1:
        return {wi, wi};
      case 2:
        return {normal, normal};
      case 3:
        return in_either_order({below_horizon(wi), anywhere()});
      case 4:
        return {below_horizon(wi), below_horizon(mirrored(wi))};
      default:
        return in_either_order(
            {{wi.x / std::hypot(wi.x, wi.y), wi.y / std::hypot(wi.x, wi.y), 0}, anywhere()});
    }
  }

  std::vector<LobeScale> lobes_;
  RandomSource random_;
};

Pair mirrored_where_nearly_so(const Pair& pair) {
  constexpr double closest = 1e-5;
  const auto& [wi, wo] = pair;
  const double distance = std::hypot(wi.x + wo.x, wi.y + wo.y, wi.z - wo.z);
  return distance < closest ? Pair{wi, mirrored(wi)} : pair;
}

}  // namespace

std::vector<DirectionPair<double>> shader_directions(const ShaderMaterial& material,
                                                     std::size_t count, std::uint64_t seed) {
  PairSource source(material, seed);
  std::vector<Pair> pairs;
  pairs.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    const Pair pair = source.draw(n);
    pairs.push_back(material.is_mirror ? mirrored_where_nearly_so(pair) : pair);
  }
  return pairs;
}

}  // namespace gonio::bench
