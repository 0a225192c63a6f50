// Writes the project's own table; the other direction of gonio_csv.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "table/channel_names.h"
#include "table/direction_angles.h"
#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr std::size_t piece_size = std::size_t{1} << 16;

/// What a table is called in one line: line ends would begin a new one.
std::string one_line(std::string_view text) {
  std::string line(trimmed(text));
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return line;
}

std::vector<std::string> column_names(const SampleTable& table,
                                      std::span<const ExtraColumn> extra_columns) {
  std::vector<std::string> channels = table.channels;
  for (const ExtraColumn& extra : extra_columns) channels.push_back(extra.name);
  if (const auto problem = channel_names_problem(channels)) {
    throw FileError(fmt::format("the table's channel names: {}: rename the channel", *problem));
  }
  std::vector<std::string> names(angle_names.begin(), angle_names.end());
  names.insert(names.end(), channels.begin(), channels.end());
  if (table.has_sigma()) {
    for (const std::string& channel : table.channels) names.push_back("sigma_" + channel);
  }
  if (table.has_weight()) names.emplace_back("weight");
  return names;
}

/// Appends ",number", or an empty field for a NaN.
void append_field(double value, fmt::memory_buffer& text) {
  text.push_back(',');
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(text), "{}", value);
}

/// Appends "theta,phi" in degrees.
void append_angles(const brdf::Direction<double>& d, fmt::memory_buffer& text) {
  const AnglesDeg angles = angles_of(d);
  fmt::format_to(std::back_inserter(text), "{},{}", angles.theta, angles.phi);
}

/// A direction at the horizon may be below it by rounding.
bool is_below_horizon(const brdf::Direction<double>& d) { return d.z < -1e-8; }

bool can_be_written(const SampleTable& table, std::size_t i) {
  return !is_below_horizon(table.wi[i]) && !is_below_horizon(table.wo[i]);
}

/// Masked for a reason that a reader of the file cannot find again.
bool becomes_a_hole(MaskReason reason) {
  return reason != MaskReason::none && reason != MaskReason::horizon && reason != MaskReason::hole;
}

void append_row(const SampleTable& table, std::span<const ExtraColumn> extra_columns, std::size_t i,
                fmt::memory_buffer& text) {
  if (table.angle_text.empty()) {
    append_angles(table.wi[i], text);
    text.push_back(',');
    append_angles(table.wo[i], text);
  } else {
    text.append(table.angle_text[i]);
  }
  // The format has no mask: what nobody measured must not be read back as data.
  const bool is_measured = !becomes_a_hole(table.mask[i]);
  const auto append_measured = [&](double value) {
    append_field(is_measured ? value : std::nan(""), text);
  };
  for (const std::vector<double>& channel : table.values) append_measured(channel[i]);
  for (const ExtraColumn& extra : extra_columns) append_field(extra.values[i], text);
  for (const std::vector<double>& sigma : table.sigma) append_measured(sigma[i]);
  if (table.has_weight()) append_field(table.weight[i], text);
  text.push_back('\n');
}

}  // namespace

void write_gonio_csv(const SampleTable& table, std::span<const ExtraColumn> extra_columns,
                     const std::function<void(std::string_view)>& write) {
  const std::vector<std::string> names = column_names(table, extra_columns);
  const AngleUnit unit = table.angle_text.empty() ? AngleUnit::degrees : table.provenance.angles;
  fmt::memory_buffer text;
  const auto append = [&text](std::string_view piece) { text.append(piece); };
  append("# gonio-table 1\n# quantity: brdf\n");
  append(fmt::format("# angles: {}\n", name(unit)));
  if (const std::string title = one_line(table.name); !title.empty()) {
    append(fmt::format("# name: {}\n", title));
  }
  append(fmt::format("{}\n", fmt::join(names, ",")));
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!can_be_written(table, i)) continue;
    append_row(table, extra_columns, i, text);
    if (text.size() < piece_size) continue;
    write({text.data(), text.size()});
    text.clear();
  }
  write({text.data(), text.size()});
}

std::vector<std::string> csv_losses(const SampleTable& table) {
  std::size_t below = 0;
  std::array<std::size_t, mask_reason_count> holes{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!can_be_written(table, i)) {
      ++below;
    } else if (becomes_a_hole(table.mask[i])) {
      ++holes[static_cast<std::size_t>(table.mask[i])];
    }
  }
  std::vector<std::string> losses;
  if (table.takes_isotropy) {
    losses.emplace_back("that one azimuth of the sample stands for all is not said in the file");
  }
  if (below > 0) {
    losses.push_back(fmt::format(
        "{} samples with a direction below the horizon, which hold no measurement, are left out",
        below));
  }
  for (std::size_t reason = 0; reason < mask_reason_count; ++reason) {
    if (holes[reason] == 0) continue;
    losses.push_back(fmt::format("{} samples masked as {} are written as holes, without the reason",
                                 holes[reason], name(static_cast<MaskReason>(reason))));
  }
  return losses;
}

}  // namespace gonio::table
