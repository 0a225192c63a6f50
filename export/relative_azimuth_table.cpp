#include "export/relative_azimuth_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "brdf/lobe_directions.h"
#include "export/refined_curve.h"

namespace gonio::exports {
namespace {

using brdf::Direction;

constexpr double pi = std::numbers::pi;
constexpr double radians_per_degree = pi / 180;

double written_degrees(double degrees) { return rounded_angle(degrees * radians_per_degree); }

double zenith_of(const Direction<double>& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

// Building -----------------------------------------------------------------------------------

/// Zeniths that every table has: smooth parts need no more.
std::vector<double> coarse_zeniths() {
  std::vector<double> zeniths;
  for (const double degrees : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 82.0}) {
    zeniths.push_back(written_degrees(degrees));
  }
  zeniths.push_back(largest_tabulated_theta());
  return zeniths;
}

std::vector<double> coarse_azimuths() {
  std::vector<double> azimuths;
  for (const double degrees : {0.0, 45.0, 90.0, 135.0, 180.0}) {
    azimuths.push_back(written_degrees(degrees));
  }
  return azimuths;
}

/// The zenith up to which materials are compared; what lies beyond is not worth as many entries.
constexpr int most_degrees = int(material::largest_compared_theta_deg);

/// Some models grow with 1 / cos there: so does what is allowed.
Allowance relaxed(Allowance allowed, double theta) {
  const double factor =
      std::max(1.0, std::cos(most_degrees * radians_per_degree) / std::cos(theta));
  for (double& error : allowed.error) error *= factor;
  return allowed;
}

class Tabulation {
 public:
  Tabulation(const RelativeReflectance& reflectance, std::size_t channel_count)
      : reflectance_(&reflectance), channel_count_(channel_count), lobe_width_(lobe_width()) {}

  /// The table with this tolerance, or nothing if it would have more entries than that.
  std::optional<RelativeAzimuthTable> table(double tolerance, std::size_t most_entries) const;

 private:
  Values f_r(double theta_i, double theta_o, double phi) const;
  Values largest_f_r(double theta_i) const;
  Values lobe_width() const;
  Allowance allowed(double tolerance, double theta_i) const;
  std::vector<double> incidences(double tolerance, std::size_t most) const;
  bool is_near(double tolerance, double a, double middle, double b) const;
  void refine_incidences(double tolerance, std::size_t most, double a, double b,
                         std::vector<double>& nodes) const;
  std::vector<double> exits(const Allowance& allowed, double theta_i) const;
  AzimuthRow row(const Allowance& allowed, double theta_i, double theta_o) const;

  const RelativeReflectance* reflectance_;
  std::size_t channel_count_;
  Values lobe_width_;  // per channel
};

Values Tabulation::f_r(double theta_i, double theta_o, double phi) const {
  Values values(channel_count_);
  (*reflectance_)(theta_i, theta_o, phi, values);
  return values;
}

Values Tabulation::largest_f_r(double theta_i) const {
  Values largest = f_r(theta_i, theta_i, pi);
  for (int degrees = 0; degrees <= most_degrees; degrees += 5) {
    for (const double phi : {0.0, pi}) {
      const Values f = f_r(theta_i, degrees * radians_per_degree, phi);
      for (std::size_t c = 0; c < channel_count_; ++c) largest[c] = std::max(largest[c], f[c]);
    }
  }
  return largest;
}

/// The angle that a lobe would have that held all the light at its largest value.
Values Tabulation::lobe_width() const {
  const double theta_i = 30 * radians_per_degree;
  const Direction<double> wi = brdf::direction_from_radians(theta_i, 0);
  Values albedo(channel_count_);
  for (const auto& [wo, solid_angle] : brdf::lobe_directions(wi)) {
    const Values f = f_r(theta_i, zenith_of(wo), std::atan2(wo.y, wo.x));
    for (std::size_t c = 0; c < channel_count_; ++c) albedo[c] += f[c] * wo.z * solid_angle;
  }
  const Values largest = largest_f_r(theta_i);
  Values width(channel_count_, pi);
  for (std::size_t c = 0; c < channel_count_; ++c) {
    if (largest[c] > 0) width[c] = std::sqrt(albedo[c] / largest[c]);
  }
  return width;
}

Allowance Tabulation::allowed(double tolerance, double theta_i) const {
  Allowance allowed{largest_f_r(theta_i), lobe_width_};
  for (double& error : allowed.error) error *= tolerance;
  return allowed;
}

/// Whether between the incidences a and b the one in their middle can be interpolated: at its own
/// mirror direction, which is where the lobe has moved away from both, and at fixed directions.
bool Tabulation::is_near(double tolerance, double a, double middle, double b) const {
  const Allowance near = relaxed(allowed(tolerance, middle), middle);
  const double at = (middle - a) / (b - a);
  constexpr double no_distance = 0;  // lobes at two incidences weigh no more than one between
  const auto is_near_at = [&](double theta_o, double phi) {
    return is_straight(f_r(a, theta_o, phi), f_r(b, theta_o, phi), at, f_r(middle, theta_o, phi),
                       near, no_distance);
  };
  if (!is_near_at(middle, pi)) return false;
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    for (const double phi : {0.0, pi / 2, pi}) {
      if (!is_near_at(degrees * radians_per_degree, phi)) return false;
    }
  }
  return true;
}

/// Appends the incidences between a (exclusive) and b (inclusive), unless there are more than
/// `most` already.
void Tabulation::refine_incidences(double tolerance, std::size_t most, double a, double b,
                                   std::vector<double>& nodes) const {
  if (nodes.size() > most) return;
  const double middle = rounded_angle((a + b) / 2);
  if (middle > a && middle < b && !is_near(tolerance, a, middle, b)) {
    refine_incidences(tolerance, most, a, middle, nodes);
    refine_incidences(tolerance, most, middle, b, nodes);
  } else {
    nodes.push_back(b);
  }
}

/// The incidences that the tolerance asks for, or some that are more than `most`.
std::vector<double> Tabulation::incidences(double tolerance, std::size_t most) const {
  const std::vector<double> coarse = coarse_zeniths();
  std::vector<double> nodes{coarse.front()};
  for (std::size_t i = 1; i < coarse.size(); ++i) {
    refine_incidences(tolerance, most, coarse[i - 1], coarse[i], nodes);
  }
  return nodes;
}

std::vector<double> Tabulation::exits(const Allowance& allowed, double theta_i) const {
  std::vector<double> start = coarse_zeniths();
  const auto place = std::lower_bound(start.begin(), start.end(), theta_i);
  if (place == start.end() || *place != theta_i) start.insert(place, theta_i);
  constexpr std::array probes{0.0, pi / 2, pi};
  Allowance all_allowed;
  for (std::size_t p = 0; p < probes.size(); ++p) {
    all_allowed.error.insert(all_allowed.error.end(), allowed.error.begin(), allowed.error.end());
    all_allowed.width.insert(all_allowed.width.end(), allowed.width.begin(), allowed.width.end());
  }
  const auto function = [&](double theta_o) {
    Values all;
    for (const double phi : probes) {
      const Values f = f_r(theta_i, theta_o, phi);
      all.insert(all.end(), f.begin(), f.end());
    }
    return all;
  };
  return refined(function, start, all_allowed).angles;
}

AzimuthRow Tabulation::row(const Allowance& allowed, double theta_i, double theta_o) const {
  AzimuthRow row{theta_o, {0.0}, f_r(theta_i, theta_o, 0)};
  if (theta_i == 0 || theta_o == 0) return row;
  const auto function = [&](double phi) { return f_r(theta_i, theta_o, phi); };
  const Curve curve = refined(function, coarse_azimuths(), relaxed(allowed, theta_o));
  row.phi = curve.angles;
  row.values.clear();
  for (const Values& values : curve.values) {
    row.values.insert(row.values.end(), values.begin(), values.end());
  }
  return row;
}

std::optional<RelativeAzimuthTable> Tabulation::table(double tolerance,
                                                      std::size_t most_entries) const {
  RelativeAzimuthTable table{channel_count_, {}, tolerance};
  // A slice has an entry for each coarse zenith at least: no need to look for more incidences.
  const std::size_t most_slices = most_entries / coarse_zeniths().size();
  const std::vector<double> thetas = incidences(tolerance, most_slices);
  if (thetas.size() > most_slices) return std::nullopt;
  std::size_t entries = 0;
  // Between slices a lobe is only in the wrong place; within one, errors add up to its light.
  constexpr double within_slice = 0.25;
  for (const double theta_i : thetas) {
    const Allowance near = allowed(within_slice * tolerance, theta_i);
    IncidenceSlice slice{theta_i, {}};
    for (const double theta_o : exits(near, theta_i)) {
      slice.rows.push_back(row(near, theta_i, theta_o));
      entries += 2 * slice.rows.back().phi.size() - 1;
      if (entries > most_entries) return std::nullopt;
    }
    table.slices.push_back(std::move(slice));
  }
  return table;
}

// Reading ------------------------------------------------------------------------------------

/// The nodes around a place, and how far it is from the first to the second; held at the ends.
struct Bracket {
  std::size_t first;
  std::size_t second;
  double share;
};

template <class Nodes, class Angle>
Bracket bracket(const Nodes& nodes, double place, const Angle& angle_of) {
  const auto above =
      std::upper_bound(nodes.begin(), nodes.end(), place,
                       [&](double value, const auto& node) { return value < angle_of(node); });
  const auto second = static_cast<std::size_t>(above - nodes.begin());
  if (second == 0) return {0, 0, 0};
  if (second == nodes.size()) return {second - 1, second - 1, 0};
  const double a = angle_of(nodes[second - 1]);
  const double b = angle_of(nodes[second]);
  return {second - 1, second, (place - a) / (b - a)};
}

void add_row(const AzimuthRow& row, double phi, double weight, std::span<double> f_r) {
  const Bracket at = bracket(row.phi, phi, [](double angle) { return angle; });
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    f_r[c] += weight * ((1 - at.share) * row.values[at.first * f_r.size() + c] +
                        at.share * row.values[at.second * f_r.size() + c]);
  }
}

void add_slice(const IncidenceSlice& slice, double theta_o, double phi, double weight,
               std::span<double> f_r) {
  const Bracket at =
      bracket(slice.rows, theta_o, [](const AzimuthRow& row) { return row.theta_o; });
  add_row(slice.rows[at.first], phi, weight * (1 - at.share), f_r);
  add_row(slice.rows[at.second], phi, weight * at.share, f_r);
}

}  // namespace

double largest_tabulated_theta() { return written_degrees(89); }

std::size_t full_circle_entries(const RelativeAzimuthTable& table) {
  std::size_t entries = 0;
  for (const IncidenceSlice& slice : table.slices) {
    for (const AzimuthRow& row : slice.rows) entries += 2 * row.phi.size() - 1;
  }
  return entries;
}

RelativeReflectance at_azimuth_zero(const material::Reflectance& reflectance) {
  return [reflectance](double theta_i, double theta_o, double phi, std::span<double> f_r) {
    reflectance(brdf::direction_from_radians(theta_i, 0),
                brdf::direction_from_radians(theta_o, phi), f_r);
  };
}

RelativeReflectance azimuth_mean(const material::Reflectance& reflectance,
                                 std::size_t channel_count, std::size_t count) {
  return [reflectance, count, one = Values(channel_count)](
             double theta_i, double theta_o, double phi, std::span<double> f_r) mutable {
    std::fill(f_r.begin(), f_r.end(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const double azimuth = pi * static_cast<double>(k) / static_cast<double>(count);
      reflectance(brdf::direction_from_radians(theta_i, azimuth),
                  brdf::direction_from_radians(theta_o, azimuth + phi), one);
      for (std::size_t c = 0; c < f_r.size(); ++c) f_r[c] += one[c] / static_cast<double>(count);
    }
  };
}

RelativeAzimuthTable tabulate(const RelativeReflectance& reflectance, std::size_t channel_count,
                              std::size_t most_entries) {
  constexpr double least_tolerance = 1e-3;
  constexpr int most_steps = 12;
  constexpr double full = 0.85;
  const Tabulation tabulation(reflectance, channel_count);
  if (auto table = tabulation.table(least_tolerance, most_entries)) return std::move(*table);
  // Entries fall as the tolerance grows: the smallest that fits, or nearly.
  std::optional<RelativeAzimuthTable> best;
  double low = std::log(least_tolerance);
  double high = 0;
  for (int step = 0; step < most_steps; ++step) {
    const double middle = (low + high) / 2;
    auto table = tabulation.table(std::exp(middle), most_entries);
    (table ? high : low) = middle;
    if (!table) continue;
    best = std::move(table);
    if (static_cast<double>(full_circle_entries(*best)) >
        full * static_cast<double>(most_entries)) {
      break;
    }
  }
  return best ? std::move(*best) : tabulation.table(1e300, most_entries).value();
}

void interpolate(const RelativeAzimuthTable& table, const Direction<double>& wi,
                 const Direction<double>& wo, std::span<double> f_r) {
  std::fill(f_r.begin(), f_r.end(), 0.0);
  if (!brdf::above_horizon(wi, wo)) return;
  // The angle between the projections; whatever it is at the pole, one azimuth stands there.
  const double phi = std::abs(std::atan2(wi.x * wo.y - wi.y * wo.x, wi.x * wo.x + wi.y * wo.y));
  const Bracket at = bracket(table.slices, zenith_of(wi),
                             [](const IncidenceSlice& slice) { return slice.theta_i; });
  add_slice(table.slices[at.first], zenith_of(wo), phi, 1 - at.share, f_r);
  add_slice(table.slices[at.second], zenith_of(wo), phi, at.share, f_r);
}

}  // namespace gonio::exports
