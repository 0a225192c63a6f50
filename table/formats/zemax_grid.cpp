#include "table/formats/zemax_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::table {

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double turn = 360;
constexpr double rounding = 1e-9;  // degrees, and fractions of a cell

/// A value between two nodes; `fraction` is the part of the upper one.
struct Bracket {
  std::size_t lower = 0, upper = 0;
  double fraction = 0;
  bool is_inside = false;
};

/// A list of angles, and how values stand between them.
class Axis {
 public:
  enum class Kind : std::uint8_t { line, circle };

  Axis(std::vector<double> nodes, Kind kind) : nodes_(std::move(nodes)), kind_(kind) {
    if (kind == Kind::line || nodes_.size() < 2) return;
    double largest_step = 0;
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
      largest_step = std::max(largest_step, nodes_[i] - nodes_[i - 1]);
    }
    closing_step_ = nodes_.front() + turn - nodes_.back();
    // A gap wider than the steps was not measured.
    is_closed_ = closing_step_ <= largest_step + rounding;
  }

  Bracket locate(double angle) const {
    if (kind_ == Kind::circle) {
      angle -= turn * std::floor((angle - nodes_.front() + rounding) / turn);
      if (is_closed_ && angle > nodes_.back()) {
        return between(nodes_.size() - 1, 0, (angle - nodes_.back()) / closing_step_);
      }
    }
    if (angle < nodes_.front() - rounding || angle > nodes_.back() + rounding) return {};
    const auto above = std::upper_bound(nodes_.begin(), nodes_.end(), angle);
    if (above == nodes_.begin()) return between(0, 0, 0);
    const auto upper = static_cast<std::size_t>(above - nodes_.begin());
    if (above == nodes_.end()) return between(upper - 1, upper - 1, 0);
    return between(upper - 1, upper, (angle - above[-1]) / (*above - above[-1]));
  }

 private:
  /// At a node to rounding, its neighbour does not count: it may be a hole.
  static Bracket between(std::size_t lower, std::size_t upper, double fraction) {
    if (fraction > 1 - rounding) return {upper, upper, 0, true};
    return {lower, fraction < rounding ? lower : upper, fraction < rounding ? 0 : fraction, true};
  }

  std::vector<double> nodes_;
  Kind kind_;
  double closing_step_ = 0;
  bool is_closed_ = false;
};

/// The four angles of a pair of directions as a file lists them, in degrees.
struct Coordinates {
  double rotation, incidence, azimuth, radial;
};

Coordinates coordinates(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  const double sin_i = std::hypot(wi.x, wi.y);
  const double cos_phi = sin_i > 0 ? wi.x / sin_i : 1;
  const double sin_phi = sin_i > 0 ? wi.y / sin_i : 0;
  // wo in the frame whose x axis points below wi; the mirror direction is (-sin_i, 0, cos_i).
  const double x = cos_phi * wo.x + sin_phi * wo.y;
  const double b = cos_phi * wo.y - sin_phi * wo.x;
  const double t = wi.z * x + sin_i * wo.z;
  const double s = wi.z * wo.z - sin_i * x;
  return {.rotation = -std::atan2(sin_phi, cos_phi) * degrees_per_radian,
          .incidence = std::atan2(sin_i, wi.z) * degrees_per_radian,
          .azimuth = std::atan2(b, t) * degrees_per_radian,
          .radial = std::atan2(std::hypot(t, b), s) * degrees_per_radian};
}

class Interpolation {
 public:
  explicit Interpolation(ZemaxText text)
      : rotations_(text.rotations, Axis::Kind::circle),
        incidences_(text.incidences, Axis::Kind::line),
        azimuths_(text.azimuths, Axis::Kind::circle),
        radials_(text.radials, Axis::Kind::line),
        is_isotropic_(text.rotations.size() == 1),
        text_(std::move(text)) {}

  void operator()(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                  std::span<double> f_r) const {
    std::fill(f_r.begin(), f_r.end(), std::numeric_limits<double>::quiet_NaN());
    if (!(wi.z > 0) || !(wo.z > 0)) return;
    const Coordinates at = coordinates(wi, wo);
    const Bracket rotation =
        is_isotropic_ ? Bracket{.is_inside = true} : rotations_.locate(at.rotation);
    const Bracket incidence = incidences_.locate(at.incidence);
    const Bracket azimuth =
        azimuths_.locate(text_.is_one_sided ? std::abs(at.azimuth) : at.azimuth);
    const Bracket radial = radials_.locate(at.radial);
    const std::array axes{rotation, incidence, azimuth, radial};
    if (!std::all_of(axes.begin(), axes.end(), [](const Bracket& b) { return b.is_inside; })) {
      return;
    }
    for (std::size_t c = 0; c < f_r.size(); ++c) f_r[c] = between(axes, text_.values[c]);
  }

 private:
  double between(const std::array<Bracket, 4>& axes, const std::vector<double>& values) const {
    double sum = 0;
    for (unsigned corner = 0; corner < 16; ++corner) {
      const std::array<std::size_t, 4> sizes{1, text_.incidences.size(), text_.azimuths.size(),
                                             text_.radials.size()};
      std::size_t index = 0;
      double weight = 1;
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const bool is_upper = (corner >> a & 1U) != 0;
        index = index * sizes[a] + (is_upper ? axes[a].upper : axes[a].lower);
        weight *= is_upper ? axes[a].fraction : 1 - axes[a].fraction;
      }
      if (weight > 0) sum += weight * values[index];
    }
    return sum;
  }

  Axis rotations_, incidences_, azimuths_, radials_;
  bool is_isotropic_;
  ZemaxText text_;
};

}  // namespace

std::function<void(const brdf::Direction<double>&, const brdf::Direction<double>&,
                   std::span<double>)>
zemax_interpolation(ZemaxText text) {
  return [interpolation = std::make_shared<const Interpolation>(std::move(text))](
             const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
             std::span<double> f_r) { (*interpolation)(wi, wo, f_r); };
}

}  // namespace gonio::table
