// The module that encodes images: what it is asked, and its one function.
//
// OpenImageIO brings some 270 shared libraries along, whose loading takes 0.2 s and 120 MB. So that
// only a command that writes a picture pays for it, it is linked to a module of its own, which
// image_file.cpp opens when it is needed.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gonio::render {

/// Four channels, RGBA, of one picture.
struct EncodingRequest {
  const char* format;  // OpenImageIO's name: "exr" (32-bit float) or "png" (8 bits)
  int width;
  int height;
  const void* pixels;  // float for exr, unsigned char for png
  std::vector<std::pair<std::string, std::string>> attributes;
};

/// Writes the file's bytes to `result`, or why there are none. Returns whether it could.
using EncodeImage = bool (*)(const EncodingRequest& request, std::string& result);

inline constexpr const char* image_codec_file = "gonio_image_codec.so";
/// With a number that grows when EncodingRequest changes, so that no module of another version is
/// taken.
inline constexpr const char* image_codec_function = "gonio_encode_image_1";

}  // namespace gonio::render
