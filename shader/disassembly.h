// Counting the operations in a shader's machine code as text: AMD's instruction set as the LLVM
// disassembler writes it, from GCN to RDNA (AMD, "RDNA 2 Instruction Set Architecture", 2020).
#pragma once

#include <string_view>

namespace gonio::shader {

/// How many instructions of a kind there are.
struct OperationCounts {
  int instructions = 0;
  /// v_exp, v_log, v_rcp, v_rsq, v_sqrt, v_sin and v_cos of floats: a quarter of the rate of
  /// others.
  int transcendental = 0;
  /// Samples and loads of images.
  int texture_reads = 0;
  /// Loads of buffers and other memory, of descriptors and constants too.
  int memory_loads = 0;
};

/// Of all lines that hold an instruction, as often as `(then repeated N times)` after it says.
OperationCounts count_operations(std::string_view disassembly);

}  // namespace gonio::shader
