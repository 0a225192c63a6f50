#include "export/openmaterial.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "brdf/albedo.h"
#include "export/account.h"
#include "export/relative_azimuth_table.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/channel_wavelength.h"
#include "table/file_error.h"
#include "table/formats/openmaterial_writer.h"
#include "table/uuid.h"

namespace gonio::exports {
namespace {

using nlohmann::ordered_json;
using table::is_rgb_channel;
using table::openmaterial_schema_url;
using table::wavelength_of_channel;

// Wavelengths --------------------------------------------------------------------------------

/// A channel and where it stands in the table; no wavelength for one that is none.
struct TableChannel {
  std::size_t channel;
  std::optional<double> wavelength;  // m
};

[[noreturn]] void refuse(const material::Material& material, std::string_view problem) {
  throw table::FileError(fmt::format("material '{}': {}", material.name, problem));
}

void require_in_range(const material::Material& material, const TableChannel& channel) {
  constexpr double shortest = 1e-9;
  constexpr double longest = 17.16e-3;
  if (!channel.wavelength) return;
  if (*channel.wavelength >= shortest && *channel.wavelength <= longest) return;
  refuse(material, fmt::format("channels: found '{}', expected a wavelength from 1 nm to 17.16 mm, "
                               "as OpenMATERIAL allows: correct the channel's name",
                               material.channels[channel.channel]));
}

/// Every channel, in the order of the table: by wavelength.
std::vector<TableChannel> table_channels(const material::Material& material) {
  std::vector<TableChannel> channels;
  for (std::size_t c = 0; c < material.channels.size(); ++c) {
    auto wavelength = wavelength_of_channel(material.channels[c]);
    if (wavelength) wavelength = as_written(*wavelength);
    channels.push_back({c, wavelength});
    require_in_range(material, channels.back());
    if (!wavelength && material.channels.size() > 1) {
      refuse(material, fmt::format("channels: found '{}', expected R, G and B or wavelengths such "
                                   "as 465nm, which the table of OpenMATERIAL is over: rename the "
                                   "channels in a copy of the material",
                                   material.channels[c]));
    }
  }
  const auto is_shorter = [](const TableChannel& a, const TableChannel& b) {
    return a.wavelength < b.wavelength;
  };
  std::stable_sort(channels.begin(), channels.end(), is_shorter);
  for (std::size_t c = 1; c < channels.size(); ++c) {
    if (channels[c - 1].wavelength < channels[c].wavelength) continue;
    refuse(material, fmt::format("channels: found '{}' and '{}', which stand for the same "
                                 "wavelength, expected different ones: rename one of them",
                                 material.channels[channels[c - 1].channel],
                                 material.channels[channels[c].channel]));
  }
  return channels;
}

bool has_rgb(const material::Material& material) {
  return std::any_of(material.channels.begin(), material.channels.end(),
                     [](const std::string& channel) { return is_rgb_channel(channel); });
}

bool is_visible(const std::vector<TableChannel>& channels) {
  return std::all_of(channels.begin(), channels.end(), [](const TableChannel& channel) {
    return channel.wavelength && *channel.wavelength >= 380e-9 && *channel.wavelength <= 780e-9;
  });
}

std::string wavelengths_text(std::size_t count) {
  return count == 1 ? "1 wavelength" : fmt::format("{} wavelengths", count);
}

// The table and its loss ---------------------------------------------------------------------

RelativeReflectance without_tangent(const brdf::BoundModel& model) {
  // Evenly spaced azimuths of a periodic function: the mean of a lobe of 0.05 by 0.16 is good to
  // rounding with far fewer.
  constexpr std::size_t azimuths = 48;
  const material::Reflectance reflectance = material::reflectance_of(model);
  if (!model.model().is_anisotropic()) return at_azimuth_zero(reflectance);
  return azimuth_mean(reflectance, model.channel_count(), azimuths);
}

RelativeAzimuthTable sampled(const brdf::BoundModel& model, const OpenMaterialOptions& options) {
  constexpr std::size_t most_rows = 1'000'000;
  constexpr std::size_t fewest = 2500;
  const std::size_t entries =
      std::min(options.most_rows_per_wavelength, most_rows / model.channel_count());
  RelativeAzimuthTable table =
      tabulate(without_tangent(model), model.channel_count(), std::max(entries, fewest));
  for (IncidenceSlice& slice : table.slices) {
    for (AzimuthRow& row : slice.rows) {
      for (double& value : row.values) value = as_written(value);
    }
  }
  return table;
}

/// Lights midway between those of the table, which is where its interpolation is worst: as many as
/// memory should hold the directions of.
std::vector<double> lights_between(const RelativeAzimuthTable& table) {
  constexpr double degrees_per_radian = 180 / std::numbers::pi;
  std::vector<double> all;
  for (std::size_t i = 1; i < table.slices.size(); ++i) {
    const double middle = (table.slices[i - 1].theta_i + table.slices[i].theta_i) / 2;
    const double degrees = middle * degrees_per_radian;
    if (degrees <= material::largest_compared_theta_deg) all.push_back(degrees);
  }
  const std::size_t most = std::clamp<std::size_t>(100 / table.channel_count, 4, 30);
  const std::size_t step = (all.size() + most - 1) / most;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < all.size(); i += step) chosen.push_back(all[i]);
  return chosen;
}

material::Difference loss_of(const material::Material& material, const brdf::BoundModel& model,
                             const RelativeAzimuthTable& table) {
  material::Incidence incidence = material::default_incidence(model.model());
  incidence.theta_deg = lights_between(table);
  const auto samples =
      material::sample(material::reflectance_of(model), material.channels, incidence);
  return material::difference(
      samples, [&](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                   std::span<double> f_r) { interpolate(table, wi, wo, f_r); });
}

/// Whether a black table would be nearer, or the table makes up light or loses it.
bool is_useless(const material::Difference& loss, const brdf::BoundModel& model) {
  constexpr double most_albedo = 0.2;  // of the material's own where that is above 1
  const auto albedo = brdf::albedo(model, 0, 0, 0.01).values;
  const double largest = *std::max_element(albedo.begin(), albedo.end());
  return loss.rms > 1 || std::abs(loss.albedo) > most_albedo * std::max(1.0, largest);
}

std::vector<std::string> warnings_about(const material::Material& material,
                                        const brdf::BoundModel& model,
                                        const OpenMaterialOptions& options) {
  std::vector<std::string> warnings;
  if (model.model().is_anisotropic()) {
    warnings.emplace_back(
        "the format has no tangent: the table is the mean over all azimuths of the light, and the "
        "loss is mostly that of the anisotropy");
  }
  if (has_rgb(material)) {
    warnings.emplace_back(
        "the channels R, G and B stand at 611.4, 549.1 and 464.3 nm, the dominant wavelengths of "
        "the primaries of sRGB; what they were measured with is not known");
  }
  if (material.channels.size() == 1 && !wavelength_of_channel(material.channels.front())) {
    warnings.push_back(fmt::format("the channel '{}' is no wavelength: the table's is null",
                                   material.channels.front()));
  }
  const OpenMaterialOptions unknown;
  if (options.license == unknown.license || options.copyright == unknown.copyright ||
      options.author == unknown.author) {
    warnings.emplace_back(
        "the format asks for author, copyright and licence, which the material does not name: "
        "fill them in");
  }
  return warnings;
}

// The files ----------------------------------------------------------------------------------

/// Without what says where on a disk it was fitted: the file goes to others.
material::Material without_paths(material::Material material) {
  if (material.provenance) {
    material.provenance->table =
        std::filesystem::path(material.provenance->table).filename().string();
    material.provenance->command.clear();
  }
  return material;
}

std::string origin_of(const material::Material& material) {
  const std::string model =
      fmt::format("model {} evaluated by gonio {}", material.model, GONIO_VERSION);
  if (material.conversion) {
    return fmt::format("{} converted from another model", model);
  }
  if (!material.provenance || material.provenance->table.empty()) {
    return fmt::format("{} with parameters of unknown origin", model);
  }
  const std::string& name = material.provenance->table;
  if (material.provenance->sha256.empty()) return fmt::format("{} fitted to {}", model, name);
  return fmt::format("{} fitted to {} (SHA-256 {})", model, name, material.provenance->sha256);
}

/// The same for the same parameters, whatever they were fitted with.
std::string uuid_of(const material::Material& material, std::string_view kind) {
  const ordered_json all = material::to_json(material);
  const ordered_json named{{"name", all["name"]},
                           {"model", all["model"]},
                           {"channels", all["channels"]},
                           {"parameters", all["parameters"]}};
  return table::url_uuid(
      fmt::format("urn:gonio:openmaterial:{}:{}", kind,
                  named.dump(-1, ' ', false, ordered_json::error_handler_t::replace)));
}

ordered_json metadata(const material::Material& material, const Exported& exported,
                      const OpenMaterialOptions& options, std::string_view kind) {
  const std::string description = fmt::format(
      "The reflectance f_r of the model {}, as a table sampled from it by gonio {}, with azimuth 0 "
      "towards the light and pi in the mirror direction. Loss of reflected radiance, read linearly "
      "between the rows in azimuth, then exit zenith, then incident zenith: {}.{}{}",
      material.model, GONIO_VERSION, loss_text(exported.loss),
      exported.warnings.empty() ? "" : " Warnings: ", fmt::join(exported.warnings, "; "));
  return table::openmaterial_metadata(
      {.name = material.name.empty() ? material.model : material.name,
       .description = description,
       .license = options.license,
       .copyright = options.copyright,
       .author = options.author,
       .sources = {}},
      uuid_of(material, kind));
}

std::string text_of(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string material_text(const material::Material& material, const Exported& exported,
                          const std::string& stem, const OpenMaterialOptions& options) {
  ordered_json json;
  json["$schema"] = openmaterial_schema_url("material_schema");
  json["metadata"] = metadata(material, exported, options, "material");
  json["materialProperties"]["brdfUris"] = {stem + std::string(openmaterial_table_ending)};
  json["materialProperties"]["customProperties"]["gonio"] = {
      {"fittedAs", exported.fitted_as},
      {"loss",
       {{"peak", exported.loss.peak},
        {"rms", exported.loss.rms},
        {"albedo", exported.loss.albedo}}},
      {"warnings", exported.warnings},
      {"material", material::to_json(material)}};
  return text_of(json);
}

/// A row of the table on a line of its own.
void append_row(std::string& text, const std::string& wavelength, const IncidenceSlice& slice,
                const AzimuthRow& row, double phi, double f_r) {
  fmt::format_to(std::back_inserter(text), "{}\n      [{}, {:.7g}, {:.7g}, {:.7g}, {}]",
                 text.empty() ? "" : ",", wavelength, slice.theta_i, row.theta_o, phi,
                 number_text(f_r));
}

/// The azimuths of the row from 0 to 2 pi; those beyond pi mirror the others.
void append_circle(std::string& text, const std::string& wavelength, const IncidenceSlice& slice,
                   const AzimuthRow& row, std::size_t channel, std::size_t channel_count) {
  constexpr double whole_circle = 6.283185;  // as the schema has it, rounded down
  const auto append = [&](double phi, std::size_t node) {
    append_row(text, wavelength, slice, row, phi, row.values[node * channel_count + channel]);
  };
  for (std::size_t node = 0; node < row.phi.size(); ++node) append(row.phi[node], node);
  for (std::size_t node = row.phi.size() - 1; node-- > 0;) {
    append(whole_circle - row.phi[node], node);
  }
}

std::string lookup_rows(const std::vector<TableChannel>& channels,
                        const RelativeAzimuthTable& table) {
  std::string text;
  for (const TableChannel& channel : channels) {
    const std::string wavelength = channel.wavelength ? number_text(*channel.wavelength) : "null";
    for (const IncidenceSlice& slice : table.slices) {
      for (const AzimuthRow& row : slice.rows) {
        append_circle(text, wavelength, slice, row, channel.channel, table.channel_count);
      }
    }
  }
  return text;
}

std::string table_text(const material::Material& material, const Exported& exported,
                       const std::vector<TableChannel>& channels, const RelativeAzimuthTable& table,
                       const OpenMaterialOptions& options) {
  ordered_json json;
  json["$schema"] = openmaterial_schema_url("material_brdf_schema");
  json["metadata"] = metadata(material, exported, options, "brdf");
  json["metadata"]["sources"] = origin_of(material);
  if (is_visible(channels)) json["metadata"]["typicalSensorTechnology"] = "camera";
  json["brdf"]["wavelengths"] = ordered_json::array();
  for (const TableChannel& channel : channels) {
    if (channel.wavelength) json["brdf"]["wavelengths"].push_back(*channel.wavelength);
  }
  json["brdf"]["lookupTable"] = ordered_json::array();
  std::string text = text_of(json);
  // As JSON of a library each number of a row would take a line.
  return text.insert(text.rfind("[]") + 1, lookup_rows(channels, table) + "\n    ");
}

}  // namespace

Exported to_openmaterial(const material::Material& material, const std::string& stem,
                         const OpenMaterialOptions& options) {
  const std::vector<TableChannel> channels = table_channels(material);
  const brdf::BoundModel model = material::bind(material);
  const RelativeAzimuthTable table = sampled(model, options);
  Exported exported;
  exported.loss = loss_of(material, model, table);
  if (is_useless(exported.loss, model)) {
    refuse(
        material,
        fmt::format("its highlight is too narrow for a table of {} rows a wavelength (loss: {}): "
                    "export it to a target that knows such models",
                    full_circle_entries(table), loss_text(exported.loss)));
  }
  exported.fitted_as =
      fmt::format("{}OpenMATERIAL 3D table: {} of {} rows each, zeniths up to 89 deg",
                  is_exact(exported.loss) ? "exact: " : "", wavelengths_text(channels.size()),
                  full_circle_entries(table));
  exported.warnings = warnings_about(material, model, options);
  const material::Material public_part = without_paths(material);
  exported.files = {{"", material_text(public_part, exported, stem, options)},
                    {std::string(openmaterial_table_ending),
                     table_text(public_part, exported, channels, table, options)}};
  return exported;
}

}  // namespace gonio::exports
