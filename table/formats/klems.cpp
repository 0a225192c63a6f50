#include "table/formats/klems.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "brdf/direction.h"
#include "table/channel_names.h"
#include "table/file_error.h"
#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr std::size_t most_patches = 100'000;

/// Patches of one polar angle.
struct Ring {
  double theta_deg, lower_deg, upper_deg;
  std::size_t count;
  std::size_t first;  // patch
};

struct Basis {
  std::string name;
  std::vector<Ring> rings;
  std::size_t patches = 0;
};

/// The patches' directions, away from the surface, and projected solid angles.
struct Patches {
  std::vector<brdf::Direction<double>> directions;
  std::vector<double> lambda;
};

/// The matrix of one channel: values[exit * incident count + incident].
struct Block {
  std::string channel;
  std::vector<double> values;
};

struct Klems {
  std::string name;
  Basis incident, exit;
  std::vector<Block> blocks;
};

[[noreturn]] void refuse(const std::string& path, std::string_view place,
                         std::string_view problem) {
  throw FileError(fmt::format("{}: {}: {}", path, place, problem));
}

std::string_view text_of(const pugi::xml_node& node) { return trimmed(node.text().get()); }

double number_in(const pugi::xml_node& node, const std::string& path, std::string_view place) {
  const std::string_view text = text_of(node);
  const char* at = text.data();
  double value = 0;
  if (read_number(at, at + text.size(), value) == NumberText::number &&
      at == text.data() + text.size()) {
    return value;
  }
  refuse(path, place, fmt::format("found {}, expected a number: correct the file", quoted(text)));
}

Ring ring_of(const pugi::xml_node& block, const std::string& path, const std::string& place) {
  const pugi::xml_node bounds = block.child("ThetaBounds");
  const auto number = [&](const pugi::xml_node& node, std::string_view name) {
    return number_in(node, path, fmt::format("{} {}", place, name));
  };
  const double count = number(block.child("nPhis"), "nPhis");
  Ring ring{number(block.child("Theta"), "Theta"), number(bounds.child("LowerTheta"), "LowerTheta"),
            number(bounds.child("UpperTheta"), "UpperTheta"), 0, 0};
  if (!(count >= 1 && count <= double(most_patches) && count == std::floor(count))) {
    refuse(path, place, fmt::format("found nPhis {}, expected a whole number from 1 on", count));
  }
  if (!(ring.lower_deg >= 0 && ring.lower_deg <= ring.theta_deg &&
        ring.theta_deg <= ring.upper_deg && ring.lower_deg < ring.upper_deg &&
        ring.upper_deg <= 90)) {
    refuse(path, place,
           fmt::format("found theta {} within {} to {}, expected angles in this order from 0 to 90",
                       ring.theta_deg, ring.lower_deg, ring.upper_deg));
  }
  ring.count = static_cast<std::size_t>(count);
  return ring;
}

Basis basis_of(const pugi::xml_node& node, const std::string& path) {
  Basis basis;
  basis.name = text_of(node.child("AngleBasisName"));
  for (const pugi::xml_node& block : node.children("AngleBasisBlock")) {
    const std::string place =
        fmt::format("AngleBasis {} block {}", quoted(basis.name), basis.rings.size() + 1);
    Ring ring = ring_of(block, path, place);
    if (!basis.rings.empty() && ring.lower_deg < basis.rings.back().upper_deg) {
      refuse(path, place, "its ring overlaps the one before: expected rings in rising order");
    }
    ring.first = basis.patches;
    basis.patches += ring.count;
    if (basis.patches > most_patches) refuse(path, place, "too many patches: check nPhis");
    basis.rings.push_back(ring);
  }
  if (basis.rings.empty()) {
    refuse(path, fmt::format("AngleBasis {}", quoted(basis.name)),
           "found no AngleBasisBlock, expected one per ring of patches");
  }
  return basis;
}

const Basis& basis_named(const std::vector<Basis>& bases, std::string_view name,
                         const std::string& path) {
  const auto found = std::find_if(bases.begin(), bases.end(),
                                  [&](const Basis& basis) { return basis.name == name; });
  if (found != bases.end()) return *found;
  refuse(
      path, "WavelengthDataBlock",
      fmt::format("found the basis {}, expected one of the AngleBasis names of the file: a Klems "
                  "basis is read, a tensor tree is not",
                  quoted(name)));
}

std::vector<double> numbers_in(std::string_view text, std::size_t count, const std::string& path,
                               const std::string& place) {
  std::vector<double> values;
  // A number takes two characters at least: a declared size must not cost more than the text does.
  values.reserve(std::min(count, text.size() / 2 + 1));
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skip = [&] {
    while (at != end && (is_blank(*at) || *at == '\n' || *at == ',')) ++at;
  };
  for (skip(); at != end; skip()) {
    const char* const first = at;
    double value = 0;
    if (read_number(at, end, value) != NumberText::number) {
      constexpr std::ptrdiff_t shown = 20;
      const std::string_view found(first, static_cast<std::size_t>(std::min(shown, end - first)));
      refuse(path, place,
             fmt::format("value {}: found {}, expected a finite number", values.size() + 1,
                         quoted(found)));
    }
    if (values.size() == count) {
      refuse(path, place,
             fmt::format("found more than {} values, expected one per pair of patches", count));
    }
    values.push_back(value);
  }
  if (values.size() != count) {
    refuse(
        path, place,
        fmt::format("found {} values, expected {}, one per pair of patches", values.size(), count));
  }
  return values;
}

/// From [incident][exit] to [exit][incident].
std::vector<double> transposed(const std::vector<double>& values, std::size_t incident,
                               std::size_t exit) {
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < incident; ++i) {
    for (std::size_t o = 0; o < exit; ++o) result[o * incident + i] = values[i * exit + o];
  }
  return result;
}

/// Adds the block if it holds the front's reflection.
void add_block(const pugi::xml_node& data, const pugi::xml_node& block, bool in_columns,
               const std::vector<Basis>& bases, const std::string& path, Klems& klems) {
  if (text_of(block.child("WavelengthDataDirection")) != "Reflection Front") return;
  const std::string channel(text_of(data.child("Wavelength")));
  const std::string place = fmt::format("Reflection Front of {}", quoted(channel));
  const Basis& columns = basis_named(bases, text_of(block.child("ColumnAngleBasis")), path);
  const Basis& rows = basis_named(bases, text_of(block.child("RowAngleBasis")), path);
  const Basis& incident = in_columns ? columns : rows;
  const Basis& exit = in_columns ? rows : columns;
  if (klems.blocks.empty()) {
    klems.incident = incident;
    klems.exit = exit;
  } else if (klems.incident.name != incident.name || klems.exit.name != exit.name) {
    refuse(path, place, "its bases differ from those of the first wavelength: expected the same");
  }
  std::vector<double> values = numbers_in(block.child("ScatteringData").text().get(),
                                          columns.patches * rows.patches, path, place);
  if (!in_columns) values = transposed(values, incident.patches, exit.patches);
  klems.blocks.push_back({channel, std::move(values)});
}

void check_channels(const Klems& klems, const std::string& path) {
  if (klems.blocks.empty()) {
    refuse(path, "WavelengthData",
           "found no block of direction 'Reflection Front', expected one: a file of a "
           "transmittance holds no BRDF");
  }
  std::vector<std::string> names;
  for (const Block& block : klems.blocks) names.push_back(block.channel);
  if (const auto problem = channel_names_problem(names)) refuse(path, "Wavelength", *problem);
}

Klems parsed(std::string_view content, const std::string& path) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(content.data(), content.size());
  if (!result) {
    refuse(path, fmt::format("byte {}", result.offset),
           fmt::format("no XML that can be read ({}): check that the file is whole",
                       result.description()));
  }
  const pugi::xml_node layer = document.child("WindowElement").child("Optical").child("Layer");
  const pugi::xml_node definition = layer.child("DataDefinition");
  std::vector<Basis> bases;
  for (const pugi::xml_node& node : definition.children("AngleBasis")) {
    bases.push_back(basis_of(node, path));
  }
  const std::string_view structure = text_of(definition.child("IncidentDataStructure"));
  if (structure != "Columns" && structure != "Rows") {
    refuse(path, "IncidentDataStructure",
           fmt::format("found {}, expected Columns or Rows, a matrix; a tensor tree is not read",
                       quoted(structure)));
  }
  Klems klems;
  klems.name = text_of(layer.child("Material").child("Name"));
  for (const pugi::xml_node& data : layer.children("WavelengthData")) {
    for (const pugi::xml_node& block : data.children("WavelengthDataBlock")) {
      add_block(data, block, structure == "Columns", bases, path, klems);
    }
  }
  check_channels(klems, path);
  return klems;
}

/// `towards` is -1 for incident patches, which are named by where the light goes to.
Patches patches_of(const Basis& basis, double towards) {
  Patches patches;
  for (const Ring& ring : basis.rings) {
    const double lower = std::sin(ring.lower_deg * radians_per_degree);
    const double upper = std::sin(ring.upper_deg * radians_per_degree);
    const double lambda = std::numbers::pi / double(ring.count) * (upper - lower) * (upper + lower);
    for (std::size_t k = 0; k < ring.count; ++k) {
      auto d = brdf::direction_from_degrees(ring.theta_deg, 360.0 * double(k) / double(ring.count));
      d.x *= towards;
      d.y *= towards;
      patches.directions.push_back(d);
      patches.lambda.push_back(lambda);
    }
  }
  return patches;
}

/// The patch that holds a direction, which `towards` turns like the patches; the number of patches
/// for none.
std::size_t patch_at(const Basis& basis, const brdf::Direction<double>& d, double towards) {
  const double theta_deg = std::atan2(std::hypot(d.x, d.y), d.z) / radians_per_degree;
  const double turns = std::atan2(towards * d.y, towards * d.x) / (2 * std::numbers::pi);
  for (const Ring& ring : basis.rings) {
    if (theta_deg < ring.lower_deg || theta_deg >= ring.upper_deg) continue;
    const double count = double(ring.count);
    const auto k = static_cast<std::size_t>(std::floor((turns + 1) * count + 0.5));
    return ring.first + k % ring.count;
  }
  return basis.patches;
}

Provenance provenance_of(const std::string& path) {
  return {.path = path,
          .format = "Klems BSDF XML",
          .sha256 = {},
          .quantity = Quantity::brdf,
          .angles = AngleUnit::degrees};
}

std::vector<std::string> channels_of(const Klems& klems) {
  std::vector<std::string> channels;
  for (const Block& block : klems.blocks) channels.push_back(block.channel);
  return channels;
}

}  // namespace

bool is_klems(std::string_view content) {
  constexpr std::size_t sample_size = 4096;
  const std::string_view start = without_byte_order_mark(content).substr(0, sample_size);
  return start.starts_with('<') && start.find("<WindowElement") != std::string_view::npos;
}

SampleTable read_klems(std::string_view content, const std::string& path,
                       const ReadOptions& /*options*/) {
  Klems klems = parsed(content, path);
  const Patches incident = patches_of(klems.incident, -1);
  const Patches exit = patches_of(klems.exit, 1);
  SampleTable table;
  table.name = klems.name;
  table.channels = channels_of(klems);
  table.provenance = provenance_of(path);
  const std::size_t count = incident.lambda.size() * exit.lambda.size();
  table.wi.resize(count);
  table.wo.resize(count);
  table.weight.resize(count);
  table.mask.assign(count, MaskReason::none);
  for (std::size_t o = 0, k = 0; o < exit.lambda.size(); ++o) {
    for (std::size_t i = 0; i < incident.lambda.size(); ++i, ++k) {
      table.wi.set(k, incident.directions[i]);
      table.wo.set(k, exit.directions[o]);
      table.weight[k] = incident.lambda[i] * exit.lambda[o];
    }
  }
  for (Block& block : klems.blocks) table.values.push_back(std::move(block.values));
  table.notes.emplace_back("a patch's value is that of its centre: it is the mean over the patch");
  return table;
}

GriddedTable read_klems_grid(std::string_view content, const std::string& path) {
  const auto klems = std::make_shared<const Klems>(parsed(content, path));
  GriddedTable grid;
  grid.name = klems->name;
  grid.channels = channels_of(*klems);
  grid.provenance = provenance_of(path);
  grid.f_r = [klems](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                     std::span<double> f_r) {
    const std::size_t i = patch_at(klems->incident, wi, -1);
    const std::size_t o = patch_at(klems->exit, wo, 1);
    const bool is_inside = i < klems->incident.patches && o < klems->exit.patches;
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      f_r[c] = is_inside ? klems->blocks[c].values[o * klems->incident.patches + i]
                         : std::numeric_limits<double>::quiet_NaN();
    }
  };
  return grid;
}

}  // namespace gonio::table
