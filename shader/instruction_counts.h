// What a pixel shader becomes on real GPU chips, without a GPU: Mesa's driver RADV has a null
// device for any chip that it knows, compiles for it, and tells of the result by
// VK_KHR_pipeline_executable_properties. Nothing is drawn.
//
// The chip is chosen by environment variables, which a process has to be started with
// (chip_environment.h): so there is one chip in a process, and for a chip that RADV does not know
// it aborts. Mesa 26.2 is said to have no null device any more.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "shader/disassembly.h"

namespace gonio::shader {

/// There is no Vulkan loader or no RADV, or it has no null device for the chip, does not compile
/// for it or does not tell what it made; what() says which, and what to install.
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

/// RADV for the chip of this process.
class ChipCompiler {
 public:
  /// `chip`: that of chip_environment(), which this process was started with. Throws
  /// NoChipCompiler, also if there is a null device of another chip, or a GPU.
  explicit ChipCompiler(std::string_view chip);
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
