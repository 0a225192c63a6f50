#include "table/formats/openmaterial_writer.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "table/channel_wavelength.h"
#include "table/file_error.h"
#include "table/formats/openmaterial_points.h"
#include "table/json_file.h"
#include "table/uuid.h"

namespace gonio::table {

namespace {

using nlohmann::ordered_json;
using Write = std::function<void(std::string_view)>;

constexpr std::string_view standard_version = "1.0.0";

// Channels -----------------------------------------------------------------------------------

/// A channel as the rows name it, "4.65e-07" or "null".
struct WrittenChannel {
  std::size_t channel;
  double wavelength;  // m, as the text reads; 0 for null
  std::string text;
};

[[noreturn]] void refuse_channels(std::string_view problem) {
  throw FileError(fmt::format("the table's channels: {}", problem));
}

WrittenChannel written_channel(const SampleTable& table, std::size_t channel) {
  constexpr double shortest = 1e-9;
  constexpr double longest = 17.16e-3;
  const std::string& name = table.channels[channel];
  const auto wavelength = wavelength_of_channel(name);
  if (!wavelength && table.channels.size() == 1) return {channel, 0, "null"};
  if (!wavelength) {
    refuse_channels(
        fmt::format("found '{}', expected R, G and B or wavelengths such as 465nm, which the table "
                    "of OpenMATERIAL is over: take those channels only, or a single one",
                    name));
  }
  WrittenChannel written{channel, 0, fmt::format("{:.12g}", *wavelength)};
  const char* const text = written.text.data();
  std::from_chars(text, text + written.text.size(), written.wavelength);
  if (written.wavelength < shortest || written.wavelength > longest) {
    refuse_channels(
        fmt::format("found '{}', expected a wavelength from 1 nm to 17.16 mm, as "
                    "OpenMATERIAL allows: leave the channel out",
                    name));
  }
  return written;
}

/// In the order of the table: by wavelength.
std::vector<WrittenChannel> written_channels(const SampleTable& table) {
  constexpr double same_wavelength = 1e-6;  // as readers have it
  if (table.channels.empty()) refuse_channels("found none, expected one at least");
  std::vector<WrittenChannel> channels;
  for (std::size_t c = 0; c < table.channels.size(); ++c) {
    channels.push_back(written_channel(table, c));
  }
  std::stable_sort(channels.begin(), channels.end(),
                   [](const auto& a, const auto& b) { return a.wavelength < b.wavelength; });
  for (std::size_t c = 1; c < channels.size(); ++c) {
    if (channels[c].wavelength - channels[c - 1].wavelength >
        same_wavelength * channels[c].wavelength) {
      continue;
    }
    refuse_channels(
        fmt::format("found '{}' and '{}', which stand for the same wavelength, expected "
                    "different ones: leave one of them out",
                    table.channels[channels[c - 1].channel], table.channels[channels[c].channel]));
  }
  return channels;
}

/// What a reader calls the channel.
std::string name_when_read(const WrittenChannel& channel) {
  return channel.text == "null" ? "brdf" : fmt::format("{:.10g}nm", channel.wavelength * 1e9);
}

std::vector<std::string> renamed_channels(const SampleTable& table,
                                          const std::vector<WrittenChannel>& channels) {
  std::vector<std::string> renamed;
  for (const WrittenChannel& channel : channels) {
    const std::string& name = table.channels[channel.channel];
    const std::string read = name_when_read(channel);
    if (name != read) renamed.push_back(fmt::format("{} as {}", name, read));
  }
  return renamed;
}

// Identity -----------------------------------------------------------------------------------

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  template <class T>
  void add(std::span<const T> values) {
    require(EVP_DigestUpdate(context_.get(), values.data(), values.size_bytes()) == 1);
  }

  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    std::string text;
    for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  static void require(bool is_done) {
    if (is_done) return;
    throw std::runtime_error("SHA-256 is not available from OpenSSL: check its installation");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

/// The numbers of a table as it is written.
struct Body {
  std::vector<WrittenChannel> channels;
  OpenMaterialPoints points;
  std::vector<std::vector<double>> values;  // [written channel][point]
};

std::string uuid_of(const Body& body, std::string_view name) {
  Sha256 hash;
  hash.add(std::span(body.points.angles));
  for (std::size_t c = 0; c < body.channels.size(); ++c) {
    hash.add(std::span<const char>(body.channels[c].text));
    hash.add(std::span(body.values[c]));
  }
  return url_uuid(fmt::format("urn:gonio:openmaterial:table:{}:{}", hash.hexadecimal(), name));
}

// Text ---------------------------------------------------------------------------------------

std::string name_of(const SampleTable& table, const OpenMaterialMetadata& metadata) {
  if (!metadata.name.empty()) return metadata.name;
  if (!table.name.empty()) return table.name;
  const std::string stem = std::filesystem::path(table.provenance.path).stem().string();
  return stem.empty() ? "unnamed" : stem;
}

std::string sources_of(const Provenance& provenance) {
  // Not where on a disk it was: the file goes to others.
  const std::string file = std::filesystem::path(provenance.path).filename().string();
  if (file.empty()) return "a table of unknown origin";
  std::string sources = file;
  if (!provenance.format.empty()) sources += fmt::format(", {}", provenance.format);
  if (!provenance.sha256.empty()) sources += fmt::format(", SHA-256 {}", provenance.sha256);
  return sources;
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (!text.empty()) text += separator;
    text += part;
  }
  return text;
}

std::string description_of(const OpenMaterialLoss& loss) {
  const std::vector<std::string> losses = describe(loss);
  return fmt::format(
      "The reflectance f_r in 1/sr, with azimuth 0 towards the light and pi on the side of the "
      "mirror direction.{}{}{}",
      losses.empty() ? "" : " Lost on writing: ", joined(losses, "; "), losses.empty() ? "" : ".");
}

/// The document with an empty look-up table, which "[]" ends.
std::string document(const OpenMaterialMetadata& metadata, const Body& body,
                     const std::string& uuid) {
  ordered_json json;
  json["$schema"] = openmaterial_schema_url("material_brdf_schema");
  json["metadata"] = openmaterial_metadata(metadata, uuid);
  json["brdf"]["wavelengths"] = ordered_json::array();
  for (const WrittenChannel& channel : body.channels) {
    if (channel.text != "null") json["brdf"]["wavelengths"].push_back(channel.wavelength);
  }
  json["brdf"]["lookupTable"] = ordered_json::array();
  return json_text(json);
}

/// A row on a line of its own: as JSON of a library each number of it would take a line.
void write_rows(const Body& body, const Write& write) {
  constexpr std::size_t piece_size = std::size_t{1} << 16;
  fmt::memory_buffer text;
  bool is_first = true;
  for (std::size_t c = 0; c < body.channels.size(); ++c) {
    for (std::size_t point = 0; point < body.points.angles.size(); ++point) {
      const double f_r = body.values[c][point];
      if (std::isnan(f_r)) continue;
      const RelativeAngles& a = body.points.angles[point];
      fmt::format_to(std::back_inserter(text), "{}\n      [{}, {}, {}, {}, {}]",
                     is_first ? "" : ",", body.channels[c].text, a.theta_i, a.theta_o, a.phi, f_r);
      is_first = false;
      if (text.size() < piece_size) continue;
      write({text.data(), text.size()});
      text.clear();
    }
  }
  write({text.data(), text.size()});
}

void require_rows(const Body& body) {
  const auto has_value = [](const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
  };
  if (std::any_of(body.values.begin(), body.values.end(), has_value)) return;
  throw FileError(
      "the table's samples: found none that is measured and not masked, expected one at least: "
      "mask less");
}

}  // namespace

std::string openmaterial_schema_url(std::string_view schema) {
  return fmt::format(
      "https://raw.githubusercontent.com/asam-ev/OpenMATERIAL-3D/refs/tags/v{}/schemas/{}.json",
      standard_version, schema);
}

ordered_json openmaterial_metadata(const OpenMaterialMetadata& metadata, const std::string& uuid) {
  ordered_json json;
  json["name"] = metadata.name;
  json["description"] = metadata.description;
  json["uuid"] = uuid;
  json["materialVersion"] = "1.0.0";
  json["openMaterial3dVersion"] = standard_version;
  json["copyrights"] = {metadata.copyright};
  json["license"] = metadata.license;
  json["authors"] = {metadata.author};
  if (!metadata.sources.empty()) json["sources"] = metadata.sources;
  return json;
}

std::vector<std::string> describe(const OpenMaterialLoss& loss) {
  std::vector<std::string> sentences;
  const auto add_count = [&](std::size_t count, std::string_view what) {
    if (count > 0) sentences.push_back(fmt::format("{} {}", count, what));
  };
  add_count(loss.masked, "masked samples are left out");
  add_count(loss.at_horizon,
            "samples at the horizon, which the format has at 1.570796, are left out");
  add_count(loss.holes, "values that were not measured are left out");
  add_count(loss.negative, "negative values, which the format does not allow, are written as 0");
  if (loss.light_azimuths) {
    sentences.emplace_back(
        "the azimuth of the light, which the format does not have, is not kept: samples stand at "
        "the "
        "azimuth from the light");
  }
  if (loss.averaged > 0) {
    sentences.push_back(fmt::format("{} samples that share their angles became {}, their means",
                                    loss.averaged, loss.averages));
  }
  add_count(loss.moved_azimuths,
            "samples are moved by up to 2e-7 rad, since azimuths of the format end at 6.283185");
  if (loss.sigma) {
    sentences.emplace_back("the standard deviations, which the format does not have, are not kept");
  }
  if (loss.weights) {
    sentences.emplace_back("the weights, which the format does not have, are not kept");
  }
  if (!loss.renamed.empty()) {
    sentences.push_back(fmt::format("channels are wavelengths and read back under such names: {}",
                                    joined(loss.renamed, ", ")));
  }
  return sentences;
}

OpenMaterialLoss write_openmaterial(const SampleTable& table, const OpenMaterialMetadata& metadata,
                                    const Write& write) {
  OpenMaterialLoss loss;
  Body body{.channels = written_channels(table),
            .points = openmaterial_points(table, loss),
            .values = {}};
  for (const WrittenChannel& channel : body.channels) {
    body.values.push_back(openmaterial_values(body.points, table.values[channel.channel], loss));
  }
  require_rows(body);
  loss.sigma = table.has_sigma();
  loss.weights = table.has_weight();
  loss.renamed = renamed_channels(table, body.channels);
  OpenMaterialMetadata full = metadata;
  full.name = name_of(table, metadata);
  if (full.description.empty()) full.description = description_of(loss);
  if (full.sources.empty()) full.sources = sources_of(table.provenance);
  const std::string text = document(full, body, uuid_of(body, full.name));
  const std::size_t rows_begin = text.rfind("[]") + 1;
  write(std::string_view(text).substr(0, rows_begin));
  write_rows(body, write);
  write("\n    ");
  write(std::string_view(text).substr(rows_begin));
  return loss;
}

}  // namespace gonio::table
