// Writes the project's own table; the other direction of gonio_csv.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "table/channel_names.h"
#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr std::size_t piece_size = std::size_t{1} << 16;
constexpr double radians_per_degree = std::numbers::pi / 180;

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

/// Appends "theta,phi" in degrees. The reader multiplies by radians_per_degree: dividing by it
/// here leaves one rounding of each.
void append_angles(const brdf::Direction<double>& d, fmt::memory_buffer& text) {
  const double theta = std::atan2(std::hypot(d.x, d.y), d.z) / radians_per_degree;
  const double phi = std::atan2(d.y, d.x) / radians_per_degree;
  fmt::format_to(std::back_inserter(text), "{},{}", theta, phi);
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
  const bool is_measured = table.mask[i] != MaskReason::extrapolated;
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
    append_row(table, extra_columns, i, text);
    if (text.size() < piece_size) continue;
    write({text.data(), text.size()});
    text.clear();
  }
  write({text.data(), text.size()});
}

}  // namespace gonio::table
