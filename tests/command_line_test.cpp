// The command as its users meet it: exit status, stdout, stderr, and what is left on the disk.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "brdf/model.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::string_view header =
    "# gonio-table 1\n"
    "# quantity: brdf\n"
    "# angles: deg\n"
    "# name: test surface\n"
    "theta_i,phi_i,theta_o,phi_o,Y\n";

/// Rows of lambert+ward-aniso with alpha_x .2 and alpha_y .4, each ended by `end`.
std::string ward_rows(std::string_view end = "\n") {
  const brdf::Model model("ward-aniso");
  std::string rows;
  for (const int theta_i : {10, 30, 50}) {
    for (const int phi_i : {0, 45, 90}) {
      for (int theta_o = 5; theta_o <= 65; theta_o += 10) {
        for (int phi_o = 0; phi_o < 360; phi_o += 45) {
          const double f = model.evaluate(std::vector{0.2, 0.3}, std::vector{0.2, 0.4},
                                          brdf::direction_from_degrees(theta_i, phi_i),
                                          brdf::direction_from_degrees(theta_o, phi_o));
          rows += fmt::format("{},{},{},{},{}{}", theta_i, phi_i, theta_o, phi_o, f, end);
        }
      }
    }
  }
  return rows;
}

std::string good_table() { return std::string(header) + ward_rows(); }

/// The good table with one further row, which is line 510.
std::string table_with_row(std::string_view row) { return good_table() + std::string(row) + "\n"; }
constexpr std::string_view further_row_place = ":510:";  // 5 + 3 * 3 * 7 * 8 + 1

/// One line, for people: ends with its only newline.
MATCHER(IsOneLine, "") {
  return !arg.empty() && std::count(arg.begin(), arg.end(), '\n') == 1 && arg.back() == '\n';
}

// Help, version and usage ---------------------------------------------------------------------

TEST(CommandLine, HelpAndVersionGoToStdout) {
  const CommandResult version = run_gonio({"--version"});
  EXPECT_EQ(version.exit_status, 0);
  EXPECT_THAT(version.out, AllOf(StartsWith("gonio "), IsOneLine()));
  EXPECT_THAT(version.err, IsEmpty());
  for (const std::string command : {"", "info", "fit", "eval", "models", "synth"}) {
    std::vector<std::string> arguments{"--help"};
    if (!command.empty()) arguments.insert(arguments.begin(), command);
    const CommandResult help = run_gonio(arguments);
    EXPECT_EQ(help.exit_status, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("--help")) << command;
    EXPECT_THAT(help.err, IsEmpty()) << command;
  }
}

TEST(CommandLine, WrongUsageEndsWithTwoAndOneLine) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"weigh"},
      {"info"},
      {"info", table, "--no-such-option"},
      {"fit"},
      {"fit", table, "-m", "no-such-model"},
      {"fit", table, "-m", "ward", "--metric", "no-such-metric"},
      {"fit", table, "-m", "ward", "--fix", "alpha=abc"},
      {"fit", table, "-m", "ward", "--fix", "alpha_x=0.1"},
      {"fit", table, "-m", "ward", "--bounds", "alpha=2:1"},
      {"fit", table, "-m", "ward", "--max-theta", "abc"},
      {"fit", table, "-m", "ward", "--metric", "chi2"},  // no sigma columns and no --noise
      {"fit", table, "-m", "ward", "--loss", "no-such-loss"},
      {"fit", table, "-m", "ward", "--loss-scale", "0.1"},  // of no loss
      {"fit", table, "-m", "ward", "--loss", "huber", "--loss-scale", "-0.1"},
      {"fit", table, "-m", "ward", "--loss", "huber", "--loss-scale", "0"},
      {"fit", table, "-m", "ward", "--loss", "huber", "--loss-scale", "1e999"},
      {"fit", table, "-m", "ward", "--loss", "huber", "--loss-scale", "abc"},
      {"fit", table, "-m", "ward", "--loss", "huber", "--covariance", "residual"},
      {"fit", table, "-m", "lambert", "--homogeneous"},
      {"models", "no-such-model"},
      {"eval", table},
      {"synth"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    const CommandResult result = run_gonio(arguments);
    const std::string line = fmt::format("gonio {}", fmt::join(arguments, " "));
    EXPECT_EQ(result.exit_status, 2) << line;
    EXPECT_THAT(result.out, IsEmpty()) << line;
    EXPECT_THAT(result.err, AllOf(StartsWith("gonio: "), IsOneLine())) << line;
  }
}

// Input that cannot be used -------------------------------------------------------------------

struct BadTable {
  std::string name;
  std::string content;
  std::string place;  // what the message has to name beside the file
};

std::ostream& operator<<(std::ostream& out, const BadTable& table) { return out << table.name; }

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::vector<BadTable> bad_tables() {
  const std::string row(further_row_place);
  return {
      {"Empty", "", "empty"},
      {"NoDeclaration", "theta_i,phi_i,theta_o,phi_o,Y\n10,0,20,0,0.1\n", "# gonio-table 1"},
      {"UnknownQuantity", replaced(good_table(), "quantity: brdf", "quantity: gloss"), "gloss"},
      {"ShortRow", table_with_row("10,0,20,0"), row},
      {"LongRow", table_with_row("10,0,20,0,0.1,0.2"), row},
      {"TextInANumber", table_with_row("10,0,20,0,0.1x"), row},
      {"Nan", table_with_row("10,0,20,0,nan"), row},
      {"Infinity", table_with_row("10,0,20,0,-inf"), row},
      {"NegativeTheta", table_with_row("-1,0,20,0,0.1"), row},
      {"ThetaBeyondTheHorizon", table_with_row("10,0,90.00001,0,0.1"), row},
      {"DuplicateColumns", replaced(good_table(), "phi_o,Y", "phi_o,Y,Y"), "Y"},
      {"BinaryJunk",
       std::string("\x7f"
                   "ELF\0\1\2\xff\xfe",
                   9) +
           std::string(500, '\xaa'),
       "format"},
      {"BinaryJunkInARow", table_with_row(std::string("10,0,\0\xff,0,0.1", 13)), row},
  };
}

class UnusableTable : public testing::TestWithParam<BadTable> {};

INSTANTIATE_TEST_SUITE_P(CommandLine, UnusableTable, testing::ValuesIn(bad_tables()),
                         [](const auto& test) { return test.param.name; });

TEST_P(UnusableTable, EndsWithThreeOneLineAndNoOutput) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", GetParam().content);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", table},
        std::vector<std::string>{"fit", table, "-m", "lambert", "-o", folder / "out.json"}}) {
    const CommandResult result = run_gonio(arguments);
    EXPECT_EQ(result.exit_status, 3);
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, AllOf(IsOneLine(), HasSubstr(table), HasSubstr(GetParam().place)));
    EXPECT_THAT(folder.names(), ElementsAre("table.csv"));
  }
}

TEST(CommandLine, AMissingFileAndAFolderAreNamed) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder / "nothing.csv", folder / "."}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", path},
          std::vector<std::string>{"fit", path, "-m", "ward", "-o", folder / "out.json"},
          std::vector<std::string>{"eval", path, "--wi", "30,0", "--wo", "30,180"},
          std::vector<std::string>{"synth", path, "-o", folder / "out.csv"}}) {
      const CommandResult result = run_gonio(arguments);
      EXPECT_EQ(result.exit_status, 3) << arguments[0];
      EXPECT_THAT(result.err, AllOf(IsOneLine(), HasSubstr(path))) << arguments[0];
      EXPECT_THAT(result.out, IsEmpty()) << arguments[0];
      EXPECT_THAT(folder.names(), IsEmpty()) << arguments[0];
    }
  }
}

TEST(CommandLine, ATableWithNothingLeftAfterMaskingIsRefusedAndInfoShowsWhy) {
  const TemporaryFolder folder;
  const std::string table =
      folder.write("table.csv", std::string(header) + "10,0,90,0,0.1\n20,0,90,0,0.1\n30,0,20,0,\n");
  const auto one_line_that_counts =
      AllOf(IsOneLine(), HasSubstr(table), HasSubstr("2 masked as horizon"),
            HasSubstr("1 masked as hole"));
  const CommandResult fit = run_gonio({"fit", table, "-m", "lambert", "-o", folder / "out.json"});
  EXPECT_EQ(fit.exit_status, 3);
  EXPECT_THAT(fit.out, IsEmpty());
  EXPECT_THAT(fit.err, one_line_that_counts);
  EXPECT_THAT(folder.names(), ElementsAre("table.csv"));

  const CommandResult info = run_gonio({"info", table});
  EXPECT_EQ(info.exit_status, 3);
  EXPECT_THAT(info.out, HasSubstr("2 horizon (66.7 %), 1 hole (33.3 %)"));
  EXPECT_THAT(info.err, one_line_that_counts);
}

TEST(CommandLine, FewerSamplesThanUnknownsAreRefused) {
  const TemporaryFolder folder;
  // rho_d, rho_s, alpha_x, alpha_y: four unknowns.
  const std::string table = folder.write(
      "table.csv", std::string(header) + "10,0,10,180,1\n10,0,20,180,0.5\n10,0,30,90,0.2\n");
  const CommandResult result =
      run_gonio({"fit", table, "-m", "ward-aniso", "-o", folder / "out.json"});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, AllOf(IsOneLine(), HasSubstr(table), HasSubstr("3"), HasSubstr("4")));
  EXPECT_THAT(folder.names(), ElementsAre("table.csv"));
}

TEST(CommandLine, AFullDiskIsReportedWhereverTheResultGoes) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const RunOptions full{.stdout_path = "/dev/full"};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", table}, std::vector<std::string>{"info", table, "--json"},
        std::vector<std::string>{"models"}, std::vector<std::string>{"fit", table, "-m", "ward"},
        std::vector<std::string>{"fit", table, "-m", "ward", "--json"}}) {
    const CommandResult result = run_gonio(arguments, full);
    EXPECT_EQ(result.exit_status, 3) << arguments[0];
    EXPECT_THAT(result.err, HasSubstr("stdout")) << arguments[0];
  }
  const CommandResult result = run_gonio({"fit", table, "-m", "ward", "-o", "/dev/full"});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, HasSubstr("/dev/full"));
}

TEST(CommandLine, AnOutputFolderThatDoesNotExistIsNamed) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const std::string out = folder / "no/such/folder/out.json";
  const CommandResult result = run_gonio({"fit", table, "-m", "ward", "-o", out});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, HasSubstr(out));
}

// Input that is only unusual ------------------------------------------------------------------

json fitted_parameters(const std::string& table, const RunOptions& options = {}) {
  const CommandResult result = run_gonio({"fit", table, "-m", "ward-aniso", "--json"}, options);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  return json::parse(result.out).at("parameters");
}

TEST(CommandLine, LineEndsMarksAndBlanksDoNoHarm) {
  const TemporaryFolder folder;
  const json plain = fitted_parameters(folder.write("plain.csv", good_table()));
  EXPECT_NEAR(plain.at("alpha_x").at("value"), 0.2, 1e-6);  // noise-free: the truth, by far
  EXPECT_NEAR(plain.at("alpha_y").at("value"), 0.4, 1e-6);

  std::string carriage_returns = good_table();
  for (std::size_t at = 0; (at = carriage_returns.find('\n', at)) != std::string::npos; at += 2) {
    carriage_returns.replace(at, 1, "\r\n");
  }
  const std::vector<std::pair<std::string, std::string>> unusual{
      {"CRLF", carriage_returns},
      {"byte order mark", "\xef\xbb\xbf" + good_table()},
      {"blank lines", "\n" + std::string(header) + "\n" + ward_rows("\n\n")},
      {"trailing commas", std::string(header) + ward_rows(",\n")},
      {"no newline at the end", good_table().substr(0, good_table().size() - 1)},
  };
  for (const auto& [name, content] : unusual) {
    EXPECT_EQ(fitted_parameters(folder.write("unusual.csv", content)), plain) << name;
  }
}

TEST(CommandLine, ALocaleWithDecimalCommasDoesNoHarm) {
  const TemporaryFolder folder;
  const std::string make = "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8") +
                           "' >/dev/null 2>&1 && LOCPATH='" + (folder / "") +
                           "' LC_ALL=de_DE.UTF-8 locale decimal_point | grep -q ,";
  if (std::system(make.c_str()) != 0) {
    GTEST_SKIP() << "no German locale could be made: the package 'locales' is missing";
  }
  const RunOptions german{.environment = {{"LOCPATH", folder / ""}, {"LC_ALL", "de_DE.UTF-8"}}};
  const std::string table = folder.write("table.csv", good_table());
  EXPECT_EQ(fitted_parameters(table, german), fitted_parameters(table));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", table}, std::vector<std::string>{"models", "ward"},
        std::vector<std::string>{"fit", table, "-m", "ward"}}) {
    EXPECT_EQ(run_gonio(arguments, german).out, run_gonio(arguments).out) << arguments[0];
  }
}

// Results -------------------------------------------------------------------------------------

TEST(CommandLine, InfoTellsTheSameToPeopleAndPrograms) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", table_with_row("10,0,90,0,0.1"));
  const CommandResult text = run_gonio({"info", table});
  EXPECT_EQ(text.exit_status, 0);
  EXPECT_THAT(text.err, IsEmpty());
  EXPECT_THAT(text.out, AllOf(StartsWith("test surface\n"), HasSubstr(table),
                              HasSubstr("505, of which 504 can be used"),
                              HasSubstr("1 horizon (0.2 %)"), EndsWith("\n")));
  std::string longest;
  std::istringstream lines(text.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > longest.size() && line.find(table) == std::string::npos) longest = line;
  }
  EXPECT_LE(longest.size(), 100U) << longest;

  const json parsed = json::parse(run_gonio({"info", table, "--json"}).out);
  EXPECT_EQ(parsed.at("samples"), 505);
  EXPECT_EQ(parsed.at("used"), 504);
  EXPECT_EQ(parsed.at("masked").at("horizon"), 1);
  EXPECT_EQ(parsed.at("quantity"), "brdf");
  EXPECT_EQ(parsed.at("sha256").get<std::string>().size(), 64U);
  EXPECT_EQ(parsed.at("channels").at(0).at("name"), "Y");
  EXPECT_EQ(parsed.at("incidences").size(), 3U);
}

TEST(CommandLine, FitGivesTheSameMaterialAsFileAndOnStdout) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const CommandResult result =
      run_gonio({"fit", table, "-m", "ward-aniso", "-o", folder / "out.json", "--json"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const json printed = json::parse(result.out);
  const json file = json::parse(content_of(folder / "out.json"));
  EXPECT_EQ(file.at("format"), "gonio-material");
  EXPECT_EQ(file.at("parameters"), printed.at("parameters"));
  EXPECT_TRUE(printed.contains("timing"));
  EXPECT_FALSE(file.contains("timing"));
}

TEST(CommandLine, FitRefusesToOverwriteItsTableOrToWriteBothOutputsToOneFile) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  std::filesystem::create_symlink(table, folder / "link.json");
  for (const std::vector<std::string>& outputs :
       {std::vector<std::string>{"-o", table}, std::vector<std::string>{"--residuals", table},
        std::vector<std::string>{"-o", folder / "link.json"},
        std::vector<std::string>{"-o", folder / "x", "--residuals", folder / "x"}}) {
    std::vector<std::string> arguments{"fit", table, "-m", "ward-aniso"};
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    EXPECT_EQ(run_gonio(arguments).exit_status, 2) << outputs.back();
    EXPECT_EQ(content_of(table), good_table());
    EXPECT_FALSE(std::filesystem::exists(folder / "x"));
  }
}

TEST(CommandLine, FitTakesOneValueForEachFixAndTheTableAfterIt) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const CommandResult result = run_gonio({"fit", "--fix", "alpha_x=0.05", "--fix", "alpha_y=0.16",
                                          table, "-m", "ward-aniso", "--json"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("parameters").at("alpha_x").at("value"), 0.05);
}

TEST(CommandLine, FitAppliesASettingToTheModelsThatHaveTheParameter) {
  const TemporaryFolder folder;
  const std::string table = folder.write("table.csv", good_table());
  const CommandResult all = run_gonio({"fit", table, "--bounds", "alpha=0.01:0.5", "--json"});
  EXPECT_EQ(all.exit_status, 0) << all.err;
  EXPECT_TRUE(json::parse(all.out).contains("fits"));
  EXPECT_EQ(run_gonio({"fit", table, "--fix", "beta=1"}).exit_status, 2);
}

TEST(CommandLine, NamesACommandThatThereIsNot) {
  const CommandResult result = run_gonio({"foo"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("foo"));
}

// Killed runs ---------------------------------------------------------------------------------

/// A recipe whose table takes long enough to write that it can be killed half-way.
std::string long_recipe() {
  return R"({"format": "gonio-recipe", "version": 1, "name": "killed", "model": "lambert",
             "channels": ["R", "G", "B"], "parameters": {"rho_d": [0.1, 0.2, 0.3]},
             "incidence_angles_deg": [10, 20, 30, 40, 50, 60], "sample_rotations_deg": [0, 45],
             "exitant_directions": {"theta_max_deg": 80,
                                    "hemisphere": {"theta_step_deg": 1, "phi_step_deg": 2}},
             "noise": {"relative": 0.02, "floor": 0.001, "seed": 1}, "sigma_columns": false})";
}

TEST(CommandLine, AKilledRunLeavesTheOldFileOrTheNewOne) {
  const TemporaryFolder folder;
  const std::string recipe = folder.write("recipe.json", long_recipe());
  const std::vector<std::string> arguments{"synth", recipe, "-o", folder / "table.csv"};
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run_gonio(arguments).exit_status, 0);
  const auto duration = std::chrono::steady_clock::now() - start;
  const std::string complete = content_of(folder / "table.csv");
  ASSERT_GT(complete.size(), 5'000'000U);

  int killed = 0;
  constexpr int trials = 24;
  for (int trial = 0; trial < trials; ++trial) {
    folder.write("table.csv", "old");
    const pid_t child = start_gonio(arguments);
    std::this_thread::sleep_for(duration * (trial + 1) / trials);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++killed;
    const std::string left = content_of(folder / "table.csv");
    EXPECT_TRUE(left == "old" || left == complete) << left.size() << " bytes in trial " << trial;
  }
  // Else the test has tested nothing.
  EXPECT_GT(killed, trials / 4);
}

}  // namespace
}  // namespace gonio::tests
