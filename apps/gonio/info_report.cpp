#include "apps/gonio/info_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <vector>

#include "fit/options.h"
#include "table/coverage_map.h"

namespace gonio::app {
namespace {

using table::ChannelSummary;
using table::Description;
using table::IncidenceSummary;
using table::MaskReason;
using table::SampleTable;

constexpr std::size_t width = 100;
constexpr std::size_t most_channel_rows = 12;
constexpr std::size_t most_albedo_columns = 5;

double per_cent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

void add_line(std::string& text, std::string_view label, std::string_view value) {
  fmt::format_to(std::back_inserter(text), "  {:<15}{}\n", label, value);
}

/// Sentences as a list below a heading, wrapped between words.
void add_list(std::string& text, std::string_view heading,
              const std::vector<std::string>& sentences) {
  if (sentences.empty()) return;
  fmt::format_to(std::back_inserter(text), "\n{}\n", heading);
  for (const std::string& sentence : sentences) {
    std::string line = "  -";
    std::string_view rest = sentence;
    while (!rest.empty()) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(word.size() + 1, rest.size()));
      if (line.size() + 1 + word.size() > width) {
        text += line + "\n";
        line = "   ";
      }
      line += ' ';
      line += word;
    }
    text += line + "\n";
  }
}

std::string masked_text(const Description& d) {
  std::string text;
  for (std::size_t reason = 0; reason < table::mask_reason_count; ++reason) {
    if (d.masked[reason] == 0) continue;
    fmt::format_to(std::back_inserter(text), "{}{} {} ({:.1f} %)", text.empty() ? "" : ", ",
                   d.masked[reason], table::name(static_cast<MaskReason>(reason)),
                   per_cent(d.masked[reason], d.samples));
  }
  return text.empty() ? "none" : text;
}

std::string range_text(const table::Range& range) {
  return fmt::format("{:.4g} .. {:.4g}", range.minimum, range.maximum);
}

std::string reciprocity_text(const Description& d) {
  if (!d.reciprocity) return "not testable: no pair of samples has light and viewer swapped";
  return fmt::format("{:.2g} % difference (RMS) over {} swapped pairs{}",
                     100 * d.reciprocity->rms_relative, d.reciprocity->pairs,
                     d.reciprocity->assumed_isotropy ? ", taking the sample for isotropic" : "");
}

std::string models_text(const SampleTable& table, const Description& d) {
  if (d.used == 0) return "nothing";
  if (table.takes_isotropy) {
    return "isotropic models: the file takes the material for one, whatever its azimuth";
  }
  if (d.half_vectors.both)
    return "isotropic and anisotropic models: half vectors lean along x and y";
  if (d.half_vectors.along_x + d.half_vectors.along_y == 0) {
    return "diffuse models only: hardly any half vector leans away from the normal";
  }
  return fmt::format(
      "isotropic models only: half vectors lean along {}, so that alpha_x and alpha_y "
      "are not told apart",
      d.half_vectors.along_x >= d.half_vectors.along_y ? "x alone" : "y alone");
}

/// What `gonio fit` can minimise over this table without further options.
std::vector<std::string_view> metrics(const SampleTable& table) {
  std::vector<std::string_view> names{fit::name(fit::Metric::l2),
                                      fit::name(fit::Metric::cosine_l2)};
  if (table.has_sigma()) names.push_back(fit::name(fit::Metric::chi2));
  return names;
}

std::string metrics_text(const SampleTable& table) {
  return fmt::format("{}{}", fmt::join(metrics(table), ", "),
                     table.has_sigma() ? " (the table has sigma columns)"
                                       : "; chi2 with --noise (no sigma columns)");
}

void add_channels(std::string& text, const Description& d) {
  const std::size_t rows =
      d.channels.size() > most_channel_rows ? most_channel_rows - 1 : d.channels.size();
  std::size_t name_width = 7;
  for (std::size_t c = 0; c < rows; ++c) {
    name_width = std::max(name_width, d.channels[c].name.size());
  }
  fmt::format_to(std::back_inserter(text),
                 "\n{:<{}}  lowest 1/sr  highest 1/sr  negative     holes\n", "channel",
                 name_width);
  for (std::size_t c = 0; c < rows; ++c) {
    const ChannelSummary& channel = d.channels[c];
    fmt::format_to(std::back_inserter(text),
                   "{:<{}}  {:>11.4g}  {:>12.4g}  {:>6.2f} %  {:>6.2f} %\n", channel.name,
                   name_width, channel.value.minimum, channel.value.maximum,
                   per_cent(channel.negative, channel.measured), per_cent(channel.holes, d.used));
  }
  if (rows < d.channels.size()) {
    fmt::format_to(std::back_inserter(text), "... and {} more; --json lists all\n",
                   d.channels.size() - rows);
  }
}

std::string albedo_text(const IncidenceSummary& incidence, std::size_t channels) {
  if (incidence.albedo.empty()) return "too little covered";
  if (channels > most_albedo_columns) {
    std::vector<double> known;
    for (const std::optional<double>& albedo : incidence.albedo) {
      if (albedo) known.push_back(*albedo);
    }
    if (known.empty()) return "-";
    const auto [lowest, highest] = std::minmax_element(known.begin(), known.end());
    return fmt::format("{:#.3g} .. {:#.3g}", *lowest, *highest);
  }
  std::string text;
  for (const std::optional<double>& albedo : incidence.albedo) {
    text += albedo ? fmt::format("{:<#9.3g}", *albedo) : fmt::format("{:<9}", "-");
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string albedo_heading(const Description& d) {
  if (d.channels.size() > most_albedo_columns) return "of all channels";
  std::string text;
  for (const ChannelSummary& channel : d.channels) {
    text += fmt::format("{:<9}", channel.name.substr(0, 8));
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

void add_incidences(std::string& text, const Description& d, bool weight_is_solid_angle) {
  if (d.incidences.empty()) return;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{:>11}  samples  azimuths  covered  albedo {}\n", "theta_i deg",
                 albedo_heading(d));
  for (const IncidenceSummary& incidence : d.incidences) {
    const std::string angle =
        d.incidence_binned
            ? fmt::format("{:g} .. {:g}", incidence.theta_deg - 7.5, incidence.theta_deg + 7.5)
            : fmt::format("{:g}", incidence.theta_deg);
    fmt::format_to(out, "{:>11}  {:>7}  {:>8}  {:>5.0f} %  {:<6} {}\n", angle, incidence.samples,
                   incidence.azimuths, 100 * incidence.coverage, "",
                   albedo_text(incidence, d.channels.size()));
  }
  text += "covered: share of the exitant hemisphere's projected solid angle that holds samples.\n";
  text +=
      weight_is_solid_angle
          ? "albedo: an estimate, by the solid angles that the samples stand for.\n"
          : "albedo: an estimate; a direction that was not measured counts like the nearest that "
            "was.\n";
}

/// A cell as a character; those of masked samples are the legend's.
char character_of(const table::CoverageCell& cell) {
  if (!cell) return '.';
  switch (*cell) {
    case MaskReason::none:
      return '#';
    case MaskReason::horizon:
      return '-';
    case MaskReason::hole:
      return 'o';
    case MaskReason::extrapolated:
      return 'e';
    case MaskReason::padding:
      return 'p';
    case MaskReason::retro:
      return 'r';
    case MaskReason::blind_spot:
      return 'b';
  }
  return '?';
}

void add_legend(std::string& text, const std::vector<table::CoverageMap>& maps) {
  std::set<MaskReason> reasons;
  for (const table::CoverageMap& map : maps) {
    for (const auto& row : map.cells) {
      for (const table::CoverageCell& cell : row) {
        if (cell && *cell != MaskReason::none) reasons.insert(*cell);
      }
    }
  }
  text += "# samples, . none";
  for (const MaskReason reason : reasons) {
    fmt::format_to(std::back_inserter(text), ", {} masked as {}", character_of(reason),
                   table::name(reason));
  }
  text += "; left the light's side, right the mirror's.\n";
}

void add_coverage(std::string& text, const SampleTable& table, const Description& d) {
  constexpr std::size_t most_maps = 5;
  const std::vector<table::CoverageMap> maps = table::coverage_maps(table, d, most_maps);
  if (maps.empty()) return;
  auto out = std::back_inserter(text);
  constexpr std::size_t map_width = table::CoverageMap::azimuth_cells + 3;
  fmt::format_to(out, "\n{:>11}", "theta_i deg");
  for (const table::CoverageMap& map : maps) {
    fmt::format_to(out, "  {:<{}}", fmt::format("{:g}", map.theta_i_deg), map_width - 2);
  }
  text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
  for (std::size_t row = 0; row < table::CoverageMap::polar_cells; ++row) {
    fmt::format_to(out, "{:>11}", fmt::format("{}{}", row == 0 ? "theta_o " : "", row * 10));
    for (const table::CoverageMap& map : maps) {
      text += "  ";
      for (const table::CoverageCell& cell : map.cells[row]) text += character_of(cell);
      text += ' ';
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  add_legend(text, maps);
}

/// Null for a channel without an albedo.
nlohmann::ordered_json albedo_json(const std::vector<std::optional<double>>& albedo) {
  auto json = nlohmann::ordered_json::array();
  for (const std::optional<double>& value : albedo) {
    json.push_back(value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json());
  }
  return json;
}

nlohmann::ordered_json range_json(const table::Range& range) {
  return {range.minimum, range.maximum};
}

}  // namespace

std::string info_text(const SampleTable& table, const Description& d) {
  std::string text = (table.name.empty() ? table.provenance.path : table.name) + "\n";
  add_line(text, "file", table.provenance.path);
  add_line(
      text, "format",
      fmt::format("{}; quantity {}, angles in {}", table.provenance.format,
                  table::name(table.provenance.quantity), table::name(table.provenance.angles)));
  add_line(text, "sha256", table.provenance.sha256);
  add_line(text, "samples", fmt::format("{}, of which {} can be used", d.samples, d.used));
  add_line(text, "masked", masked_text(d));
  add_line(text, "angles",
           fmt::format("theta_i {} deg, theta_o {} deg", range_text(d.theta_i_deg),
                       range_text(d.theta_o_deg)));
  add_line(text, "reciprocity", reciprocity_text(d));
  add_line(text, "can be fitted", models_text(table, d));
  add_line(text, "metrics", metrics_text(table));
  add_channels(text, d);
  add_incidences(text, d, table.weight_is_solid_angle);
  add_coverage(text, table, d);
  add_list(text, "notes", table.notes);
  add_list(text, "warnings", d.warnings);
  return text;
}

nlohmann::ordered_json info_json(const SampleTable& table, const Description& d) {
  nlohmann::ordered_json json;
  json["name"] = table.name;
  json["path"] = table.provenance.path;
  json["format"] = table.provenance.format;
  json["quantity"] = table::name(table.provenance.quantity);
  json["angles"] = table::name(table.provenance.angles);
  json["sha256"] = table.provenance.sha256;
  json["samples"] = d.samples;
  json["used"] = d.used;
  auto& masked = json["masked"] = nlohmann::ordered_json::object();
  for (std::size_t reason = 1; reason < table::mask_reason_count; ++reason) {
    masked[std::string(table::name(static_cast<MaskReason>(reason)))] = d.masked[reason];
  }
  json["theta_i_deg"] = range_json(d.theta_i_deg);
  json["theta_o_deg"] = range_json(d.theta_o_deg);
  auto& channels = json["channels"] = nlohmann::ordered_json::array();
  for (const ChannelSummary& channel : d.channels) {
    channels.push_back({{"name", channel.name},
                        {"range", range_json(channel.value)},
                        {"measured", channel.measured},
                        {"negative", channel.negative},
                        {"holes", channel.holes}});
  }
  json["incidence_binned"] = d.incidence_binned;
  auto& incidences = json["incidences"] = nlohmann::ordered_json::array();
  for (const IncidenceSummary& incidence : d.incidences) {
    incidences.push_back({{"theta_deg", incidence.theta_deg},
                          {"samples", incidence.samples},
                          {"azimuths", incidence.azimuths},
                          {"coverage", incidence.coverage},
                          {"cells", incidence.cells},
                          {"albedo", albedo_json(incidence.albedo)}});
  }
  auto& reciprocity = json["reciprocity"];
  if (d.reciprocity) {
    reciprocity = {{"pairs", d.reciprocity->pairs},
                   {"rms_relative", d.reciprocity->rms_relative},
                   {"assumed_isotropy", d.reciprocity->assumed_isotropy}};
  }
  json["half_vectors"] = {{"along_x", d.half_vectors.along_x},
                          {"along_y", d.half_vectors.along_y},
                          {"anisotropic_models", d.half_vectors.both}};
  json["metrics"] = metrics(table);
  json["sigma"] = table.has_sigma();
  json["takes_isotropy"] = table.takes_isotropy;
  json["weight"] = table.has_weight();
  json["notes"] = table.notes;
  json["warnings"] = d.warnings;
  return json;
}

}  // namespace gonio::app
