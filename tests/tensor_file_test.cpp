// The container of the RGL database.
#include "table/formats/tensor_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "table/file_error.h"
#include "tests/tensor_bytes.h"

namespace gonio::tests {
namespace {

using table::TensorFile;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string two_fields =
    tensor_file_of({{"a", {2, 3}, {1, 2, 3, 4, 5, 6}}, {"wavelengths", {1}, {550}}});

std::string refusal(const std::string& content, const std::string& name = "a",
                    std::size_t dimensions = 2) {
  try {
    TensorFile(content, "t.bsdf").numbers(name, dimensions);
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

/// With `value` written at `at`.
template <class T>
std::string patched(std::string bytes, std::size_t at, T value) {
  return bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

// The first field's description begins at 18: length 2, "a", dimensions at 21, type at 23, offset
// at 24, sizes at 32 and 40.

TEST(TensorFile, GivesFieldsByName) {
  const TensorFile file(two_fields, "t.bsdf");
  EXPECT_TRUE(file.has("a"));
  EXPECT_FALSE(file.has("b"));
  EXPECT_THAT(file.shape("a"), ElementsAre(2U, 3U));
  EXPECT_THAT(file.numbers("a", 2), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(file.numbers("wavelengths", 1), ElementsAre(550));
}

TEST(TensorFile, ReadsDoublesToo) {
  std::string bytes = patched(two_fields, 23, std::uint8_t{11});
  bytes = patched(bytes, 32, std::uint64_t{1});  // 1 x 3 doubles in the place of 6 floats
  const std::size_t data = bytes.size() - 28;
  bytes = patched(patched(patched(bytes, data, 0.5), data + 8, 1.5), data + 16, 2.5);
  EXPECT_THAT(TensorFile(bytes, "t.bsdf").numbers("a", 2), ElementsAre(0.5, 1.5, 2.5));
}

TEST(TensorFile, RefusesWhatIsCutOffAtEveryPlace) {
  for (std::size_t size = 12; size < two_fields.size(); ++size) {
    EXPECT_THAT(refusal(two_fields.substr(0, size)), HasSubstr("t.bsdf: "));
  }
}

TEST(TensorFile, RefusesSizesBeyondTheFile) {
  EXPECT_THAT(refusal(patched(two_fields, 32, std::uint64_t{1} << 62)), HasSubstr("field 'a'"));
  EXPECT_THAT(
      refusal(patched(patched(two_fields, 32, std::uint64_t{1} << 32), 40, std::uint64_t{1} << 32)),
      HasSubstr("4294967296 x 4294967296"));
  EXPECT_THAT(refusal(patched(two_fields, 24, std::uint64_t{1} << 40)),
              HasSubstr("ends within the file"));
  EXPECT_THAT(refusal(patched(two_fields, 14, std::uint32_t{3})), HasSubstr("field"));
  EXPECT_THAT(refusal(patched(two_fields, 14, std::uint32_t{1} << 31)),
              HasSubstr("found 2147483648 fields, expected 1000 at most"));
}

TEST(TensorFile, RefusesOtherTypesVersionsAndShapes) {
  EXPECT_THAT(refusal(patched(two_fields, 23, std::uint8_t{5})), HasSubstr("found type 5"));
  EXPECT_THAT(refusal(patched(two_fields, 23, std::uint8_t{77})), HasSubstr("found type 77"));
  EXPECT_THAT(refusal(patched(two_fields, 12, std::uint8_t{2})), HasSubstr("version 2.0"));
  EXPECT_THAT(refusal(two_fields, "a", 4), HasSubstr("found 2 dimensions, expected 4"));
  EXPECT_THAT(refusal(two_fields, "vndf", 4), HasSubstr("field 'vndf': the field is missing"));
  EXPECT_THAT(refusal(tensor_file_of({{"a", {1}, {1}}, {"a", {1}, {2}}})), HasSubstr("twice"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(tensor_file_of({{"a", {1, 2}, {1, nan}}})), HasSubstr("number 1: found nan"));
}

}  // namespace
}  // namespace gonio::tests
