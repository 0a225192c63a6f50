#include "table/formats/openmaterial_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "table/file_error.h"
#include "table/formats/openmaterial_sax.h"

namespace gonio::table {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Relative; files round wavelengths to some digits.
constexpr double same_wavelength = 1e-6;

[[noreturn]] void refuse(const std::string& path, std::string_view place,
                         std::string_view problem) {
  throw FileError(fmt::format("{}: {}: {}", path, place, problem));
}

std::string row_place(std::size_t row) { return fmt::format("/brdf/lookupTable/{}", row); }

std::string wavelength_name(double wavelength) {
  return fmt::format("{:.10g}nm", wavelength * 1e9);
}

// Channels -----------------------------------------------------------------------------------

bool is_same_wavelength(double a, double b) {
  return std::abs(a - b) <= same_wavelength * std::max(a, b);
}

/// The wavelengths that a file lists, to be found by rows.
class ListedWavelengths {
 public:
  ListedWavelengths(std::span<const double> listed, const std::string& path)
      : listed_(listed), order_(listed.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(listed[a], a) < std::pair(listed[b], b);
    });
    for (std::size_t k = 1; k < order_.size(); ++k) {
      if (!is_same_wavelength(listed[order_[k - 1]], listed[order_[k]])) continue;
      const auto [first, second] = std::minmax(order_[k - 1], order_[k]);
      refuse(path, fmt::format("/brdf/wavelengths/{}", second),
             fmt::format("found {}, which stands at {} already, expected each wavelength once: "
                         "remove one of them",
                         listed[second], first));
    }
  }

  std::optional<std::size_t> find(double wavelength) const {
    const double least = wavelength * (1 - 2 * same_wavelength);
    const auto at = std::lower_bound(order_.begin(), order_.end(), least,
                                     [&](std::size_t i, double w) { return listed_[i] < w; });
    std::optional<std::size_t> nearest;
    for (auto near = at; near != order_.end() && near - at < 4; ++near) {
      const double distance = std::abs(listed_[*near] - wavelength);
      if (!is_same_wavelength(listed_[*near], wavelength)) continue;
      if (!nearest || distance < std::abs(listed_[*nearest] - wavelength)) nearest = *near;
    }
    return nearest;
  }

 private:
  std::span<const double> listed_;
  std::vector<std::size_t> order_;  // ascending
};

struct Channels {
  std::vector<std::string> names;
  std::vector<std::uint32_t> of_row;
  std::size_t unused = 0;  // wavelengths without a row
};

Channels one_channel(const OpenMaterialText& text, const std::string& path) {
  for (std::size_t row = 0; row < text.rows.size(); ++row) {
    if (std::isnan(text.rows[row].wavelength)) continue;
    refuse(
        path, row_place(row),
        fmt::format("found the wavelength {}, expected null as in the rows before: give all rows "
                    "a wavelength, or none",
                    text.rows[row].wavelength));
  }
  return {.names = {"brdf"}, .of_row = std::vector<std::uint32_t>(text.rows.size(), 0)};
}

/// Without the wavelengths that no row has.
void drop_unused(std::span<const double> listed, Channels& channels) {
  std::vector<bool> is_used(listed.size(), false);
  for (const std::uint32_t channel : channels.of_row) is_used[channel] = true;
  std::vector<std::uint32_t> position(listed.size());
  for (std::size_t i = 0; i < listed.size(); ++i) {
    position[i] = static_cast<std::uint32_t>(channels.names.size());
    if (is_used[i]) channels.names.push_back(wavelength_name(listed[i]));
  }
  for (std::uint32_t& channel : channels.of_row) channel = position[channel];
  channels.unused = listed.size() - channels.names.size();
}

Channels channels_of(const OpenMaterialText& text, const std::string& path) {
  const ListedWavelengths listed(text.wavelengths, path);
  if (std::isnan(text.rows.front().wavelength)) return one_channel(text, path);
  Channels channels;
  channels.of_row.reserve(text.rows.size());
  double last = nan;
  for (std::size_t row = 0; row < text.rows.size(); ++row) {
    const double wavelength = text.rows[row].wavelength;
    if (wavelength == last) {
      channels.of_row.push_back(channels.of_row.back());
      continue;
    }
    const auto found = listed.find(wavelength);
    if (!found) {
      refuse(
          path, row_place(row),
          fmt::format("found the wavelength {}, expected one of /brdf/wavelengths: add it there, "
                      "or correct the row",
                      std::isnan(wavelength) ? "null" : fmt::format("{}", wavelength)));
    }
    channels.of_row.push_back(static_cast<std::uint32_t>(*found));
    last = wavelength;
  }
  drop_unused(text.wavelengths, channels);
  return channels;
}

// Directions ---------------------------------------------------------------------------------

struct HashOfAngles {
  std::size_t operator()(const RelativeAngles& a) const {
    std::uint64_t hash = 0;
    for (const double angle : {a.theta_i, a.theta_o, a.phi}) {
      // -0 equals 0, and has other bits.
      hash = (hash ^ std::bit_cast<std::uint64_t>(angle + 0.0)) * 0x9E3779B97F4A7C15;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// The different directions of all rows, in the order in which rows first name them.
class Directions {
 public:
  std::size_t position_of(const RelativeAngles& angles) {
    // The rows of a wavelength mostly follow each other as those of the one before.
    if (next_ < angles_.size() && angles_[next_] == angles) return next_++;
    const auto [found, is_new] = positions_.try_emplace(angles, angles_.size());
    if (is_new) angles_.push_back(angles);
    next_ = found->second + 1 < angles_.size() ? found->second + 1 : 0;
    return found->second;
  }

  std::vector<RelativeAngles> take() { return std::move(angles_); }

 private:
  std::vector<RelativeAngles> angles_;
  std::unordered_map<RelativeAngles, std::size_t, HashOfAngles> positions_;
  std::size_t next_ = 0;
};

/// Where each wavelength has directions of its own, most of the table is holes.
void require_shared_directions(std::size_t directions, std::size_t channels, std::size_t rows,
                               const std::string& path) {
  constexpr std::size_t most_at_all = std::size_t{1} << 22;
  constexpr std::size_t most_per_row = 8;
  if (directions <= (most_at_all + most_per_row * rows) / channels) return;
  refuse(path, "/brdf/lookupTable",
         fmt::format("found {} directions of which most of the {} wavelengths lack most, expected "
                     "shared ones: split the file by wavelengths",
                     directions, channels));
}

void write_rows(const OpenMaterialText& text, const Channels& channels,
                const std::vector<std::size_t>& positions, const std::string& path,
                OpenMaterialContents& contents) {
  for (std::size_t row = 0; row < text.rows.size(); ++row) {
    const std::size_t channel = channels.of_row[row];
    const std::size_t position = positions[row];
    if (contents.has_row[channel][position]) {
      std::size_t first = 0;
      while (channels.of_row[first] != channel || positions[first] != position) ++first;
      refuse(path, row_place(row),
             fmt::format("its wavelength and angles are those of row {}, expected one value for "
                         "each: remove one of the rows",
                         first));
    }
    contents.has_row[channel][position] = true;
    contents.values[channel][position] = text.rows[row].f_r;
    if (text.rows[row].f_r < 0) ++contents.negative;
  }
}

void add_notes(const OpenMaterialText& text, const Channels& channels,
               OpenMaterialContents& contents) {
  const auto is_oblique = [](const RelativeAngles& a) { return a.theta_i > 0 && a.theta_o > 0; };
  const auto note = [&](std::string sentence) { contents.notes.push_back(std::move(sentence)); };
  if (std::any_of(contents.angles.begin(), contents.angles.end(), is_oblique)) {
    note(
        "azimuth 0 is taken as towards the light, pi as the mirror side: the standard leaves it "
        "open");
  }
  if (std::isnan(text.rows.front().wavelength)) {
    note("the wavelength is null: the one channel is called brdf");
  }
  if (channels.unused > 0) {
    note(fmt::format("{} of the wavelengths that the file lists have no row and make no channel",
                     channels.unused));
  }
  if (contents.negative > 0) {
    note(
        fmt::format("{} values are negative, which the standard does not allow: they were taken as "
                    "they are",
                    contents.negative));
  }
}

}  // namespace

OpenMaterialContents read_openmaterial_contents(std::string_view content, const std::string& path) {
  OpenMaterialText text = parse_openmaterial(content, path);
  Channels channels = channels_of(text, path);
  std::vector<std::size_t> positions;
  positions.reserve(text.rows.size());
  Directions directions;
  for (const OpenMaterialRow& row : text.rows) {
    positions.push_back(directions.position_of({row.theta_i, row.theta_o, row.phi}));
  }
  OpenMaterialContents contents{.name = std::move(text.name),
                                .channels = channels.names,
                                .angles = directions.take(),
                                .values = {},
                                .has_row = {},
                                .notes = {}};
  const std::size_t count = contents.angles.size();
  require_shared_directions(count, channels.names.size(), text.rows.size(), path);
  contents.values.assign(channels.names.size(), std::vector<double>(count, nan));
  contents.has_row.assign(channels.names.size(), std::vector<bool>(count, false));
  write_rows(text, channels, positions, path, contents);
  add_notes(text, channels, contents);
  return contents;
}

}  // namespace gonio::table
