// Pictures as files, by OpenImageIO: linear OpenEXR or tone-mapped PNG, whole or not at all.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/image.h"

namespace gonio::render {

enum class ImageFormat { exr, png };

/// By the extension, in either case. Throws std::invalid_argument for any but .exr and .png.
ImageFormat image_format_of(const std::string& path);

/// Texts that the file carries: EXR string attributes, PNG text chunks.
using ImageAttributes = std::vector<std::pair<std::string, std::string>>;

/// Throws as write_image() would for a file that cannot be written, before anything is rendered.
void require_image_output(const std::string& path);

/// EXR: the radiance in 32-bit float, colours associated with alpha, whatever the exposure. PNG: 8
/// bits per channel, display_pixels(). Throws as image_format_of(), and table::FileError if the
/// file cannot be written.
void write_image(const Image& image, const std::string& path, double exposure = 0,
                 const ImageAttributes& attributes = {});

}  // namespace gonio::render
