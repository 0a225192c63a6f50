#include "render/image_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "render/image_codec.h"
#include "render/tone.h"
#include "table/file_error.h"
#include "table/output_file.h"

namespace gonio::render {
namespace {

/// Where the module may be: in the folder that GONIO_MODULES names; beside the executable, as in a
/// build; in the library folder beside the executable's, as installed; in the one that was
/// installed to; and, under its bare name, wherever the loader looks.
std::vector<std::string> module_paths() {
  std::vector<std::filesystem::path> folders;
  if (const char* const named = std::getenv("GONIO_MODULES")) folders.emplace_back(named);
  std::error_code error;
  const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back(executable.parent_path());
    folders.push_back(executable.parent_path().parent_path() / GONIO_MODULES_FOLDER);
  }
  folders.emplace_back(GONIO_INSTALLED_MODULES);
  std::vector<std::string> paths;
  for (const std::filesystem::path& folder : folders) {
    paths.push_back((folder / image_codec_file).string());
  }
  paths.emplace_back(image_codec_file);
  return paths;
}

EncodeImage open_image_codec() {
  std::string tried;
  for (const std::string& path : module_paths()) {
    if (void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
      if (void* const function = ::dlsym(module, image_codec_function)) {
        return reinterpret_cast<EncodeImage>(function);
      }
    }
    const char* const reason = ::dlerror();
    tried += fmt::format("{}{}", tried.empty() ? "" : "; ", reason == nullptr ? path : reason);
  }
  throw table::FileError(fmt::format(
      "the module that writes images, {}, could not be opened: install gonio as a whole, "
      "or name the module's folder in GONIO_MODULES ({})",
      image_codec_file, tried));
}

/// Opened once, and for good.
EncodeImage image_codec() {
  static const EncodeImage encode = open_image_codec();
  return encode;
}

/// What is written to memory, so that table::write_file() puts the whole file in its place.
std::string encoded(const EncodingRequest& request, const std::string& path) {
  std::string result;
  if (image_codec()(request, result)) return result;
  throw table::FileError(fmt::format("{}: could not be encoded as {}: {}", path, request.format,
                                     result.empty() ? "OpenImageIO does not say why" : result));
}

std::string exr_of(const Image& image, const std::string& path, const ImageAttributes& attributes) {
  return encoded({"exr", image.width, image.height, image.pixels.data(), attributes}, path);
}

std::string png_of(const Image& image, double exposure, const std::string& path,
                   const ImageAttributes& attributes) {
  const auto display = display_pixels(image, exposure);
  return encoded({"png", image.width, image.height, display.data(), attributes}, path);
}

}  // namespace

ImageFormat image_format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == ".exr") return ImageFormat::exr;
  if (extension == ".png") return ImageFormat::png;
  throw std::invalid_argument(fmt::format(
      "{}: found {}, expected an image file's: name it .exr (linear radiance) or .png (8 bits)",
      path, extension.empty() ? "no extension" : fmt::format("the extension '{}'", extension)));
}

void require_image_output(const std::string& path) {
  image_format_of(path);
  image_codec();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  // A pipe or a device is not to be opened twice; of a file, one beside it tells.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return;
  const table::OutputFile beside(path);
}

void write_image(const Image& image, const std::string& path, double exposure,
                 const ImageAttributes& attributes) {
  const std::string bytes = image_format_of(path) == ImageFormat::exr
                                ? exr_of(image, path, attributes)
                                : png_of(image, exposure, path, attributes);
  table::write_file(path, bytes);
}

}  // namespace gonio::render
