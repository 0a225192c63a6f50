// Tensor files as bytes, for the tests of reading them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gonio::tests {

/// A field of 32-bit floats.
struct TensorField {
  std::string name;
  std::vector<std::uint64_t> shape;
  std::vector<float> values;
};

std::string tensor_file_of(const std::vector<TensorField>& fields);

}  // namespace gonio::tests
