// CUReT's pair told by content: either file is known by its rows and finds the other one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/formats/curet.h"
#include "table/read.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using table::SampleTable;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr int direction_count = 60;

/// Direction i has theta_v = i/100.
std::string directions_text(int count = direction_count) {
  std::string text;
  for (int i = 1; i <= count; ++i) {
    text += fmt::format("{}   {:.6f}   -1.0  0.25   {:.6f}\r\n", i, i / 100., i / 50.);
  }
  return text;
}

/// Measurement i of material m is m + i/1000.
std::string measurements_text(const std::vector<int>& materials, int count = direction_count) {
  std::string text;
  for (const int material : materials) {
    text += fmt::format("{:2}", material);
    for (int i = 1; i <= count; ++i) text += fmt::format("    {:.3f}", material + i / 1000.);
    text += "\n";
  }
  return text;
}

SampleTable read(const std::string& path, std::optional<int> material = {}) {
  const std::string content = content_of(path);
  EXPECT_TRUE(table::is_curet(content));
  return table::read_curet_file(content, path, {.material = material});
}

std::string refusal(const std::string& path, std::optional<int> material = {}) {
  try {
    read(path, material);
  } catch (const table::FileError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

void expect_material(const SampleTable& t, int material) {
  EXPECT_EQ(t.name, fmt::format("CUReT {}", material));
  ASSERT_EQ(t.size(), std::size_t{direction_count});
  for (std::size_t i = 0; i < t.size(); ++i) {
    ASSERT_NEAR(t.values[0][i], material + double(i + 1) / 1000, 1e-12);
    ASSERT_NEAR(t.wo.z[i], std::cos(double(i + 1) / 100), 1e-15);
  }
}

TEST(CuretFile, IsToldByItsRows) {
  EXPECT_TRUE(table::is_curet(directions_text()));
  EXPECT_TRUE(table::is_curet("\xEF\xBB\xBF# of the sphere\n\n" + directions_text(2000)));
  EXPECT_TRUE(table::is_curet(measurements_text({5})));
  EXPECT_TRUE(table::is_curet(measurements_text({1, 2, 3}, 50)));
  EXPECT_FALSE(table::is_curet(measurements_text({1, 2, 3}, 49)));
  EXPECT_FALSE(table::is_curet(directions_text(49)));
  EXPECT_FALSE(table::is_curet(""));
  EXPECT_FALSE(table::is_curet(directions_text() + "62 1 1 1 1\n")) << "a gap in the index";
  EXPECT_FALSE(table::is_curet(directions_text() + "61 1 1 1\n"));
  EXPECT_FALSE(table::is_curet(measurements_text({1}) + measurements_text({2}, 59)));
  EXPECT_FALSE(table::is_curet("1.5" + measurements_text({1}).substr(2)));
  std::string commas = measurements_text({1, 2});
  std::replace(commas.begin(), commas.end(), ' ', ',');
  EXPECT_FALSE(table::is_curet(commas));
  EXPECT_FALSE(table::is_curet(std::string(100000, '\0')));
}

TEST(CuretFile, EitherFileFindsTheOtherUnderItsPublishedName) {
  const TemporaryFolder folder;
  const std::string measurements = folder.write("abrdf.dat", measurements_text({4, 7}));
  const std::string directions = folder.write("table.txt", directions_text());
  folder.write("aaa.txt", directions_text());  // sorts before the published name
  expect_material(read(measurements, 7), 7);
  expect_material(read(directions, 4), 4);
  EXPECT_THAT(read(measurements, 7).notes, Contains("the directions were read from " + directions));
  EXPECT_THAT(read(directions, 7).notes,
              Contains("the measurements were read from " + measurements));
  EXPECT_EQ(read(directions, 7).provenance.path, directions);
}

TEST(CuretFile, TheFirstOtherFileThatFitsIsTaken) {
  const TemporaryFolder folder;
  const std::string measurements = folder.write("rough.dat", measurements_text({1}));
  folder.write("table.txt", directions_text(61));  // for other measurements
  folder.write("a.txt", "words\n");
  folder.write("b.txt", measurements_text({2}));
  folder.write("c.csv", directions_text());
  const std::string directions = folder.write("d.TXT", directions_text());
  folder.write("e.txt", directions_text());
  std::filesystem::create_directory(folder / "a.dat");
  expect_material(read(measurements), 1);
  EXPECT_THAT(read(measurements).notes, Contains(HasSubstr(directions)));
}

TEST(CuretFile, APathWithoutAFolderIsOfTheFolderThatOneIsIn) {
  const TemporaryFolder folder;
  folder.write("table.txt", directions_text());
  const std::string measurements = folder.write("abrdf.dat", measurements_text({3}));
  const auto here = std::filesystem::current_path();
  std::filesystem::current_path(std::filesystem::path(measurements).parent_path());
  const SampleTable t = read("abrdf.dat");
  std::filesystem::current_path(here);
  expect_material(t, 3);
}

TEST(CuretFile, OneOfSeveralMaterialsHasToBeChosen) {
  const TemporaryFolder folder;
  const std::string measurements = folder.write("abrdf.dat", measurements_text({9, 4, 7}));
  const std::string directions = folder.write("table.txt", directions_text());
  EXPECT_THAT(refusal(measurements),
              HasSubstr("abrdf.dat: holds materials 4 to 9: choose one with --material N"));
  EXPECT_THAT(refusal(directions), HasSubstr("abrdf.dat: holds materials 4 to 9"));
  EXPECT_THAT(refusal(directions, 5), HasSubstr("no material 5: the file holds 3"));
}

TEST(CuretFile, AMissingPartnerIsNamed) {
  const TemporaryFolder folder;
  const std::string measurements = folder.write("abrdf.dat", measurements_text({1}));
  EXPECT_THAT(refusal(measurements),
              AllOf(HasSubstr("60 measurements per material without the directions"),
                    HasSubstr("the file table.txt"), HasSubstr("60 rows of index")));
  folder.write("table.txt", directions_text(61));
  EXPECT_THAT(refusal(measurements), HasSubstr("without the directions"));
  EXPECT_THAT(refusal(folder / "table.txt"),
              AllOf(HasSubstr("61 directions without the measurements"),
                    HasSubstr("the file abrdf.dat"), HasSubstr("61 measurements")));
  const std::string content = measurements_text({1});
  for (const std::string& path : {folder / "no such folder/x.dat", std::string("/dev/stdin")}) {
    EXPECT_THROW(table::read_curet_file(content, path, {}), table::FileError) << path;
  }
}

TEST(CuretFile, WhateverTheBytesItIsATableOrAFileError) {
  const TemporaryFolder folder;
  folder.write("table.txt", directions_text());
  const std::string whole = measurements_text({1, 2});
  std::mt19937 random(3);
  int accepted = 0;
  for (int k = 0; k < 500; ++k) {
    std::string content = whole;
    switch (k % 3) {
      case 0:
        content.resize(random() % content.size());
        break;
      case 1:
        content[random() % content.size()] = static_cast<char>(random());
        break;
      default:  // often a digit of a number, which is still one
        content[random() % content.size()] = '7';
    }
    try {
      if (!table::is_curet(content)) continue;
      const SampleTable t = table::read_curet_file(content, folder / "abrdf.dat", {.material = 1});
      EXPECT_EQ(t.size(), std::size_t{direction_count});
      ++accepted;
    } catch (const table::FileError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_LT(accepted, 480);
}

TEST(CuretFileData, ThePublishedPairIsFoundFromEitherFile) {
  GONIO_REAL_DATA_OR_SKIP(measurements, "curet/abrdf.dat");
  GONIO_REAL_DATA_OR_SKIP(directions, "curet/table.txt");
  const SampleTable expected = table::read_curet({measurements, directions}, 30);
  for (const std::string& path : {measurements, directions}) {
    const SampleTable t = read(path, 30);
    EXPECT_EQ(t.values, expected.values);
    EXPECT_EQ(t.wi.x, expected.wi.x);
    EXPECT_EQ(t.wo.y, expected.wo.y);
    EXPECT_THAT(refusal(path),
                HasSubstr("abrdf.dat: holds materials 1 to 61: choose one with --material N"));
  }
}

}  // namespace
}  // namespace gonio::tests
