#include "render/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <string_view>

namespace gonio::render {
namespace {

OIIO::ImageSpec spec_of(const EncodingRequest& request, const OIIO::TypeDesc& type) {
  OIIO::ImageSpec spec(request.width, request.height, 4, type);
  spec.alpha_channel = 3;
  for (const auto& [name, text] : request.attributes) spec.attribute(name, text);
  if (type == OIIO::TypeDesc::FLOAT) {
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    // Else OpenImageIO writes the time of day, and no two files are alike.
    spec.attribute("DateTime", "");
  } else {
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 9);
  }
  return spec;
}

bool encode(const EncodingRequest& request, std::string& result) {
  const OIIO::TypeDesc type =
      std::string_view(request.format) == "exr" ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(request.format, &memory);
  if (output == nullptr) {
    result = OIIO::geterror();
    return false;
  }
  if (!output->open(request.format, spec_of(request, type)) ||
      !output->write_image(type, request.pixels) || !output->close()) {
    result = output->geterror();
    return false;
  }
  result.assign(bytes.begin(), bytes.end());
  return true;
}

}  // namespace
}  // namespace gonio::render

extern "C" bool gonio_encode_image_1(const gonio::render::EncodingRequest& request,
                                     std::string& result) {
  return gonio::render::encode(request, result);
}
