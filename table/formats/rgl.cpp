#include "table/formats/rgl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "brdf/direction.h"
#include "table/channel_names.h"
#include "table/formats/rgl_warp.h"
#include "table/formats/tensor_file.h"
#include "table/solid_angle.h"

namespace gonio::table {

namespace {

using brdf::Direction;

constexpr double pi = std::numbers::pi;
constexpr double hole = std::numeric_limits<double>::quiet_NaN();
/// The file's own angles have 32 bits: its last incidence, pi/2, is off by up to 1e-7. What is
/// nearer to the horizon than ten times that counts as at it.
constexpr double horizon_cosine = 1e-6;

/// A function over the unit square, bilinear between the nodes of a grid: [row][column].
struct Grid {
  std::size_t rows = 0, columns = 0;
  std::vector<float> values{};
};

/// The nodes around a coordinate of 0..1 and how much the upper one counts.
struct Between {
  std::size_t lower;
  double share;
};

Between between(double coordinate, std::size_t nodes) {
  const double scaled = std::clamp(coordinate, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(scaled), nodes - 2);
  return {lower, scaled - static_cast<double>(lower)};
}

double bilinear(const float* values, std::size_t columns, const Between& x, const Between& y) {
  const float* const below = values + y.lower * columns + x.lower;
  const float* const above = below + columns;
  const auto along_x = [&](const float* row) {
    return (1 - x.share) * double{row[0]} + x.share * double{row[1]};
  };
  return (1 - y.share) * along_x(below) + y.share * along_x(above);
}

double look_up(const Grid& grid, const Point& p) {
  return bilinear(grid.values.data(), grid.columns, between(p.x, grid.columns),
                  between(p.y, grid.rows));
}

/// What a file holds, read and checked.
struct Rgl {
  std::vector<double> theta_i;
  std::vector<double> phi_i;
  Grid ndf, sigma;
  std::optional<Warp> vndf;
  /// [phi_i][theta_i][channel][row][column]
  std::vector<float> spectra;
  std::size_t rows = 0, columns = 0;
  std::vector<std::string> channels;
};

Grid grid_of(const TensorFile& file, std::string_view name) {
  const std::vector<std::size_t>& shape = file.shape(name);
  Grid grid;
  grid.values = file.numbers(name, 2);
  grid.rows = shape[0];
  grid.columns = shape[1];
  if (grid.rows < 2 || grid.columns < 2) {
    file.refuse(
        name, fmt::format("found {} x {} nodes, expected 2 x 2 at least", grid.rows, grid.columns));
  }
  return grid;
}

std::vector<double> incident_angles(const TensorFile& file, std::string_view name, double least,
                                    double most) {
  const std::vector<float> written = file.numbers(name, 1);
  std::vector<double> angles(written.begin(), written.end());
  constexpr double slack = 1e-5;  // files print pi/2 in 32 bits
  if (angles.empty()) file.refuse(name, "found no angle, expected one at least");
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool is_rising = i == 0 || angles[i] > angles[i - 1];
    if (is_rising && angles[i] >= least && angles[i] <= most + slack) continue;
    file.refuse(name, fmt::format("number {}: found {}, expected rising angles in radians from "
                                  "{:.4g} to {:.4g}",
                                  i, angles[i], least, most));
  }
  return angles;
}

/// The measured material's azimuths of incidence: one, or two that mean the same.
std::vector<double> isotropic_azimuths(const TensorFile& file) {
  std::vector<double> phi_i = incident_angles(file, "phi_i", -2 * pi, 2 * pi);
  if (phi_i.size() > 2) {
    file.refuse("phi_i",
                fmt::format("found {} azimuths of incidence, an anisotropic material; only "
                            "isotropic ones are read: take one measured at one azimuth",
                            phi_i.size()));
  }
  return phi_i;
}

void require_shape(const TensorFile& file, std::string_view name, const Rgl& rgl,
                   std::size_t dimensions) {
  const std::vector<std::size_t>& shape = file.shape(name);
  if (shape.size() != dimensions) {
    file.refuse(name, fmt::format("found {} dimensions, expected {}", shape.size(), dimensions));
  }
  if (shape[0] != rgl.phi_i.size() || shape[1] != rgl.theta_i.size()) {
    file.refuse(name, fmt::format("found data for {} x {} incident directions, expected {} x {} as "
                                  "in phi_i and theta_i",
                                  shape[0], shape[1], rgl.phi_i.size(), rgl.theta_i.size()));
  }
  if (shape[dimensions - 2] < 2 || shape[dimensions - 1] < 2) {
    file.refuse(name, fmt::format("found {} x {} nodes, expected 2 x 2 at least",
                                  shape[dimensions - 2], shape[dimensions - 1]));
  }
}

void refuse_negative(const TensorFile& file, std::string_view name,
                     const std::vector<float>& values) {
  const auto found = std::find_if(values.begin(), values.end(), [](float v) { return v < 0; });
  if (found == values.end()) return;
  file.refuse(name, fmt::format("number {}: found {}, expected at least 0", found - values.begin(),
                                *found));
}

Warp warp_of(const TensorFile& file, const Rgl& rgl) {
  require_shape(file, "vndf", rgl, 4);
  const std::vector<float> values = file.numbers("vndf", 4);
  refuse_negative(file, "vndf", values);
  const std::vector<std::size_t>& shape = file.shape("vndf");
  return {values, shape[0] * shape[1], shape[2], shape[3]};
}

std::vector<std::string> wavelength_names(const TensorFile& file) {
  std::vector<std::string> names;
  for (const float wavelength : file.numbers("wavelengths", 1)) {
    if (!(wavelength > 0)) {
      file.refuse("wavelengths", fmt::format("found {}, expected nanometres above 0", wavelength));
    }
    names.push_back(fmt::format("{}nm", wavelength));
  }
  if (const auto problem = channel_names_problem(names)) file.refuse("wavelengths", *problem);
  return names;
}

void read_spectra(const TensorFile& file, Rgl& rgl) {
  const bool is_rgb = file.has("rgb");
  const std::string_view name = is_rgb ? "rgb" : "spectra";
  require_shape(file, name, rgl, 5);
  rgl.channels = is_rgb ? std::vector<std::string>{"R", "G", "B"} : wavelength_names(file);
  const std::vector<std::size_t>& shape = file.shape(name);
  if (shape[2] != rgl.channels.size()) {
    file.refuse(name, fmt::format("found {} channels, expected {}", shape[2], rgl.channels.size()));
  }
  rgl.spectra = file.numbers(name, 5);
  rgl.rows = shape[3];
  rgl.columns = shape[4];
}

Rgl parsed(std::string_view content, const std::string& path) {
  const TensorFile file(content, path);
  Rgl rgl;
  rgl.phi_i = isotropic_azimuths(file);
  rgl.theta_i = incident_angles(file, "theta_i", 0, pi / 2);
  rgl.ndf = grid_of(file, "ndf");
  rgl.sigma = grid_of(file, "sigma");
  refuse_negative(file, "ndf", rgl.ndf.values);
  refuse_negative(file, "sigma", rgl.sigma.values);
  rgl.vndf = warp_of(file, rgl);
  read_spectra(file, rgl);
  return rgl;
}

/// The coordinates of a polar angle and of an azimuth, which is turned into the square.
double u_of(double theta) { return std::sqrt(2 / pi * theta); }
double v_of(double phi) {
  const double v = (phi + pi) / (2 * pi);
  return v - std::floor(v);
}

double polar_angle(const Direction<double>& d) { return std::atan2(std::hypot(d.x, d.y), d.z); }

/// The slices around an incident polar angle; azimuths of incidence mean the same, the first
/// counts.
SliceMix slices_at(const Rgl& rgl, double theta_i) {
  const auto upper = std::upper_bound(rgl.theta_i.begin(), rgl.theta_i.end(), theta_i);
  const auto i = static_cast<std::size_t>(upper - rgl.theta_i.begin());
  if (i == 0) return {{0, 0}, {1, 0}};
  if (i == rgl.theta_i.size()) return {{i - 1, i - 1}, {1, 0}};
  const double share = (theta_i - rgl.theta_i[i - 1]) / (rgl.theta_i[i] - rgl.theta_i[i - 1]);
  return {{i - 1, i}, {1 - share, share}};
}

/// The factor of all channels: f_r cos(theta_o) over rgb; NaN where nothing is reflected at all.
double lobe_factor(const Rgl& rgl, const Point& u_wm, double theta_i, double phi_i) {
  const double sigma = look_up(rgl.sigma, {u_of(theta_i), v_of(phi_i)});
  return sigma > 0 ? look_up(rgl.ndf, u_wm) / (4 * sigma) : hole;
}

double spectrum_at(const Rgl& rgl, const SliceMix& mix, std::size_t channel, const Between& x,
                   const Between& y) {
  double sum = 0;
  const std::size_t nodes = rgl.rows * rgl.columns;
  for (std::size_t k = 0; k < 2; ++k) {
    const float* const values =
        rgl.spectra.data() + (mix.slice[k] * rgl.channels.size() + channel) * nodes;
    sum += mix.share[k] * bilinear(values, rgl.columns, x, y);
  }
  return std::max(sum, 0.0);
}

void evaluate(const Rgl& rgl, const Direction<double>& wi, const Direction<double>& wo,
              std::span<double> f_r) {
  std::fill(f_r.begin(), f_r.end(), hole);
  if (!(wi.z > horizon_cosine && wo.z > horizon_cosine)) return;
  const double theta_i = polar_angle(wi);
  const double phi_i = std::atan2(wi.y, wi.x);
  const Direction<double> h = brdf::half_vector(wi, wo);
  const double phi_m = std::atan2(h.y, h.x);
  const Point u_wm{u_of(polar_angle(h)), v_of(phi_m - phi_i)};
  const SliceMix mix = slices_at(rgl, theta_i);
  const Point s = rgl.vndf->inverse(u_wm, mix);
  const double factor = lobe_factor(rgl, u_wm, theta_i, phi_i) / wo.z;
  const Between x = between(s.x, rgl.columns);
  const Between y = between(s.y, rgl.rows);
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    const double value = spectrum_at(rgl, mix, c, x, y) * factor;
    f_r[c] = std::isfinite(value) ? value : hole;
  }
}

/// A node of the grid, seen from an incident direction.
struct Node {
  Direction<double> wo;
  double factor;       // f_r over the channel's texel
  double solid_angle;  // of wo
};

/// The share of the unit square that a node stands for along one side.
double node_width(std::size_t node, std::size_t nodes) {
  const double width = 1 / static_cast<double>(nodes - 1);
  return node == 0 || node + 1 == nodes ? width / 2 : width;
}

Node node_at(const Rgl& rgl, std::size_t slice, const Direction<double>& wi, std::size_t row,
             std::size_t column) {
  const SliceMix mix{{slice, slice}, {1, 0}};
  const Point s{static_cast<double>(column) / static_cast<double>(rgl.columns - 1),
                static_cast<double>(row) / static_cast<double>(rgl.rows - 1)};
  const Point u_wm = rgl.vndf->forward(s, mix);
  const double theta_m = pi / 2 * u_wm.x * u_wm.x;
  const Direction<double> wm = brdf::direction_from_radians(theta_m, (2 * u_wm.y - 1) * pi);
  const double wi_wm = wi.x * wm.x + wi.y * wm.y + wi.z * wm.z;
  Node node{};
  node.wo = {2 * wi_wm * wm.x - wi.x, 2 * wi_wm * wm.y - wi.y, 2 * wi_wm * wm.z - wi.z};
  node.factor = lobe_factor(rgl, u_wm, rgl.theta_i[slice], 0) / node.wo.z;
  // dwo / ds: reflection about wm, polar coordinates, u = sqrt(2 theta / pi), and the warp.
  const double density = rgl.vndf->density(u_wm, mix);
  const double stretch = 4 * std::max(wi_wm, 0.0) * 2 * pi * pi * u_wm.x * std::sin(theta_m);
  node.solid_angle =
      density > 0 ? stretch / density * node_width(row, rgl.rows) * node_width(column, rgl.columns)
                  : 0;
  return node;
}

void add_sample(const Rgl& rgl, std::size_t slice, std::size_t texel, const Direction<double>& wi,
                const Node& node, double wi_measure, std::size_t i, SampleTable& table) {
  table.wi.set(i, wi);
  table.wo.set(i, node.wo);
  const bool is_visible = wi.z > horizon_cosine && node.wo.z > horizon_cosine;
  table.weight[i] = is_visible ? wi_measure * node.solid_angle : 0;
  table.mask[i] = is_visible ? MaskReason::none : MaskReason::horizon;
  bool is_hole = true;
  const std::size_t nodes = rgl.rows * rgl.columns;
  for (std::size_t c = 0; c < rgl.channels.size(); ++c) {
    const double written = rgl.spectra[(slice * rgl.channels.size() + c) * nodes + texel];
    const double value = std::max(written, 0.0) * node.factor;
    table.values[c][i] = is_visible && std::isfinite(value) ? value : hole;
    is_hole = is_hole && std::isnan(table.values[c][i]);
  }
  if (is_hole && is_visible) table.mask[i] = MaskReason::hole;
}

Provenance provenance_of(const std::string& path) {
  return {.path = path,
          .format = "RGL tensor file",
          .sha256 = {},
          .quantity = Quantity::brdf,
          .angles = AngleUnit::radians};
}

}  // namespace

bool is_rgl(std::string_view content) { return is_tensor_file(content); }

SampleTable read_rgl(std::string_view content, const std::string& path,
                     const ReadOptions& /*options*/) {
  const Rgl rgl = parsed(content, path);
  const std::size_t nodes = rgl.rows * rgl.columns;
  const std::size_t count = rgl.theta_i.size() * nodes;
  SampleTable table;
  table.channels = rgl.channels;
  table.provenance = provenance_of(path);
  table.takes_isotropy = true;
  table.weight_is_solid_angle = true;
  table.wi.resize(count);
  table.wo.resize(count);
  table.values.assign(rgl.channels.size(), std::vector<double>(count));
  table.weight.resize(count);
  table.mask.resize(count, MaskReason::none);
  const std::vector<double> wi_measures = zenith_measures(rgl.theta_i, pi / 2);
  for (std::size_t slice = 0, i = 0; slice < rgl.theta_i.size(); ++slice) {
    const Direction<double> wi = brdf::direction_from_radians(rgl.theta_i[slice], 0);
    for (std::size_t texel = 0; texel < nodes; ++texel, ++i) {
      const Node node = node_at(rgl, slice, wi, texel / rgl.columns, texel % rgl.columns);
      add_sample(rgl, slice, texel, wi, node, wi_measures[slice], i, table);
    }
  }
  table.notes.emplace_back(
      "the file holds f_r cos(theta_o): the cosine is divided out; samples are those of its own "
      "grid");
  return table;
}

GriddedTable read_rgl_grid(std::string_view content, const std::string& path) {
  const auto rgl = std::make_shared<const Rgl>(parsed(content, path));
  GriddedTable grid;
  grid.channels = rgl->channels;
  grid.provenance = provenance_of(path);
  grid.f_r = [rgl](const Direction<double>& wi, const Direction<double>& wo,
                   std::span<double> f_r) { evaluate(*rgl, wi, wo, f_r); };
  return grid;
}

}  // namespace gonio::table
