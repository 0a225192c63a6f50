// gonio fit on several tables: files, summary, and what happens to those that fail.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/real_data.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

std::string synthetic(const std::string& name) {
  return std::string(GONIO_SOURCE_DIR) + "/data/synthetic/" + name + ".csv";
}
const std::string brass = synthetic("rolled_brass");
const std::string plastic = synthetic("ivory_computer_plastic");

/// A gonio-table whose fifth and last line lacks two fields.
constexpr std::string_view short_table =
    "# gonio-table 1\n# quantity: brdf\n# angles: deg\ntheta_i,phi_i,theta_o,phi_o,Y\n10,0,20\n";

CommandResult fit(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fit");
  return run_gonio(arguments);
}

/// The material in a file without the command that made it.
json material_in(const std::string& path) {
  json material = json::parse(content_of(path));
  EXPECT_EQ(material.at("provenance").erase("command"), 1U) << path;
  return material;
}

/// CSV by RFC 4180, with either line end: rows of fields.
std::vector<std::vector<std::string>> parse_csv(std::string_view text) {
  std::vector<std::vector<std::string>> rows{{""}};
  bool in_quotes = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& field = rows.back().back();
    if (in_quotes) {
      if (text[i] != '"') {
        field += text[i];
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        in_quotes = false;
      }
    } else if (text[i] == '"') {
      in_quotes = true;
    } else if (text[i] == ',') {
      rows.back().emplace_back();
    } else if (text[i] == '\n') {
      rows.push_back({""});
    } else if (text[i] != '\r') {
      field += text[i];
    }
  }
  EXPECT_THAT(rows.back(), testing::ElementsAre("")) << "the last line has no end";
  rows.pop_back();
  return rows;
}

using Row = std::map<std::string, std::string>;

/// The rows below the head, by column.
std::vector<Row> rows_of(const std::string& csv) {
  const std::vector<std::vector<std::string>> lines = parse_csv(csv);
  std::vector<Row> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].size(), lines[0].size()) << "line " << i + 1;
    rows.emplace_back();
    for (std::size_t c = 0; c < std::min(lines[0].size(), lines[i].size()); ++c) {
      rows.back()[lines[0][c]] = lines[i][c];
    }
    EXPECT_EQ(rows.back().size(), lines[0].size()) << "two columns of one name";
  }
  return rows;
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << "'" << text << "'";
  return value;
}

/// Name and value, and name with "_stddev" and standard deviation, as a row has to hold them.
Row parameters_of(const json& material) {
  Row fields;
  const auto add = [&](const std::string& name, const json& value, const json& stddev) {
    fields[name] = fmt::format("{}", value.get<double>());
    fields[name + "_stddev"] = stddev.is_null() ? "" : fmt::format("{}", stddev.get<double>());
  };
  for (const auto& [name, parameter] : material.at("parameters").items()) {
    const json& value = parameter.at("value");
    const json& stddev = parameter.at("stddev");
    if (!value.is_array()) {
      add(name, value, stddev);
      continue;
    }
    for (std::size_t c = 0; c < value.size(); ++c) {
      add(name + "." + material.at("channels").at(c).get<std::string>(), value.at(c), stddev.at(c));
    }
  }
  return fields;
}

// Tables that fail ----------------------------------------------------------------------------

TEST(FitBatch, GoesOnPastTablesThatFailAndExitsWithOne) {
  const TemporaryFolder folder;
  const std::string incomplete = folder.write("incomplete.csv", short_table);
  const std::string missing = folder / "missing.csv";
  const std::string out = folder / "out";
  const CommandResult result = fit({incomplete, brass, missing, plastic, "-m", "ward", "-o", out});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("gonio: " + incomplete + ":5: "),
                                HasSubstr("gonio: " + missing + ": ")));
  EXPECT_THAT(result.out, EndsWith("\n2 of 4 tables fitted; 2 failed\n"));
  EXPECT_THAT(result.out,
              testing::ContainsRegex("incomplete +failed: line 5: .*\nrolled_brass +1696 .*\n"
                                     "missing +failed: .*\nivory_computer_plastic +1696 "));
  EXPECT_TRUE(fs::exists(out + "/rolled_brass.json"));
  EXPECT_TRUE(fs::exists(out + "/ivory_computer_plastic.json"));
  EXPECT_FALSE(fs::exists(out + "/incomplete.json"));
}

TEST(FitBatch, ASettingThatOneTableHasNoParameterForFailsThatTableOnly) {
  const TemporaryFolder folder;
  std::string text = content_of(plastic);
  const std::size_t channel = text.find(",Y");
  ASSERT_NE(channel, std::string::npos);
  const std::string renamed = folder.write("renamed.csv", text.replace(channel, 2, ",R"));
  const std::string with_sigma = ",sigma_Y";
  if (const std::size_t sigma = text.find(with_sigma); sigma != std::string::npos) {
    folder.write("renamed.csv", text.replace(sigma, with_sigma.size(), ",sigma_R"));
  }
  const CommandResult result =
      fit({brass, renamed, "-m", "ward", "--fix", "rho_d.R=0.45", "--json"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, HasSubstr("gonio: " + brass + ": no parameter 'rho_d.R'"));
  const json tables = json::parse(result.out).at("tables");
  EXPECT_THAT(tables.at(0).at("error").get<std::string>(), HasSubstr("no parameter 'rho_d.R'"));
  EXPECT_EQ(tables.at(1).at("fits").at(0).at("parameters").at("rho_d").at("value").at(0), 0.45);
}

TEST(FitBatch, WrongUsageIsRefusedBeforeAnyWork) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"-o", out, "-m", "no-such-model"},
        std::vector<std::string>{"-o", out, "--metric", "no-such-metric"},
        std::vector<std::string>{"-o", out, "--loss", "no-such-loss"},
        std::vector<std::string>{"-o", out, "--loss-scale", "1"},
        std::vector<std::string>{"-o", out, "--loss", "tukey", "--loss-scale", "-1"},
        std::vector<std::string>{"-o", out, "--fix", "alpha"},
        std::vector<std::string>{"--residuals", out, "--bounds", "alpha=1"},
        std::vector<std::string>{"--summary", "--json"}}) {
    std::vector<std::string> arguments{brass, plastic};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const CommandResult result = fit(arguments);
    EXPECT_EQ(result.exit_status, 2) << wrong.back();
    EXPECT_THAT(result.out, IsEmpty()) << wrong.back();
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(out)) << wrong.back();
  }
}

// Files ---------------------------------------------------------------------------------------

TEST(FitBatch, WritesTheMaterialsAndResidualsOfSingleRuns) {
  const TemporaryFolder folder;
  ASSERT_EQ(fit({brass, plastic, "-m", "ward,ward-gmd-aniso", "-o", folder / "materials",
                 "--residuals", folder / "residuals"})
                .exit_status,
            0);
  for (const std::string name : {"rolled_brass", "ivory_computer_plastic"}) {
    const std::string material = folder / "single.json";
    const std::string residuals = folder / "single.csv";
    ASSERT_EQ(fit({synthetic(name), "-m", "ward,ward-gmd-aniso", "-o", material, "--residuals",
                   residuals})
                  .exit_status,
              0);
    EXPECT_EQ(material_in(folder / ("materials/" + name + ".json")), material_in(material));
    EXPECT_EQ(content_of(folder / ("residuals/" + name + ".csv")), content_of(residuals));
  }
}

TEST(FitBatch, CreatesItsFoldersAndOneTableIsABatchIfOutputIsAFolder) {
  const TemporaryFolder folder;
  const std::vector<std::string> absent{"a/b/c", "d/"};
  for (const std::string& name : absent) {
    const std::string out = folder / name;
    std::vector<std::string> arguments{brass, "-m", "lambert", "-o", out};
    if (!out.ends_with('/')) arguments.insert(arguments.begin(), plastic);
    EXPECT_EQ(fit(arguments).exit_status, 0) << name;
    EXPECT_TRUE(fs::exists(fs::path(out) / "rolled_brass.json")) << name;
  }
  fs::create_directory(folder / "e");
  const CommandResult result = fit({plastic, "-m", "lambert", "-o", folder / "e"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, EndsWith("\n1 of 1 tables fitted; 0 failed\n"));
  EXPECT_TRUE(fs::exists(folder / "e/ivory_computer_plastic.json"));
}

TEST(FitBatch, AFileInAFoldersPlaceIsNamedAndStays) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "mine");
  for (const std::string option : {"-o", "--residuals"}) {
    const CommandResult direct = fit({brass, plastic, "-m", "lambert", option, file});
    EXPECT_EQ(direct.exit_status, 2) << option;
    EXPECT_THAT(direct.err, HasSubstr(option + " " + file + ": is no folder"));
    const CommandResult within = fit({brass, plastic, "-m", "lambert", option, file + "/x"});
    EXPECT_EQ(within.exit_status, 3) << option;
    EXPECT_THAT(within.err, HasSubstr(file + "/x"));
  }
  EXPECT_EQ(content_of(file), "mine");
}

TEST(FitBatch, TwoTablesOfOneNameAreRefusedWhereFilesAreWritten) {
  const TemporaryFolder folder;
  const std::string other = folder.write("rolled_brass.txt", content_of(plastic));
  const std::string out = folder / "out";
  for (const std::string option : {"-o", "--residuals"}) {
    const CommandResult result = fit({brass, plastic, other, "-m", "lambert", option, out});
    EXPECT_EQ(result.exit_status, 2) << option;
    EXPECT_THAT(result.err, AllOf(HasSubstr(brass), HasSubstr(other), Not(HasSubstr(plastic))));
    EXPECT_FALSE(fs::exists(out)) << option;
  }
  const CommandResult printed = fit({brass, other, "-m", "lambert"});
  EXPECT_EQ(printed.exit_status, 0) << printed.err;
  EXPECT_THAT(printed.out, AllOf(HasSubstr(brass + " "), HasSubstr(other + " ")));
}

TEST(FitBatch, WritesNothingOverATableOrOverAnotherOutput) {
  const TemporaryFolder folder;
  const std::string text = content_of(plastic);
  const std::string a_json = folder.write("a.json", text);
  const std::string b_csv = folder.write("b.csv", text);
  const std::string summary = folder.write("summary.csv", text);
  fs::create_directory(folder / "linked");
  fs::create_symlink(b_csv, folder / "linked/b.json");
  const std::string here = folder / ".";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{a_json, brass, "-o", here},
        std::vector<std::string>{b_csv, brass, "--residuals", here},
        std::vector<std::string>{summary, brass, "-o", here, "--summary"},
        std::vector<std::string>{b_csv, brass, "-o", folder / "linked"},
        // The residuals of a table called summary would be the summary.
        std::vector<std::string>{summary, "-o", folder / "new", "--residuals", folder / "./new",
                                 "--summary"}}) {
    std::vector<std::string> with_model = arguments;
    with_model.insert(with_model.end(), {"-m", "lambert"});
    const CommandResult result = fit(with_model);
    EXPECT_EQ(result.exit_status, 2) << fmt::format("{}", fmt::join(arguments, " "));
    for (const std::string& table : {a_json, b_csv, summary}) EXPECT_EQ(content_of(table), text);
    EXPECT_FALSE(fs::exists(folder / "rolled_brass.json"));
    EXPECT_FALSE(fs::exists(folder / "new"));
  }
}

// The summary ---------------------------------------------------------------------------------

TEST(FitBatch, SummaryCsvSaysWhatTheJsonSays) {
  const TemporaryFolder folder;
  // The message quotes the row, and the name has what CSV has to quote.
  const std::string broken = folder.write("a \"b\", c.csv", short_table);
  const std::string out = folder / "out";
  const CommandResult result = fit({brass, broken, plastic, "-m", "ward,ward-aniso,lambert",
                                    "--fix", "rho_d=0.1", "-o", out, "--summary", "--json"});
  EXPECT_EQ(result.exit_status, 1);
  const json tables = json::parse(result.out).at("tables");
  const std::vector<Row> rows = rows_of(content_of(out + "/summary.csv"));
  ASSERT_EQ(tables.size(), 3U);
  ASSERT_EQ(rows.size(), 7U);  // three models of two tables, and one failed

  std::size_t r = 0;
  for (const json& table : tables) {
    if (table.contains("error")) {
      const Row& row = rows[r++];
      for (const auto& [column, field] : row) {
        const std::string expected = column == "table"   ? table.at("table").get<std::string>()
                                     : column == "error" ? table.at("error").get<std::string>()
                                                         : "";
        EXPECT_EQ(field, expected) << column;
      }
      continue;
    }
    for (std::size_t rank = 1; rank <= table.at("fits").size(); ++rank) {
      Row row = rows[r++];
      const json& material = table.at("fits").at(rank - 1);
      const json& fit = material.at("fit");
      EXPECT_EQ(row["table"], table.at("table"));
      EXPECT_EQ(row["model"], material.at("model"));
      EXPECT_EQ(row["rank"], fmt::format("{}", rank));
      EXPECT_EQ(row["metric"], fit.at("metric"));
      EXPECT_EQ(row["loss"], fit.at("loss"));
      EXPECT_EQ(row["used"], fmt::format("{}", fit.at("used").get<int>()));
      EXPECT_EQ(row["converged"], fit.at("converged").get<bool>() ? "true" : "false");
      EXPECT_EQ(row["warnings"], fmt::format("{}", fit.at("warnings").size()));
      EXPECT_EQ(row["error"], "");
      ASSERT_EQ(fit.at("errors").size(), 5U);
      for (const auto& [name, error] : fit.at("errors").items()) {
        EXPECT_EQ(number(row[name]), error.get<double>()) << name;
      }
      // Without a loss and weights the metric's error is the one of that name.
      EXPECT_DOUBLE_EQ(number(row["metric_error"]), fit.at("errors").at("cosine-l2"));
      EXPECT_DOUBLE_EQ(number(row["held_out"]), fit.at("held_out").at("errors").at("cosine-l2"));
      const Row parameters = parameters_of(material);
      const std::vector<std::string> others{"table",        "model",    "rank",      "metric",
                                            "loss",         "used",     "converged", "l2",
                                            "log",          "error",    "cosine-l2", "cube-root",
                                            "metric_error", "held_out", "warnings",  "relative"};
      for (const auto& [column, field] : row) {
        if (std::find(others.begin(), others.end(), column) != others.end()) continue;
        const auto expected = parameters.find(column);
        EXPECT_EQ(field, expected == parameters.end() ? "" : expected->second) << column;
      }
      for (const auto& [name, value] : parameters) EXPECT_TRUE(row.contains(name)) << name;
    }
  }
  EXPECT_EQ(r, rows.size());
  EXPECT_EQ(rows[0].at("rho_d.Y"), "0.1");  // fixed: a value without a standard deviation
  EXPECT_EQ(rows[0].at("rho_d.Y_stddev"), "");
  EXPECT_NE(rows[0].at("rho_s.Y_stddev"), "");
}

TEST(FitBatch, SummaryGoesToStdoutInPlaceOfTheTableWithoutAFolder) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const CommandResult printed = fit({brass, plastic, "-m", "ward", "--summary"});
  EXPECT_EQ(printed.exit_status, 0) << printed.err;
  const CommandResult written = fit({brass, plastic, "-m", "ward", "--summary", "-o", out});
  EXPECT_EQ(written.exit_status, 0) << written.err;
  EXPECT_EQ(printed.out, content_of(out + "/summary.csv"));
  EXPECT_THAT(printed.out, StartsWith("table,model,rank,metric,loss,used,converged,l2,cosine-l2,"
                                      "log,cube-root,relative,metric_error,held_out,warnings,"
                                      "error,"));
  EXPECT_THAT(written.out, EndsWith("\n2 of 2 tables fitted; 0 failed\n"));
}

TEST(FitBatch, TheTableShowsTheBestModelAndHowFarTheNextIs) {
  const CommandResult result = fit({brass, plastic, "-m", "ward,lambert"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const json plastic_fits =
      json::parse(fit({plastic, "-m", "ward,lambert", "--json"}).out).at("fits");
  const auto error = [&](std::size_t i) {
    return plastic_fits.at(i).at("fit").at("errors").at("cosine-l2").get<double>();
  };
  EXPECT_THAT(result.out, testing::ContainsRegex(fmt::format(
                              "\nivory_computer_plastic +1696 +lambert\\+ward +{:.6g} +{:.3f} x",
                              error(0), error(1) / error(0))));
}

TEST(FitBatch, AnyNumberOfThreadsGivesTheSameBytes) {
  const TemporaryFolder folder;
  std::vector<CommandResult> results;
  for (const std::string threads : {"1", "2"}) {
    results.push_back(fit({brass, plastic, "-m", "ward,ward-duer-aniso", "--summary", "--threads",
                           threads, "-o", folder / threads}));
    EXPECT_EQ(results.back().exit_status, 0) << results.back().err;
  }
  EXPECT_EQ(results[0].out, results[1].out);
  EXPECT_EQ(content_of(folder / "1/summary.csv"), content_of(folder / "2/summary.csv"));
  for (const std::string name : {"rolled_brass.json", "ivory_computer_plastic.json"}) {
    // As text: comparing the numbers would take -0 for 0.
    EXPECT_EQ(material_in(folder / ("1/" + name)).dump(),
              material_in(folder / ("2/" + name)).dump());
  }
}

TEST(FitBatch, MeasuredPaintsKeepTheirOrderAndNotesNameTheirTable) {
  GONIO_REAL_DATA_OR_SKIP(silver, "paints/C8_Silver.astm");
  GONIO_REAL_DATA_OR_SKIP(white, "paints/C1_White.astm");
  const CommandResult result = fit({silver, white, "-m", "lambert,ward", "--summary"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const std::vector<Row> rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].at("table"), i < 2 ? silver : white);
    EXPECT_GT(number(rows[i].at("rho_d.465nm")), 0);
  }
  std::size_t begin = 0;
  while (begin < result.err.size()) {
    const std::size_t end = result.err.find('\n', begin);
    EXPECT_THAT(result.err.substr(begin, end - begin),
                testing::AnyOf(StartsWith(silver + ": "), StartsWith(white + ": ")));
    begin = end + 1;
  }
}

}  // namespace
}  // namespace gonio::tests
