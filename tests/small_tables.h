// A small valid file of every format that is read: what fuzzing starts from, and what the test of
// mutilated files mutilates.
#pragma once

#include <string>
#include <vector>

namespace gonio::tests {

struct SmallTable {
  std::string format;  // "merl": also the name of its fuzzing target
  std::string file;    // a name for it
  std::string bytes;
};

/// One or more per format. CUReT's two files follow each other; the directions are called
/// table.txt.
std::vector<SmallTable> small_tables();

}  // namespace gonio::tests
