#include "table/formats/zemax.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "table/formats/text_lines.h"
#include "table/formats/zemax_grid.h"
#include "table/formats/zemax_lines.h"
#include "table/formats/zemax_mask.h"
#include "table/formats/zemax_text.h"
#include "table/solid_angle.h"

namespace gonio::table {

namespace {

constexpr double turn_deg = 360;

constexpr double radians_per_degree = std::numbers::pi / 180;

std::vector<double> in_radians(std::span<const double> degrees) {
  std::vector<double> radians(degrees.size());
  std::transform(degrees.begin(), degrees.end(), radians.begin(),
                 [](double angle) { return angle * radians_per_degree; });
  return radians;
}

Provenance provenance(const std::string& path) {
  return {.path = path,
          .format = "Zemax tabular BSDF",
          .sha256 = {},
          .quantity = Quantity::brdf,
          .angles = AngleUnit::degrees};
}

/// The largest difference between the first rotation and one a whole turn later, as a share of the
/// largest value; 0 if there is none.
double difference_after_a_turn(const ZemaxText& text) {
  if (text.rotations.back() - text.rotations.front() != turn_deg) return 0;
  const std::size_t count = text.incidences.size() * text.block_size();
  double largest = 0;
  double difference = 0;
  for (const std::vector<double>& values : text.values) {
    for (const double value : values) largest = std::max(largest, std::abs(value));
    const double* const last = values.data() + (text.rotations.size() - 1) * count;
    for (std::size_t i = 0; i < count; ++i) {
      difference = std::max(difference, std::abs(last[i] - values[i]));
    }
  }
  return largest > 0 ? difference / largest : 0;
}

std::vector<std::string> notes(const ZemaxText& text, const std::vector<MaskReason>& mask) {
  std::vector<std::string> notes;
  const auto padding = std::count(mask.begin(), mask.end(), MaskReason::padding);
  if (padding > 0) {
    notes.push_back(fmt::format(
        "{} samples are zeros that fill the grid beyond what was measured: masked as padding",
        padding));
  }
  if (const double difference = difference_after_a_turn(text); difference > 0) {
    notes.push_back(fmt::format(
        "rotations {} and {} are one setting, yet their values differ by up to {:.3g} of the "
        "largest: both are kept, with half the weight each; gonio table sample takes the first",
        text.rotations.front(), text.rotations.back(), difference));
  }
  if (text.rotations.size() > 1) {
    notes.emplace_back(
        "the sense of SampleRotation is not known: it was taken as turning the sample from x to y; "
        "if it is the other one, the fitted tangent is mirrored");
  }
  return notes;
}

// Samples ------------------------------------------------------------------------------------

/// `d` as the sample sees it that was turned about its normal by an angle.
brdf::Direction<double> turned_back(const brdf::Direction<double>& d, double cos, double sin) {
  return {cos * d.x + sin * d.y, cos * d.y - sin * d.x, d.z};
}

/// wo of each sample of a block, [azimuth][radial], and wi; the sample as it was turned.
struct BlockDirections {
  brdf::Direction<double> wi;
  std::vector<brdf::Direction<double>> wo;
};

BlockDirections block_directions(const ZemaxText& text, double written, double incidence) {
  const double rotation = std::fmod(written, turn_deg);  // 360 deg is 0 to the last bit
  const double cos_r = std::cos(rotation * radians_per_degree);
  const double sin_r = std::sin(rotation * radians_per_degree);
  const auto wi = brdf::direction_from_degrees(incidence, 0);
  BlockDirections directions{.wi = turned_back(wi, cos_r, sin_r), .wo = {}};
  directions.wo.reserve(text.block_size());
  for (const double azimuth : text.azimuths) {
    for (const double radial : text.radials) {
      // About the mirror direction (-wi.x, 0, wi.z), with t = (wi.z, 0, wi.x) and b = (0, 1, 0).
      const auto about = brdf::direction_from_degrees(radial, azimuth);
      directions.wo.push_back(
          turned_back({about.x * wi.z - about.z * wi.x, about.y, about.x * wi.x + about.z * wi.z},
                      cos_r, sin_r));
    }
  }
  return directions;
}

/// The widths of the azimuths' cells. Of one side only, they end in the plane of incidence, where
/// the other side begins: then the sum over this side is half of that over both.
std::vector<double> azimuth_widths(const ZemaxText& text) {
  std::vector<double> widths = azimuth_measures(in_radians(text.azimuths));
  if (!text.is_one_sided || widths.size() < 2) return widths;
  const std::vector<double>& azimuths = text.azimuths;
  const std::size_t last = azimuths.size() - 1;
  const double first_reach = (azimuths[1] - azimuths[0]) / 2;
  const double last_reach = (azimuths[last] - azimuths[last - 1]) / 2;
  widths.front() -= radians_per_degree * std::max(0.0, first_reach - azimuths[0]);
  widths.back() -= radians_per_degree * std::max(0.0, azimuths[last] + last_reach - 180);
  return widths;
}

/// Per sample, in the order of the file: the solid angle of wo times that of wi.
std::vector<double> solid_angles(const ZemaxText& text) {
  const auto rotations = azimuth_measures(in_radians(text.rotations));
  const auto incidences = zenith_measures(in_radians(text.incidences), std::numbers::pi / 2);
  const auto azimuths = azimuth_widths(text);
  const auto radials = zenith_measures(in_radians(text.radials), std::numbers::pi);
  std::vector<double> weights;
  weights.reserve(text.block_count() * text.block_size());
  for (const double rotation : rotations) {
    for (const double incidence : incidences) {
      for (const double azimuth : azimuths) {
        for (const double radial : radials) {
          weights.push_back(rotation * incidence * azimuth * radial);
        }
      }
    }
  }
  return weights;
}

void set_directions(const ZemaxText& text, SampleTable& table) {
  const std::size_t count = text.block_count() * text.block_size();
  table.wi.resize(count);
  table.wo.resize(count);
  std::size_t i = 0;
  for (const double rotation : text.rotations) {
    for (const double incidence : text.incidences) {
      const BlockDirections block = block_directions(text, rotation, incidence);
      for (const brdf::Direction<double>& wo : block.wo) {
        table.wi.set(i, block.wi);
        table.wo.set(i, wo);
        ++i;
      }
    }
  }
}

}  // namespace

bool is_zemax(std::string_view content) {
  constexpr std::size_t longest_comments = std::size_t{1} << 16;
  // Other formats may begin with one of the first two.
  constexpr std::array<std::string_view, 2> common{"source", "symmetry"};
  constexpr std::array<std::string_view, 6> own{"spectralcontent", "scattertype",
                                                "samplerotation",  "angleofincidence",
                                                "scatterazimuth",  "scatterradial"};
  const auto holds = [](const auto& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  LineReader lines(without_byte_order_mark(content.substr(0, longest_comments)));
  for (std::string_view line; lines.next(line);) {
    if (line.empty() || line.starts_with('#')) continue;
    const std::string word = first_word(line);
    if (holds(own, word)) return true;
    if (!holds(common, word)) return false;
  }
  return false;
}

SampleTable read_zemax(std::string_view content, const std::string& path,
                       const ReadOptions& /*options*/) {
  ZemaxText text = parse_zemax(content, path);
  SampleTable table;
  table.name = text.name;
  table.provenance = provenance(path);
  table.takes_isotropy = text.rotations.size() == 1;
  table.mask = mask_zemax(text);
  table.notes = notes(text, table.mask);
  set_directions(text, table);
  table.weight = solid_angles(text);
  table.weight_is_solid_angle = true;
  table.channels = std::move(text.channels);
  table.values = std::move(text.values);
  return table;
}

GriddedTable read_zemax_grid(std::string_view content, const std::string& path) {
  ZemaxText text = parse_zemax(content, path);
  const std::vector<MaskReason> mask = mask_zemax(text);
  GriddedTable table;
  table.name = text.name;
  table.channels = text.channels;
  table.notes = notes(text, mask);
  table.provenance = provenance(path);
  table.f_r = zemax_interpolation(std::move(text));
  return table;
}

}  // namespace gonio::table
