#include "export/shader_table.h"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <stdexcept>

#include "export/rgb.h"
#include "lut/table_exr.h"
#include "lut/table_model.h"
#include "lut/table_text.h"
#include "table/file_error.h"
#include "table/input_file.h"

namespace gonio::exports {
namespace {

using lut::Storage;

/// A storage as the graphics interfaces call it.
struct TextureFormat {
  std::string_view described;
  std::string_view components;  // of Vulkan and Direct3D, of one channel
  std::string_view vulkan_type;
  std::string_view direct3d_type;
  std::string_view opengl;  // what follows GL_R or GL_RG
};

TextureFormat format_of(Storage storage) {
  switch (storage) {
    case Storage::r32f:
      return {"32-bit float", "32", "SFLOAT", "FLOAT", "32F"};
    case Storage::r16f:
      return {"16-bit float", "16", "SFLOAT", "FLOAT", "16F"};
    case Storage::unorm16:
      return {"16-bit integers that stand for 0 to 1", "16", "UNORM", "UNORM", "16"};
    case Storage::unorm8:
      break;
  }
  return {"8-bit integers that stand for 0 to 1", "8", "UNORM", "UNORM", "8"};
}

std::string texture_line(const ShaderTable& table) {
  const lut::Texture& texture = table.table.texture;
  const TextureFormat format = format_of(texture.storage);
  const bool has_two = texture.channels == 2;
  const std::string components =
      fmt::format(fmt::runtime(has_two ? "R{0}G{0}" : "R{0}"), format.components);
  return fmt::format(
      "texture: {}: {} x {} texels of {}{}: VK_FORMAT_{}_{}, DXGI_FORMAT_{}_{}, {}{}", table.file,
      texture.width, texture.height, has_two ? "two channels of " : "", format.described,
      components, format.vulkan_type, components, format.direct3d_type, has_two ? "GL_RG" : "GL_R",
      format.opengl);
}

/// Which devices filter the format, where not all do.
std::string_view filter_line(Storage storage) {
  switch (storage) {
    case Storage::r32f:
      return "filter: not every device filters 32-bit floats: Vulkan asks for "
             "VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT, ES 3.00 and WebGL 2 for "
             "OES_texture_float_linear; 16-bit floats are filtered everywhere";
    case Storage::unorm16:
      return "filter: not every device has the format: Vulkan asks for "
             "VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT, ES 3.00 and WebGL 2 for "
             "EXT_texture_norm16; 16-bit floats are filtered everywhere";
    default:
      return {};
  }
}

/// The file has the floats that the texture's integers stand for.
std::string values_line(Storage storage) {
  if (storage != Storage::unorm16 && storage != Storage::unorm8) return {};
  return fmt::format("values: the file's floats of 0 to 1, times {} the texture's integers",
                     storage == Storage::unorm16 ? 65535 : 255);
}

}  // namespace

ShaderTable read_shader_table(const std::string& path) {
  const table::InputFile file(path);
  try {
    return {lut::table_from_exr(file.bytes()), std::filesystem::path(path).filename().string()};
  } catch (const std::runtime_error& error) {
    throw table::FileError(
        fmt::format("{}: {}; expected an EXR file that gonio lut bake wrote", path, error.what()));
  }
}

std::vector<std::string> texture_lines(const ShaderTable& table) {
  const lut::Layout& layout = table.table.layout;
  std::vector<std::string> lines{
      fmt::format("table: {} for {}", lut::name_of(layout.kind), lut::served_text(layout)),
      texture_line(table),
      "sampler: linear filter, clamped to the edge in u and v; no mipmaps, no decoding of sRGB"};
  const auto add = [&](std::string_view line) {
    if (!line.empty()) lines.emplace_back(line);
  };
  add(filter_line(layout.storage));
  add(values_line(layout.storage));
  add(layout.height == 1
          ? "rows: one; v is where its centre is"
          : "rows: the first scan line of the file is at v = 0; where a loader flips rows, read at "
            "1 - v");
  return lines;
}

material::Difference table_loss(const brdf::BoundModel& model,
                                const std::vector<std::string>& channels, const lut::Table& table) {
  const lut::TableModel served(model, table, lut::Filter::linear, lut::Weights::quantised);
  return material::difference(
      material::sample(material::reflectance_of(model), channels, incidence_for(model)),
      [&](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
          std::span<double> f_r) { served.f_r(wi, wo, f_r); });
}

}  // namespace gonio::exports
