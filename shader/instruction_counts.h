// What a pixel shader becomes on real GPU chips, without a GPU: Mesa's driver RADV compiles for any
// chip that it knows when it is given a null device (RADV_FORCE_FAMILY), and tells of the result by
// VK_KHR_pipeline_executable_properties. Nothing is drawn.
//
// The chip is chosen by environment variables, which a process has to be started with
// (chip_environment): so there is one chip in a process, and for a chip that RADV does not know it
// aborts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "shader/disassembly.h"

namespace gonio::shader {

/// There is no Vulkan loader or no RADV, or it does not compile for the chip or tell what it made;
/// what() says which, and what to install.
class NoChipCompiler : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct InstructionCounts {
  OperationCounts operations;
  int vector_registers = 0;
  int scalar_registers = 0;
  /// The compiler's estimates, in cycles: from the first instruction to the last for a wave alone,
  /// and how long one wave keeps the busiest unit busy. Nothing was measured.
  int estimated_latency = 0;
  int estimated_inverse_throughput = 0;
  std::string disassembly;
};

/// The manifests of RADV (radeon_icd*.json) in the folders in which the Vulkan loader looks for
/// drivers.
std::vector<std::filesystem::path> radv_manifests();

/// The variables, as NAME=VALUE, of a process that is to compile for the chip: a family as RADV
/// calls it, such as polaris10, vega10 or navi21. `manifests`: one or more of them, of which those
/// for other processors do not matter.
std::vector<std::string> chip_environment(const std::string& chip,
                                          std::span<const std::filesystem::path> manifests);

/// RADV for the chip of this process.
class ChipCompiler {
 public:
  /// Throws NoChipCompiler.
  ChipCompiler();
  ChipCompiler(ChipCompiler&&) noexcept;
  ChipCompiler& operator=(ChipCompiler&&) noexcept;
  ~ChipCompiler();

  /// As the driver states it, with its version.
  std::string device_text() const;

  /// Of the fragment shader in a pipeline with the vertex shader, one RGBA32F target and no
  /// depth; both have the entry point `main`, and the vertex shader may read three float3, at the
  /// locations 0 to 2. Set 0 may have a uniform buffer at binding 0, a
  /// sampled image at binding 2 and a sampler at binding 3. Throws NoChipCompiler if the driver
  /// fails or leaves out one of the numbers.
  InstructionCounts count(std::span<const std::uint32_t> vertex_spirv,
                          std::span<const std::uint32_t> fragment_spirv) const;

 private:
  class Open;
  std::unique_ptr<Open> open_;
};

}  // namespace gonio::shader
