#include "export/rgb.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <string_view>

#include "brdf/free_frame.h"
#include "material/evaluate.h"
#include "table/channel_wavelength.h"
#include "table/file_error.h"

namespace gonio::exports {
namespace {

constexpr std::array<std::string_view, 3> colour_names{"R", "G", "B"};

using Channels = std::array<std::size_t, 3>;

/// The position of a channel that is named by one letter, in either case.
std::optional<std::size_t> position_of(const std::vector<std::string>& channels, char letter) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const std::string& name) {
    return name.size() == 1 && (name[0] == letter || name[0] == letter - 'A' + 'a');
  });
  if (found == channels.end()) return {};
  return std::size_t(found - channels.begin());
}

std::optional<Channels> by_name(const std::vector<std::string>& channels) {
  Channels found{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto position = position_of(channels, colour_names[c][0]);
    if (!position) return {};
    found[c] = *position;
  }
  return found;
}

/// By wavelengths that differ and are written as such.
std::optional<Channels> by_wavelength(const std::vector<std::string>& channels) {
  std::array<double, 3> wavelengths{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto wavelength = table::wavelength_of_channel(channels[c]);
    if (!wavelength || table::is_rgb_channel(channels[c])) return {};
    wavelengths[c] = *wavelength;
  }
  Channels order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return wavelengths[a] > wavelengths[b]; });
  const bool differ = wavelengths[order[0]] > wavelengths[order[1]] &&
                      wavelengths[order[1]] > wavelengths[order[2]];
  return differ ? std::optional(order) : std::nullopt;
}

bool is_invisible(const std::string& channel) {
  const auto wavelength = table::wavelength_of_channel(channel);
  return wavelength && (*wavelength < 380e-9 || *wavelength > 780e-9);
}

std::string statement_of(const std::vector<std::string>& channels, const Channels& order,
                         std::string_view how) {
  return fmt::format("R is the channel '{}', G '{}', B '{}'{}", channels[order[0]],
                     channels[order[1]], channels[order[2]], how);
}

/// f_r of R, G and B.
material::Reflectance rgb_reflectance(const brdf::BoundModel& model, const RgbChannels& rgb) {
  std::vector<double> all(model.channel_count());
  return [&model, &rgb, all](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                             std::span<double> values) mutable {
    model.f_r(wi, wo, all);
    for (std::size_t c = 0; c < 3; ++c) values[c] = all[rgb.channel[c]];
  };
}

/// The values of psi among the shape parameters.
std::vector<double> tangents_of(const brdf::BoundModel& model) {
  std::vector<double> tangents;
  for (std::size_t p = 0; p < model.shape().size(); ++p) {
    if (model.model().shape()[p].descriptor.name == brdf::tangent_angle.name) {
      tangents.push_back(model.shape()[p]);
    }
  }
  if (tangents.empty()) tangents.push_back(0);
  return tangents;
}

/// Refuses what no fit can follow: the squares of its values leave the numbers.
void require_sane(const RgbMaterial& rgb) {
  constexpr double brightest = 1e30;
  for (const std::vector<double>& channel : rgb.samples.values) {
    const double largest = *std::max_element(channel.begin(), channel.end());
    if (largest <= brightest) continue;
    throw table::FileError(fmt::format(
        "material '{}': f_r reaches {:.2g} 1/sr, which no renderer shows: check its amplitudes",
        rgb.material->name, largest));
  }
}

}  // namespace

std::optional<RgbChannels> find_rgb_channels(const material::Material& material) {
  const std::vector<std::string>& channels = material.channels;
  if (channels.size() == 1) {
    return RgbChannels{{0, 0, 0},
                       fmt::format("R, G and B are the one channel '{}'", channels[0]),
                       is_invisible(channels[0])};
  }
  if (channels.size() != 3) return {};
  if (const auto order = by_name(channels)) {
    return RgbChannels{*order, statement_of(channels, *order, ""), false};
  }
  if (const auto order = by_wavelength(channels)) {
    return RgbChannels{*order, statement_of(channels, *order, ", by wavelength"),
                       std::any_of(channels.begin(), channels.end(), is_invisible)};
  }
  return {};
}

RgbChannels rgb_channels(const material::Material& material) {
  if (auto found = find_rgb_channels(material)) return *std::move(found);
  const std::vector<std::string>& channels = material.channels;
  constexpr std::size_t most_named = 8;
  const std::vector<std::string> named(
      channels.begin(), channels.begin() + std::ptrdiff_t(std::min(most_named, channels.size())));
  throw table::FileError(fmt::format(
      "material '{}': channels: found {} ({}{}), expected R, G and B, three wavelengths such as "
      "630nm, 525nm, 465nm, or a single channel: fit a table with three channels, or name the "
      "three that are meant R, G and B in a copy of the material",
      material.name, channels.size(), fmt::join(named, ", "),
      channels.size() > named.size() ? ", ..." : ""));
}

material::Incidence incidence_for(const brdf::BoundModel& model) {
  material::Incidence incidence = material::default_incidence(model.model());
  // A quarter turn from the tangent shows all that a lobe with two planes of symmetry does.
  const double tangent = tangents_of(model).front();
  for (double& phi_deg : incidence.phi_deg) phi_deg += tangent * (180 / std::numbers::pi);
  return incidence;
}

RgbMaterial rgb_material(const material::Material& material) {
  RgbMaterial rgb{&material, material::bind(material), rgb_channels(material), {}, {}};
  const std::array names{material.channels[rgb.channels.channel[0]],
                         material.channels[rgb.channels.channel[1]],
                         material.channels[rgb.channels.channel[2]]};
  rgb.tangents = tangents_of(rgb.model);
  rgb.samples =
      material::sample(rgb_reflectance(rgb.model, rgb.channels), names, incidence_for(rgb.model));
  require_sane(rgb);
  return rgb;
}

}  // namespace gonio::exports
