// Wavefront material libraries as they are found: what is taken from them, what is said about the
// rest, and that no file, however broken, does harm.
#include "material/wavefront_mtl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "table/file_error.h"
#include "tests/run_gonio.h"

namespace gonio::material {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

std::vector<MtlMaterial> read(std::string_view text,
                              std::optional<double> default_exponent = std::nullopt) {
  const tests::TemporaryFolder folder;
  return read_wavefront_mtl(folder.write("paint.mtl", text), default_exponent);
}

/// The only material of a library.
MtlMaterial single(std::string_view text, std::optional<double> default_exponent = std::nullopt) {
  std::vector<MtlMaterial> materials = read(text, default_exponent);
  EXPECT_EQ(materials.size(), 1U) << text;
  return materials.empty() ? MtlMaterial{} : materials.front();
}

/// The material named red with these statements.
MtlMaterial red(std::string_view statements) {
  return single("newmtl red\n" + std::string(statements));
}

/// The problem of the material red without the folder's name, which differs from run to run.
std::string problem_of(std::string_view statements) {
  const std::string problem = red(statements).problem;
  return problem.substr(std::min(problem.find("paint.mtl"), problem.size()));
}

std::string refusal(const std::string& path) {
  try {
    read_wavefront_mtl(path);
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WavefrontMtl, TakesTheColoursAndTheExponentOfEachMaterial) {
  const auto materials = read(
      "# exported\n"
      "newmtl red\n  Kd 0.8 0.1 0.05\n  Ks 0.5 0.4 0.25\n  Ns 96.078431\n  illum 2\n"
      "newmtl dull grey\n  Kd 0.5\n  Ks 0 0 0\n");
  ASSERT_EQ(materials.size(), 2U);
  EXPECT_EQ(materials[0].name, "red");
  EXPECT_EQ(materials[0].line, 2);
  EXPECT_THAT(materials[0].diffuse, ElementsAre(0.8, 0.1, 0.05));
  EXPECT_THAT(materials[0].specular, ElementsAre(0.5, 0.4, 0.25));
  EXPECT_EQ(materials[0].exponent, 96.078431);
  EXPECT_THAT(materials[0].notes, IsEmpty());
  EXPECT_EQ(materials[0].problem, "");
  EXPECT_EQ(materials[1].name, "dull grey");
  EXPECT_EQ(materials[1].line, 7);
  // One number is a grey; without a highlight no exponent is asked for.
  EXPECT_THAT(materials[1].diffuse, ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(materials[1].specular, ElementsAre(0, 0, 0));
  EXPECT_EQ(materials[1].exponent, 0);
  EXPECT_EQ(materials[1].problem, "");
}

TEST(WavefrontMtl, ReadsTheSameWhateverTheWriter) {
  const std::vector<std::string> spellings{
      "newmtl red\nKd 0.5 0.25 1\nKs 0.5\nNs 20\n",
      "newmtl red\r\nKd 0.5 0.25 1\r\nKs 0.5\r\nNs 20\r\n",
      "newmtl red\rKd 0.5 0.25 1\rKs 0.5\rNs 20",
      "\xEF\xBB\xBFnewmtl red\nKd 0.5 0.25 1\nKs 0.5\nNs 20",
      "\n\tnewmtl\tred \t \n\tKd\t0.5   0.25\t1  \n\tKs 0.5\t\n Ns\t20\t\n\n",
      "NEWMTL red\nKD .5 2.5e-1 +1.\nks 5E-1\nNS 2e1\n",
      "newmtl red\nKd 0.5 0.25 1 # paint\nKs 0.5#gloss\nNs 20 # exponent, 0,5\n#Kd 1 1 1\n",
      "newmtl red\nKd 0.5 \\\n  0.25 \\\r\n1\nKs 0.5\nNs \\\n20",
  };
  for (const std::string& spelling : spellings) {
    const MtlMaterial material = single(spelling);
    EXPECT_EQ(material.name, "red") << spelling;
    EXPECT_EQ(material.problem, "") << spelling;
    EXPECT_THAT(material.diffuse, ElementsAre(0.5, 0.25, 1)) << spelling;
    EXPECT_THAT(material.specular, ElementsAre(0.5, 0.5, 0.5)) << spelling;
    EXPECT_EQ(material.exponent, 20) << spelling;
  }
}

TEST(WavefrontMtl, KeepsBlanksAndHashesInNames) {
  EXPECT_EQ(single("newmtl Material #25 (two sided) \nKd 1").name, "Material #25 (two sided)");
  EXPECT_EQ(single("newmtl gr\xC3\xBCn\nKd 1").name, "gr\xC3\xBCn");
}

TEST(WavefrontMtl, CountsLinesWhereCommentsAndContinuedOnesAre) {
  EXPECT_THAT(problem_of("# no statement \\\nKa 1 \\\n 1 1\nKd 1 \\\n x 1\nKs 0"),
              StartsWith("paint.mtl: line 5: material 'red': found 'x' after Kd"));
}

TEST(WavefrontMtl, HasNoHighlightUnderTheFirstTwoIlluminationModels) {
  for (const int model : {0, 1}) {
    const MtlMaterial material =
        red("Kd 1 1 1\nKs 0.5 0.5 0.5\nNs 50\nillum " + std::to_string(model));
    EXPECT_EQ(material.problem, "");
    EXPECT_THAT(material.specular, ElementsAre(0, 0, 0)) << model;
    EXPECT_EQ(material.exponent, 0) << model;
    EXPECT_THAT(material.notes, Contains(HasSubstr("illum"))) << model;
  }
  // Their exponent is not used, whatever it is.
  EXPECT_EQ(red("Kd 1\nKs 1\nNs -3\nillum 1").problem, "");
  const MtlMaterial mirror = red("Kd 1\nKs 1\nNs 50\nillum 3");
  EXPECT_EQ(mirror.exponent, 50);
  EXPECT_THAT(mirror.notes, ElementsAre(HasSubstr("reflection")));
}

TEST(WavefrontMtl, AsksForAnExponentOnlyWhereThereIsAHighlight) {
  EXPECT_THAT(
      problem_of("Kd 1\nKs 0 0.1 0"),
      AllOf(StartsWith("paint.mtl: line 1: material 'red': "), HasSubstr("--default-exponent N")));
  EXPECT_EQ(problem_of("Kd 1\nKs 0"), "");
  EXPECT_EQ(problem_of("Kd 1\nKs 0\nNs 0"), "");
  EXPECT_EQ(problem_of("Kd 1"), "");
  const MtlMaterial material = single("newmtl red\nKd 1\nKs 0.5", 30);
  EXPECT_EQ(material.exponent, 30);
  EXPECT_THAT(material.notes, ElementsAre("no Ns: the exponent is the default 30"));
  // The library's own exponent comes first.
  EXPECT_EQ(single("newmtl red\nKd 1\nKs 0.5\nNs 7", 30).exponent, 7);
  EXPECT_EQ(single("newmtl red\nKd 1\nKs 0", 30).exponent, 0);
}

TEST(WavefrontMtl, RefusesADefaultExponentThatIsNone) {
  for (const double exponent : {0.0, -1.0, 1.1e6, std::nan("")}) {
    EXPECT_THROW(single("newmtl red\nKd 1", exponent), std::invalid_argument) << exponent;
  }
}

TEST(WavefrontMtl, TakesExponentsAboveZeroUpToAMillion) {
  for (const char* exponent : {"0.001", "1", "4096", "1e6"}) {
    EXPECT_EQ(problem_of("Kd 1\nKs 1\nNs " + std::string(exponent)), "") << exponent;
  }
  for (const char* exponent : {"0", "-10", "1000001", "1e300"}) {
    EXPECT_THAT(problem_of("Kd 1\nKs 1\nNs " + std::string(exponent)),
                AllOf(StartsWith("paint.mtl: line 4: material 'red': found exponent "),
                      HasSubstr("expected one above 0 and up to 1000000")))
        << exponent;
  }
}

TEST(WavefrontMtl, SaysWhatIsWrongWithANumber) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"Kd 0,5 0,5 0,5\n", "found '0,5' after Kd, expected numbers with a decimal point"},
      {"Kd 0.5, 0.5, 0.5\n", "found '0.5,' after Kd, expected numbers with a decimal point"},
      {"Kd nan 0 0\n", "found 'nan' after Kd, expected a finite number"},
      {"Kd 0 inf 0\n", "found 'inf' after Kd, expected a finite number"},
      {"Kd 0 1e999 0\n", "found '1e999' after Kd, expected a number that double"},
      {"Kd 0 0 0.5x\n", "found '0.5x' after Kd, expected a number"},
      {"Kd 0.5 0.5\n", "found 2 numbers after Kd, expected 3"},
      {"Kd 0.5 0.5 0.5 1\n", "found 4 numbers after Kd, expected 3"},
      {"Kd\n", "found 0 numbers after Kd, expected 3"},
      {"Kd 0.5 -0.1 0\n", "found '-0.1' after Kd, expected a reflectance"},
      {"Kd spectral brass.rfl 0.5\n", "found a spectral curve"},
      {"Kd xyz 0.3 0.4 0.5\n", "found CIE XYZ"},
      {"Kd 1\nKs 1\nNs 1,000\n", "found '1,000' after Ns, expected numbers with a decimal point"},
      {"Kd 1\nKs 1\nNs\n", "found nothing after Ns, expected one number"},
      {"Kd 1\nKs 1\nNs 10 20\n", "found 2 values after Ns, expected one number"},
      {"Kd 1\nKs 1\nNs 10\nillum 11\n", "found illumination model 11, expected a whole number"},
      {"Kd 1\nKs 1\nNs 10\nillum 1.5\n", "found illumination model 1.5, expected a whole number"},
      {"Ka 1 1 1\n", "has neither Kd nor Ks"},
      {"map_Kd wood.png\nKs 1\nNs 5\n", "has no Kd but a texture"},
  };
  for (const auto& [statements, problem] : cases) {
    const std::string found = problem_of(statements);
    EXPECT_THAT(found, HasSubstr("material 'red': " + problem)) << statements;
    EXPECT_THAT(found, Not(HasSubstr("\n"))) << statements;
  }
}

TEST(WavefrontMtl, ReadsOnBehindAMaterialWithAProblem) {
  const auto materials =
      read("newmtl bad\nKd red\nnewmtl good\nKd 1\nnewmtl \nKd 1\nnewmtl good\nKd 0.5\n");
  ASSERT_EQ(materials.size(), 4U);
  EXPECT_THAT(materials[0].problem, HasSubstr("line 2"));
  EXPECT_EQ(materials[1].problem, "");
  EXPECT_THAT(materials[2].problem, HasSubstr("without a name"));
  EXPECT_THAT(materials[3].problem, HasSubstr("line 7: material 'good': has the name of the one in "
                                              "line 3; rename"));
}

TEST(WavefrontMtl, TellsWhatItPassedOver) {
  const MtlMaterial material =
      red("Ka 0.2 0.2 0.2\nKd 2 1 1\nKs 0\nNi 1.45\nd 0.5\nmap_Kd -s 1 1 1 wood.png\n"
          "bump wood_b.png\nPr 0.3\nshiny yes\n");
  EXPECT_EQ(material.problem, "");
  EXPECT_THAT(material.notes,
              testing::UnorderedElementsAre("line 3: Kd is above 1: more is reflected than arrives",
                                            "line 2: passed over: Ka (ambient light)",
                                            "line 5: passed over: Ni (refractive index)",
                                            "line 6: passed over: d (transparency)",
                                            "line 7: passed over: 'map_kd' (texture)",
                                            "line 8: passed over: bump (relief map)",
                                            "line 9: passed over: Pr (roughness of another model)",
                                            "line 10: passed over: 'shiny' (not understood)"));
  // What changes nothing is not worth a word.
  EXPECT_THAT(red("Ka 0 0 0\nKd 1\nKs 0\nKe 0 0 0\nNi 1.0\nd 1.000\nTr 0\nTf 1 1 1\n").notes,
              IsEmpty());
}

TEST(WavefrontMtl, TakesTheLastOfARepeatedStatementAndSaysSo) {
  const MtlMaterial material = red("Kd bad\nKd 0.1 0.1 0.1\nKd 0.2 0.3 0.4\nKs 0\n");
  EXPECT_EQ(material.problem, "");
  EXPECT_THAT(material.diffuse, ElementsAre(0.2, 0.3, 0.4));
  EXPECT_THAT(material.notes, ElementsAre("Kd stands 3 times: the last, in line 4, counts"));
}

TEST(WavefrontMtl, SaysWhatIsMissing) {
  const MtlMaterial metal = red("Ks 1\nNs 5\n");
  EXPECT_THAT(metal.diffuse, ElementsAre(0, 0, 0));
  EXPECT_THAT(metal.notes, ElementsAre("no Kd: the diffuse part is black"));
  EXPECT_THAT(red("Kd 1\n").notes, ElementsAre("no Ks: no highlight"));
}

TEST(WavefrontMtl, PassesOverStatementsBeforeTheFirstMaterial) {
  const MtlMaterial material = single("Kd 1 1 1\nNs 5\nnewmtl red\nKd 0.5\nKs 0\n");
  EXPECT_THAT(material.diffuse, ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(material.notes, ElementsAre(StartsWith("line 1: 'kd' stands before the first")));
}

TEST(WavefrontMtl, RefusesWhatIsNoLibrary) {
  const tests::TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "missing.mtl"), HasSubstr("missing.mtl: no such file"));
  EXPECT_THAT(refusal(folder / "."), HasSubstr("this is a folder"));
  EXPECT_THAT(refusal(folder.write("empty.mtl", "")), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal(folder.write("scene.obj", "v 0 0 0\nusemtl red\n")),
              AllOf(HasSubstr("scene.obj: found no 'newmtl NAME' in 2 lines"),
                    HasSubstr("check that this is the file you meant")));
  // UTF-16 has a zero byte beside each letter.
  EXPECT_THAT(refusal(folder.write("wide.mtl", std::string_view("\xFF\xFEn\0e\0w\0", 8))),
              HasSubstr("expected a Wavefront material library (.mtl) as UTF-8 or ASCII"));
}

/// What holds of any material, however it was written.
void expect_sound(const MtlMaterial& material) {
  if (!material.problem.empty()) {
    EXPECT_EQ(material.problem.find('\n'), std::string::npos);
    return;
  }
  for (const auto& color : {material.diffuse, material.specular}) {
    for (const double value : color) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
  }
  EXPECT_EQ(material.exponent > 0, material.specular != (std::array<double, 3>{}));
  EXPECT_LE(material.exponent, 1e6);
  EXPECT_GE(material.line, 1);
  EXPECT_FALSE(material.name.empty());
}

constexpr std::string_view library =
    "# two materials\r\nnewmtl red paint\r\n\tKa 0.1 0.1 0.1\r\n\tKd 0.8 0.1 0.05\r\n"
    "\tKs 0.5 0.4 \\\r\n 0.25\r\n\tNs 96.078431\r\n\tillum 2\r\n\tmap_Kd red.png\r\n"
    "newmtl glass\n Kd xyz 0.1 0.2 0.3\n Ks 1\n Ns 1e3 # sharp\n d 0.1\n Tf 0.5 0.5 0.5\n";

TEST(WavefrontMtl, SurvivesWhateverIsDoneToAFile) {
  const tests::TemporaryFolder folder;
  std::mt19937 generator(5);
  std::size_t usable = 0;
  std::size_t refused = 0;
  for (int mutation = 0; mutation < 500; ++mutation) {
    std::string text(library);
    for (auto flips = generator() % 6; flips > 0; --flips) {
      text[generator() % text.size()] = static_cast<char>(generator() % 256);
    }
    text.resize(1 + generator() % text.size());
    try {
      for (const MtlMaterial& material : read_wavefront_mtl(folder.write("broken.mtl", text))) {
        expect_sound(material);
        usable += material.problem.empty() ? 1U : 0U;
      }
    } catch (const table::FileError&) {
      ++refused;
    }
  }
  // The mutations reach both ends: files with nothing left, and files where little happened.
  EXPECT_GT(usable, 100U);
  EXPECT_GT(refused, 10U);
}

TEST(WavefrontMtl, ReadsGarbageAndEndlessLinesInOneGo) {
  std::mt19937 generator(6);
  std::string garbage = "newmtl noise\nKd 0.5\n";
  for (int byte = 0; byte < 2'000'000; ++byte) garbage += static_cast<char>(generator() % 256);
  for (const MtlMaterial& material : read(garbage)) {
    // A megabyte of nonsense is not repeated in notes: a line each for so many kinds at most.
    EXPECT_LE(material.notes.size(), 40U);
  }
  const std::string wide(3'000'000, '1');
  EXPECT_THAT(red("Kd " + wide).problem.size(), testing::Lt(400U));
  EXPECT_EQ(red("Kd 0.5 # " + wide).problem, "");
  // All of it is one line.
  std::string continued = "Kd 0.5\nKs 0\nmap_Kd ";
  for (int line = 0; line < 200'000; ++line) continued += "\\\n";
  EXPECT_EQ(red(continued).problem, "");
}

}  // namespace
}  // namespace gonio::material
