// The one exception for input that cannot be used and output that cannot be written.
#pragma once

#include <stdexcept>
#include <string>

namespace gonio::table {

/// what() is one line: the file, the place in it, what was found, what was expected, what to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gonio::table
