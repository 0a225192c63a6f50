// A Vulkan device that runs compute shaders, headless: on a GPU, or on the CPU by a software driver
// such as Mesa's lavapipe.
//
// The Vulkan loader is opened when it is first asked for, so that a program which links this room
// also starts where no Vulkan is installed, and stays open. The drivers are those that it finds
// then; its environment variables VK_DRIVER_FILES and VK_ICD_FILENAMES choose among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "lut/texture.h"

namespace gonio::shader {

/// There is no Vulkan loader, no driver, or no device of Vulkan 1.1 that can compute; what() says
/// which, and what to install.
class NoVulkanDevice : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// In the order of preference.
enum class DeviceType { discrete_gpu, integrated_gpu, virtual_gpu, cpu, other };

struct DeviceDescription {
  std::string name;
  std::string driver;  // name and version, as the driver states them; may be empty
  DeviceType type;
  std::string api_version;  // 1.3.230
};

/// "discrete GPU", "CPU", ..
std::string_view name_of(DeviceType type);

/// "llvmpipe .. (CPU; driver llvmpipe, Mesa ..; Vulkan 1.3.230)"
std::string text_of(const DeviceDescription& device);

/// A texture and the filter of the sampler that reads it; the sampler clamps, and there are no
/// mipmaps.
struct SampledTexture {
  const lut::Texture& texture;
  lut::Filter filter = lut::Filter::linear;
};

/// The devices that VulkanDevice can open, the best first. Empty if there are drivers but no such
/// device. Throws NoVulkanDevice without a loader or a driver.
std::vector<DeviceDescription> vulkan_devices();

/// An open device. Not to be used by two threads at once.
class VulkanDevice {
 public:
  /// Opens the best device whose name contains `name`; any name does if it is empty. Throws
  /// NoVulkanDevice if there is no device at all, std::invalid_argument with the names of those
  /// there are if none is meant, and std::runtime_error if the driver fails.
  explicit VulkanDevice(std::string_view name = {});
  VulkanDevice(VulkanDevice&&) noexcept;
  VulkanDevice& operator=(VulkanDevice&&) noexcept;
  ~VulkanDevice();

  const DeviceDescription& description() const;

  /// Runs a compute shader once per element and returns the output buffer.
  ///
  /// `spirv` is a valid module as compile() returns it, with the entry point `main`, a local size
  /// of 64, the input as a storage buffer of floats at binding 0 of set 0, the output as one at
  /// binding 1, and a push constant uint: how many elements there are. The invocation of index i
  /// reads the i-th of `count` equal shares of the input and writes the i-th of the output, and
  /// nothing if i is not below the push constant. What it does not write is 0. More elements than
  /// the device takes at once are done in turn, each part with buffers and an index of its own.
  ///
  /// With a texture the shader finds it as a sampled image (binding 2 of set 0) and a sampler
  /// (binding 3).
  ///
  /// Throws std::invalid_argument if the sizes are no multiples of `count` or the texture is larger
  /// than the device's limit, std::runtime_error with the driver's message if it fails, has too
  /// little memory, or does not filter the texture's format.
  std::vector<float> run(std::span<const std::uint32_t> spirv, std::span<const float> input,
                         std::size_t output_size, std::uint32_t count,
                         const SampledTexture* texture = nullptr);

 private:
  class Open;
  std::unique_ptr<Open> open_;
};

}  // namespace gonio::shader
