#include "table/formats/exr_table_writer.h"

#include <ImfChannelList.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "exr/memory_stream.h"
#include "table/channel_names.h"
#include "table/channel_wavelength.h"
#include "table/direction_angles.h"
#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/exr_numbers.h"
#include "table/formats/exr_table.h"

namespace gonio::table {

namespace {

/// What a file of ZIP compression compresses at a time.
constexpr int lines_per_block = 16;
constexpr std::size_t widest = 65536;
/// Rows shorter than this compress badly.
constexpr std::size_t narrowest = 16;

/// A number per sample, which becomes one pixel channel or two.
struct Quantities {
  std::string channel;
  std::function<double(std::size_t)> at;
  bool has_tail = false;
  bool is_whole = false;  // beyond FLOAT's range somewhere
};

/// The length that all runs of samples with one light have; 0 if they differ.
std::size_t common_run(const DirectionArray& wi) {
  const auto is_same = [&](std::size_t a, std::size_t b) {
    return wi.x[a] == wi.x[b] && wi.y[a] == wi.y[b] && wi.z[a] == wi.z[b];
  };
  std::size_t run = 0;
  for (std::size_t begin = 0; begin < wi.size();) {
    std::size_t end = begin + 1;
    while (end < wi.size() && is_same(begin, end)) ++end;
    if (run != 0 && run != end - begin) return 0;
    run = end - begin;
    begin = end;
  }
  return run;
}

struct Size {
  std::size_t width, height;
};

/// A row per light where that makes rows of one length, else about a square.
Size size_of(const SampleTable& table) {
  const std::size_t run = common_run(table.wi);
  const auto root =
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(table.size()))));
  const std::size_t width =
      run >= narrowest && run <= widest ? run : std::clamp<std::size_t>(root, 1, widest);
  return {width, (table.size() + width - 1) / width};
}

/// Whether a pixel channel may be called like this: a point would make layers of it.
bool can_be_pixel_channel(const std::string& name) {
  return name != "mask" && name.size() < 200 && name.find('.') == std::string::npos;
}

std::vector<std::string> pixel_channels(const std::vector<std::string>& channels) {
  std::set<std::string> taken(channels.begin(), channels.end());
  std::vector<std::string> names;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::string name = channels[c];
    if (!can_be_pixel_channel(name)) {
      name = fmt::format("channel{}", c + 1);
      while (!taken.insert(name).second) name += '_';
    }
    names.push_back(name);
  }
  return names;
}

/// In degrees, by Angle.
using AngleColumns = std::array<std::vector<double>, 4>;

/// A grid repeats its directions.
void append_angles(const DirectionArray& directions, std::vector<double>& theta,
                   std::vector<double>& phi) {
  brdf::Direction<double> last{0, 0, 1};
  AnglesDeg angles{0, 0};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const brdf::Direction<double> d = directions[i];
    if (d.x != last.x || d.y != last.y || d.z != last.z) {
      last = d;
      angles = angles_of(d);
    }
    theta.push_back(angles.theta);
    phi.push_back(angles.phi);
  }
}

AngleColumns angle_columns_of(const SampleTable& table) {
  AngleColumns columns;
  for (std::vector<double>& column : columns) column.reserve(table.size());
  append_angles(table.wi, columns[theta_i], columns[phi_i]);
  append_angles(table.wo, columns[theta_o], columns[phi_o]);
  return columns;
}

std::vector<Quantities> quantities_of(const SampleTable& table, const AngleColumns& angles,
                                      const std::vector<std::string>& pixels) {
  const auto column = [](const std::vector<double>& values) {
    return [&values](std::size_t i) { return values[i]; };
  };
  std::vector<Quantities> all;
  for (std::size_t a = 0; a < angles.size(); ++a) {
    all.push_back({angle_names[a], column(angles[a])});
  }
  for (std::size_t c = 0; c < pixels.size(); ++c) {
    all.push_back({pixels[c], column(table.values[c])});
    if (table.has_sigma()) all.push_back({"sigma_" + pixels[c], column(table.sigma[c])});
  }
  if (table.has_weight()) all.push_back({"weight", column(table.weight)});
  return all;
}

void find_tails(std::size_t count, std::vector<Quantities>& all) {
  for (Quantities& quantity : all) {
    for (std::size_t i = 0; i < count; ++i) {
      const double value = quantity.at(i);
      quantity.has_tail = quantity.has_tail || tail_of(value) != 0;
      quantity.is_whole = quantity.is_whole || !has_float_range(value);
    }
  }
}

/// A pixel channel of 32 bits, and what stands in it.
struct Plane {
  std::string channel;
  Imf::PixelType type;
  std::function<std::uint32_t(std::size_t)> bits;
  std::vector<std::uint32_t> block{};
};

std::vector<Plane> planes_of(const std::vector<Quantities>& all, const SampleTable& table,
                             bool is_exact) {
  std::vector<Plane> planes;
  for (const Quantities& quantity : all) {
    planes.push_back({quantity.channel, Imf::FLOAT, [at = quantity.at, is_exact](std::size_t i) {
                        const double value = at(i);
                        return std::bit_cast<std::uint32_t>(is_exact ? head_of(value)
                                                                     : rounded(value));
                      }});
    // Also without tails: rounded to FLOAT's range, such a number would lose more than 24 bits.
    if (quantity.is_whole) {
      planes.push_back({quantity.channel + ".high", Imf::UINT, [at = quantity.at](std::size_t i) {
                          return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(at(i)) >>
                                                            32);
                        }});
      planes.push_back({quantity.channel + ".low", Imf::UINT, [at = quantity.at](std::size_t i) {
                          return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(at(i)));
                        }});
    } else if (is_exact && quantity.has_tail) {
      planes.push_back({quantity.channel + ".tail", Imf::UINT,
                        [at = quantity.at](std::size_t i) { return tail_of(at(i)); }});
    }
  }
  const bool is_masked = std::any_of(table.mask.begin(), table.mask.end(),
                                     [](MaskReason reason) { return reason != MaskReason::none; });
  if (is_masked) {
    planes.push_back({"mask", Imf::UINT, [&table](std::size_t i) {
                        return static_cast<std::uint32_t>(table.mask[i]);
                      }});
  }
  return planes;
}

std::vector<float> wavelengths_of(const SampleTable& table) {
  std::vector<float> wavelengths;
  for (const std::string& channel : table.channels) {
    const auto wavelength = wavelength_of_channel(channel);
    if (!wavelength || is_rgb_channel(channel)) return {};
    wavelengths.push_back(static_cast<float>(*wavelength * 1e9));
  }
  return wavelengths;
}

void insert_attributes(const SampleTable& table, const std::vector<std::string>& pixels,
                       Imf::Header& header) {
  const auto insert = [&](const char* attribute, const auto& value) {
    header.insert(attribute, value);
  };
  const auto list = [](const std::vector<std::string>& texts) {
    return Imf::StringVectorAttribute(texts);
  };
  insert(exr_attribute::version, Imf::IntAttribute(exr_table_version));
  insert(exr_attribute::samples, Imf::IntAttribute(static_cast<int>(table.size())));
  insert(exr_attribute::quantity, Imf::StringAttribute("brdf"));
  insert(exr_attribute::units, list({"1/sr", "deg"}));
  insert(exr_attribute::axes, list({angle_names.begin(), angle_names.end()}));
  insert(exr_attribute::channels, list(table.channels));
  insert(exr_attribute::pixel_channels, list(pixels));
  if (table.weight_is_solid_angle) insert(exr_attribute::solid_angle, Imf::IntAttribute(1));
  if (table.takes_isotropy) insert(exr_attribute::isotropy, Imf::IntAttribute(1));
  insert(exr_attribute::name, Imf::StringAttribute(table.name));
  const Provenance& provenance = table.provenance;
  insert(exr_attribute::source,
         list({std::filesystem::path(provenance.path).filename().string(), provenance.format,
               provenance.sha256, std::string(name(provenance.quantity)),
               std::string(name(provenance.angles))}));
  if (!table.notes.empty()) insert(exr_attribute::notes, list(table.notes));
  if (const auto wavelengths = wavelengths_of(table); !wavelengths.empty()) {
    insert(exr_attribute::wavelengths, Imf::FloatVectorAttribute(wavelengths));
  }
  std::vector<std::string> reasons;
  for (std::size_t reason = 0; reason < mask_reason_count; ++reason) {
    reasons.emplace_back(name(static_cast<MaskReason>(reason)));
  }
  insert(exr_attribute::mask_reasons, list(reasons));
}

/// Fills the planes with the samples of some lines; pixels behind the last sample are 0.
void fill(std::vector<Plane>& planes, const Size& size, std::size_t first_line,
          std::size_t end_line, std::size_t samples) {
  for (Plane& plane : planes) {
    plane.block.assign((end_line - first_line) * size.width, 0);
    const std::size_t first = first_line * size.width;
    const std::size_t end = std::min(end_line * size.width, samples);
    for (std::size_t i = first; i < end; ++i) plane.block[i - first] = plane.bits(i);
  }
}

void write_pixels(Imf::OutputFile& file, std::vector<Plane>& planes, const Size& size,
                  std::size_t samples) {
  for (std::size_t line = 0; line < size.height; line += lines_per_block) {
    const std::size_t end = std::min<std::size_t>(line + lines_per_block, size.height);
    fill(planes, size, line, end, samples);
    Imf::FrameBuffer buffer;
    for (Plane& plane : planes) {
      buffer.insert(plane.channel, Imf::Slice::Make(plane.type, plane.block.data(),
                                                    Imath::V2i(0, static_cast<int>(line)),
                                                    static_cast<std::int64_t>(size.width),
                                                    static_cast<std::int64_t>(end - line)));
    }
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(end - line));
  }
}

void check(const SampleTable& table) {
  if (const auto problem = channel_names_problem(table.channels)) {
    throw FileError(fmt::format("the table's channel names: {}: rename the channel", *problem));
  }
  if (table.size() == 0) {
    throw FileError("the table has no samples, expected one at least: an image needs a pixel");
  }
  if (table.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw FileError("the table has more samples than an EXR image of gonio holds, 2^31 - 1");
  }
}

}  // namespace

std::vector<std::string> write_exr_table(const SampleTable& table, const ExrTableOptions& options,
                                         const std::function<void(std::string_view)>& write) {
  check(table);
  const std::vector<std::string> pixels = pixel_channels(table.channels);
  const AngleColumns angles = angle_columns_of(table);
  std::vector<Quantities> quantities = quantities_of(table, angles, pixels);
  find_tails(table.size(), quantities);
  std::vector<Plane> planes = planes_of(quantities, table, options.exact);

  const Size size = size_of(table);
  Imf::Header header(static_cast<int>(size.width), static_cast<int>(size.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  insert_attributes(table, pixels, header);
  for (const Plane& plane : planes)
    header.channels().insert(plane.channel, Imf::Channel(plane.type));
  exr::MemoryOutput stream;
  {
    // Its end writes the table of the scan lines.
    Imf::OutputFile file(stream, header, 0);
    write_pixels(file, planes, size, table.size());
  }
  write(stream.text());
  const bool is_rounded =
      std::any_of(quantities.begin(), quantities.end(),
                  [](const Quantities& q) { return q.has_tail && !q.is_whole; });
  if (options.exact || !is_rounded) return {};
  return {"numbers are rounded to 24 bits, relatively by at most 6e-08"};
}

}  // namespace gonio::table
