// Broken files of every format: what comes of them is a table or one line that says why not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "table/describe.h"
#include "table/file_error.h"
#include "table/read.h"
#include "tests/run_gonio.h"
#include "tests/small_tables.h"

namespace gonio::tests {
namespace {

constexpr int mutilations = 500;
/// Of those, every so many is also given to the command.
constexpr int command_step = 50;

std::size_t below(std::mt19937& random, std::size_t count) {
  return static_cast<std::size_t>(random()) % count;
}

std::string truncated(std::string bytes, std::mt19937& random) {
  bytes.resize(1 + below(random, bytes.size() - 1));
  return bytes;
}

std::string flipped(std::string bytes, std::mt19937& random) {
  const std::size_t count = 1 + below(random, 8);
  for (std::size_t i = 0; i < count; ++i) {
    bytes[below(random, bytes.size())] = static_cast<char>(random());
  }
  return bytes;
}

/// Sizes stand in binary formats as 2, 4 or 8 bytes, in text as digits: both become huge.
std::string inflated(std::string bytes, std::mt19937& random) {
  const std::size_t at = below(random, bytes.size());
  const bool is_digit = bytes[at] >= '0' && bytes[at] <= '9';
  if (is_digit) return bytes.insert(at, 1 + below(random, 20), '9');
  const std::size_t length = std::min<std::size_t>(1 + below(random, 8), bytes.size() - at);
  return bytes.replace(at, length, length, below(random, 2) == 0 ? '\xff' : '\x7f');
}

std::string doubled(const std::string& bytes, std::mt19937& random) {
  const std::size_t at = below(random, bytes.size());
  return bytes.substr(0, at) + bytes.substr(below(random, bytes.size()));
}

std::string mutilated(const std::string& bytes, int way, std::mt19937& random) {
  switch (way % 4) {
    case 0:
      return truncated(bytes, random);
    case 1:
      return flipped(bytes, random);
    case 2:
      return inflated(bytes, random);
    default:
      return doubled(bytes, random);
  }
}

table::ReadOptions options_for(const SmallTable& small) {
  table::ReadOptions options;
  if (small.format == "foreign_csv") options.quantity = table::Quantity::brdf;
  if (small.format == "curet") options.material = 1;
  return options;
}

std::vector<std::string> command_for(const SmallTable& small, const std::string& path) {
  if (small.format == "foreign_csv") return {"info", path, "--quantity", "brdf"};
  if (small.format == "curet") return {"info", path, "--material", "1"};
  return {"info", path};
}

/// A table that keeps its promises.
void expect_sound(const table::SampleTable& table) {
  ASSERT_GT(table.size(), 0U);
  ASSERT_EQ(table.values.size(), table.channels.size());
  for (const auto& values : table.values) {
    ASSERT_EQ(values.size(), table.size());
    for (const double value : values) ASSERT_FALSE(std::isinf(value));
  }
  for (const double weight : table.weight) ASSERT_TRUE(std::isfinite(weight) && weight >= 0);
  table::describe(table);
}

class MutilatedTables : public testing::TestWithParam<SmallTable> {};

TEST_P(MutilatedTables, AreReadOrRefusedInOneLine) {
  const SmallTable& small = GetParam();
  const TemporaryFolder folder;
  for (const SmallTable& other : small_tables()) {
    if (other.format == small.format) folder.write(other.file, other.bytes);
  }
  const std::string path = folder / small.file;
  expect_sound(table::read(path, options_for(small)));
  std::mt19937 random(20240607);
  int refused = 0;
  for (int i = 0; i < mutilations; ++i) {
    folder.write(small.file, mutilated(small.bytes, i, random));
    try {
      expect_sound(table::read(path, options_for(small)));
    } catch (const table::FileError& error) {
      ++refused;
      const std::string message = error.what();
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
    if (i % command_step != 0) continue;
    const CommandResult result = run_gonio(command_for(small, path));
    ASSERT_THAT(result.exit_status, testing::AnyOf(0, 1, 3)) << result.err;
  }
  RecordProperty("refused", refused);
  // Nothing was tested if all were accepted.
  EXPECT_GT(refused, mutilations / 10);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, MutilatedTables, testing::ValuesIn(small_tables()), [](const auto& tested) {
      std::string name = tested.param.format + "_" + tested.param.file;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

}  // namespace
}  // namespace gonio::tests
