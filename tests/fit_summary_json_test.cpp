// What a material file tells of its fit: read as written, and refused by field.
#include "material/fit_summary_json.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "material/material_json.h"
#include "table/file_error.h"

namespace gonio::material {
namespace {

using testing::HasSubstr;

FitSummary read(const std::string& text) {
  const auto file = table::JsonFile::parse(text, "brass.json");
  return read_fit_summary(file.root());
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "";
}

/// Numbers without a short decimal form, so that a lost bit shows.
FitSummary robust_fit() {
  FitSummary fit;
  fit.metric = "chi2";
  fit.loss = "tukey";
  fit.loss_scale = 1.0 / 3;
  fit.errors = {{"l2", 0.1 + 0.2}};
  fit.held_out = HeldOut{.errors = {{"l2", 1e-310}, {"cosine-l2", 2.0 / 7}},
                         .folds = {{.theta_i_deg = {0, 20.000001}, .values = 12, .error = 1.0 / 7},
                                   {.theta_i_deg = {40, 40}, .values = 0, .error = 0}}};
  fit.aicc = -1e17 / 3;
  fit.bic = 1.0 / 11;
  fit.nested = NestedComparison{.in = "lambert+ward-aniso",
                                .test = "wald",
                                .statistic = 1.0 / 13,
                                .p_value = 1e-300,
                                .text = "two \"roughnesses\"\n"};
  fit.outliers =
      Outliers{.threshold = 1.0 / 17,
               .count = 5000000000,
               .listed = {{.sample = 4999999999, .channel = "Grün", .residual = -2.0 / 3},
                          {.sample = 0, .channel = "R", .residual = 1e300 / 3}}};
  return fit;
}

TEST(FitSummaryJsonTest, ReadsBackEveryNewMemberToTheLastBit) {
  const FitSummary written = robust_fit();
  const FitSummary fit = read(table::json_text(json_of(written)));
  EXPECT_EQ(fit.loss_scale, written.loss_scale);
  ASSERT_TRUE(fit.held_out && fit.nested && fit.outliers);
  EXPECT_EQ(fit.held_out->errors, written.held_out->errors);
  ASSERT_EQ(fit.held_out->folds.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(fit.held_out->folds[i].theta_i_deg, written.held_out->folds[i].theta_i_deg);
    EXPECT_EQ(fit.held_out->folds[i].values, written.held_out->folds[i].values);
    EXPECT_EQ(fit.held_out->folds[i].error, written.held_out->folds[i].error);
  }
  EXPECT_EQ(fit.aicc, written.aicc);
  EXPECT_EQ(fit.bic, written.bic);
  EXPECT_EQ(fit.nested->in, written.nested->in);
  EXPECT_EQ(fit.nested->test, "wald");
  EXPECT_EQ(fit.nested->statistic, written.nested->statistic);
  EXPECT_EQ(fit.nested->p_value, written.nested->p_value);
  EXPECT_EQ(fit.nested->text, written.nested->text);
  EXPECT_EQ(fit.outliers->threshold, written.outliers->threshold);
  EXPECT_EQ(fit.outliers->count, 5000000000U);
  ASSERT_EQ(fit.outliers->listed.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(fit.outliers->listed[i].sample, written.outliers->listed[i].sample);
    EXPECT_EQ(fit.outliers->listed[i].channel, written.outliers->listed[i].channel);
    EXPECT_EQ(fit.outliers->listed[i].residual, written.outliers->listed[i].residual);
  }
}

TEST(FitSummaryJsonTest, LeavesOutWhatTheFitHasNot) {
  const auto json = json_of(FitSummary{});
  for (const char* key : {"loss_scale", "held_out", "aicc", "bic", "nested", "outliers"}) {
    EXPECT_FALSE(json.contains(key)) << key;
  }
  const FitSummary fit = read("{}");
  EXPECT_FALSE(fit.loss_scale || fit.held_out || fit.aicc || fit.bic || fit.nested || fit.outliers);
}

TEST(FitSummaryJsonTest, AnEmptyListOfOutliersIsAResultToo) {
  const FitSummary fit = read(R"({"outliers": {"threshold": 3, "count": 0, "listed": []}})");
  ASSERT_TRUE(fit.outliers);
  EXPECT_EQ(fit.outliers->count, 0U);
  EXPECT_EQ(json_of(fit)["outliers"]["listed"], nlohmann::ordered_json::array());
}

TEST(FitSummaryJsonTest, SaysWhichFieldIsWrongAndWhatWasExpected) {
  const auto outliers = [](const std::string& members) {
    return fmt::format(R"({{"outliers": {{{}}}}})", members);
  };
  const auto fold = [](const std::string& members) {
    return fmt::format(R"({{"held_out": {{"errors": {{}}, "folds": [{{{}}}]}}}})", members);
  };
  std::string many = R"({"sample": 0, "channel": "R", "residual": 1})";
  const std::string one = many;
  for (std::size_t i = 0; i < Outliers::most_listed; ++i) many += ", " + one;
  struct Case {
    std::string text, part;
  };
  const Case cases[] = {
      {R"({"loss_scale": 0})", "/loss_scale: found 0, expected a number above 0"},
      {R"({"loss_scale": null})", "/loss_scale: found null, expected"},
      {R"({"errors": {"l2": -1}})", "/errors/l2: found -1, expected a root mean square, 0 or more"},
      {R"({"aicc": "1"})", "/aicc: found \"1\", expected"},
      {R"({"bic": []})", "/bic: found an array of 0, expected"},
      {R"({"outliers": []})", "/outliers: found an array of 0, expected an object"},
      {outliers(R"("count": 0, "listed": [])"), "/outliers: the member \"threshold\" is missing"},
      {outliers(R"("threshold": -1, "count": 0, "listed": [])"), "/outliers/threshold: found -1"},
      {outliers(R"("threshold": 1, "count": -1, "listed": [])"),
       "/outliers/count: found -1, expected a whole number"},
      {outliers(R"("threshold": 1, "count": 9, "listed": 9)"),
       "/outliers/listed: found 9, expected an array"},
      {outliers(R"("threshold": 1, "count": 0, "listed": [)" + one + "]"),
       "/outliers/listed: found an array of 1, expected at most count = 0 outliers"},
      {outliers(R"("threshold": 1, "count": 2000, "listed": [)" + many + "]"),
       "/outliers/listed: found an array of 1001, expected at most the 1000 largest"},
      {outliers(R"("threshold": 1, "count": 1, "listed": [{"sample": 0.5}])"),
       "/outliers/listed/0/sample: found 0.5, expected a whole number"},
      {outliers(R"("threshold": 1, "count": 1, "listed": [{"sample": 1, "channel": "R"}])"),
       "/outliers/listed/0: the member \"residual\" is missing"},
      {R"({"held_out": {"folds": []}})", "/held_out: the member \"errors\" is missing"},
      {fold(R"("theta_i_deg": [20, 10], "values": 1, "error": 1)"),
       "/held_out/folds/0/theta_i_deg: found an array of 2, expected [lowest, highest]"},
      {fold(R"("theta_i_deg": [0, 91], "values": 1, "error": 1)"),
       "/held_out/folds/0/theta_i_deg: "},
      {fold(R"("theta_i_deg": [0, 9], "values": "1", "error": 1)"),
       "/held_out/folds/0/values: found \"1\", expected a whole number"},
      {fold(R"("theta_i_deg": [0, 9], "values": 1, "error": -1)"),
       "/held_out/folds/0/error: found -1"},
      {R"({"nested": {"in": "lambert+ward-aniso", "test": "wald", "statistic": 1, "p_value": 2,
       "text": ""}})",
       "/nested/p_value: found 2, expected a probability, 0 to 1"},
      {R"({"nested": {"in": 5}})", "/nested/in: found 5, expected a text"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text.substr(0, 100));
    const std::string message = refusal(c.text);
    EXPECT_THAT(message, testing::StartsWith("brass.json: "));
    EXPECT_THAT(message, HasSubstr(c.part));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
  }
}

TEST(FitSummaryJsonTest, StandsInTheMaterialFile) {
  Material m = parse_material(R"({"format": "gonio-material", "version": 1, "model": "lambert",
      "channels": ["Y"], "parameters": {"rho_d": {"value": 0.5}}})",
                              "grey.json");
  m.fit = robust_fit();
  const std::string once = table::json_text(to_json(m));
  const Material read = parse_material(once, "grey.json");
  ASSERT_TRUE(read.fit && read.fit->outliers);
  EXPECT_EQ(read.fit->outliers->listed[0].channel, "Grün");
  EXPECT_EQ(table::json_text(to_json(read)), once) << "written again, the same text";
}

}  // namespace
}  // namespace gonio::material
