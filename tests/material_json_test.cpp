// The material file: read as written, to the last bit; and what is wrong with others.
#include "material/material_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <random>

#include "material/evaluate.h"
#include "table/file_error.h"
#include "table/json_file.h"

namespace gonio::material {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* by_hand = R"({
  "format": "gonio-material", "version": 1, "model": "ward-aniso", "channels": ["R", "G"],
  "parameters": {"rho_d": {"value": [0.1, 0.2]}, "rho_s": {"value": [0.3, 0]},
                 "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}}})";

/// by_hand with `from` replaced by `to`.
std::string changed(std::string_view from, std::string_view to) {
  std::string text = by_hand;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    parse_material(text, "brass.json");
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "";
}

/// Awkward numbers: any bits that are a finite number, so that short and long decimals, denormals
/// and huge ones all occur.
class AnyNumbers {
 public:
  double next() {
    const double value = std::bit_cast<double>(generator_());
    return std::isfinite(value) ? value : next();
  }
  double positive() { return std::abs(next()); }
  /// Within the bounds of a roughness.
  double roughness() { return std::uniform_real_distribution<double>(1e-4, 10)(generator_); }
  std::pair<double, double> interval() {
    const double a = next();
    const double b = next();
    return {std::min(a, b), std::max(a, b)};
  }

 private:
  std::mt19937_64 generator_{11};
};

Material fitted_material() {
  AnyNumbers any;
  Material m;
  m.name = "gebürstetes \"Messing\"\n\t/~";
  m.model = "lambert+ward-aniso";
  m.channels = {"465nm", "R", "Grün"};
  for (const char* name : {"rho_d", "rho_s"}) {
    m.parameters.push_back({.name = name,
                            .value = {any.positive(), any.positive(), 0.1},
                            .stddev = {any.positive(), std::nullopt, 0.0},
                            .interval95 = {any.interval(), any.interval(), std::nullopt}});
  }
  m.parameters.push_back({.name = "alpha_x",
                          .value = {any.roughness()},
                          .stddev = {any.positive()},
                          .interval95 = {any.interval()}});
  m.parameters.push_back({.name = "alpha_y",
                          .value = {any.roughness()},
                          .stddev = {std::nullopt},
                          .interval95 = {std::nullopt}});
  FitSummary fit;
  fit.metric = "cosine-l2";
  fit.loss = "none";
  fit.covariance = "sandwich";
  fit.samples = 12964;
  fit.used = 11000;
  fit.converged = true;
  fit.iterations = 17;
  fit.errors = {{"relative", any.positive()}, {"l2", any.positive()}, {"cosine-l2", 1e-310}};
  fit.reduced_chi2 = any.positive();
  fit.correlation_parameters = {"rho_d.R", "alpha_x"};
  fit.correlation = {{1.0, any.next()}, {std::nullopt, 1.0}};
  fit.warnings = {"alpha_x and alpha_y cannot be told apart", ""};
  m.fit = fit;
  m.provenance = MaterialProvenance{.table = "C:\\data\\brass.csv",
                                    .sha256 = std::string(64, 'a'),
                                    .gonio = "0.1.0",
                                    .command = "gonio fit 'brass 1.csv'"};
  return m;
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << a[i];
  }
}

TEST(MaterialJsonTest, ReadsBackWhatItWroteToTheLastBit) {
  const Material written = fitted_material();
  const Material read = parse_material(table::json_text(to_json(written)), "brass.json");
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.model, written.model);
  EXPECT_EQ(read.channels, written.channels);
  ASSERT_EQ(read.parameters.size(), written.parameters.size());
  for (std::size_t p = 0; p < read.parameters.size(); ++p) {
    EXPECT_EQ(read.parameters[p].name, written.parameters[p].name);
    expect_same_bits(read.parameters[p].value, written.parameters[p].value);
    // Comparing optional doubles by == tells all finite numbers apart but the zeros.
    EXPECT_EQ(read.parameters[p].stddev, written.parameters[p].stddev);
    EXPECT_EQ(read.parameters[p].interval95, written.parameters[p].interval95);
  }
  ASSERT_TRUE(read.fit && read.provenance);
  EXPECT_EQ(read.fit->metric, written.fit->metric);
  EXPECT_EQ(read.fit->loss, written.fit->loss);
  EXPECT_EQ(read.fit->covariance, written.fit->covariance);
  EXPECT_EQ(read.fit->samples, written.fit->samples);
  EXPECT_EQ(read.fit->used, written.fit->used);
  EXPECT_EQ(read.fit->converged, written.fit->converged);
  EXPECT_EQ(read.fit->iterations, written.fit->iterations);
  EXPECT_EQ(read.fit->errors, written.fit->errors);
  EXPECT_EQ(read.fit->reduced_chi2, written.fit->reduced_chi2);
  EXPECT_EQ(read.fit->correlation_parameters, written.fit->correlation_parameters);
  EXPECT_EQ(read.fit->correlation, written.fit->correlation);
  EXPECT_EQ(read.fit->warnings, written.fit->warnings);
  EXPECT_EQ(read.provenance->table, written.provenance->table);
  EXPECT_EQ(read.provenance->sha256, written.provenance->sha256);
  EXPECT_EQ(read.provenance->gonio, written.provenance->gonio);
  EXPECT_EQ(read.provenance->command, written.provenance->command);
}

TEST(MaterialJsonTest, WritingAgainGivesTheSameText) {
  const std::string once = table::json_text(to_json(fitted_material()));
  EXPECT_EQ(table::json_text(to_json(parse_material(once, "brass.json"))), once);
}

TEST(MaterialJsonTest, KeepsTheShortestOfNumbersAndTheRestOfTheBits) {
  AnyNumbers any;
  Material m = parse_material(by_hand, "brass.json");
  for (int i = 0; i < 2000; ++i) {
    m.parameters[0].value = {any.positive(), any.positive()};
    const Material read = parse_material(table::json_text(to_json(m)), "brass.json");
    expect_same_bits(read.parameters[0].value, m.parameters[0].value);
  }
}

TEST(MaterialJsonTest, AMaterialWrittenByHandIsAMaterial) {
  const Material m = parse_material(by_hand, "brass.json");
  EXPECT_EQ(m.model, "lambert+ward-aniso") << "the bare name is spelled out";
  EXPECT_THAT(m.channels, ElementsAre("R", "G"));
  EXPECT_THAT(m.parameters[1].value, ElementsAre(0.3, 0));
  EXPECT_TRUE(m.parameters[0].stddev.empty());
  EXPECT_FALSE(m.fit);
  EXPECT_FALSE(m.provenance);
}

TEST(MaterialJsonTest, WithOneChannelAnAmplitudeMayBeAPlainNumber) {
  const Material m = parse_material(R"({"format": "gonio-material", "version": 1, "model": "ward",
      "channels": ["Y"], "parameters": {"alpha": {"value": 1}, "rho_d": {"value": 0.5,
      "stddev": 0.1, "interval95": [0.3, 0.7]}, "rho_s": {"value": [0.1], "stddev": [null]}}})",
                                    "y.json");
  EXPECT_EQ(m.parameters[0].name, "rho_d") << "in the model's order, whatever the file's";
  EXPECT_THAT(m.parameters[0].value, ElementsAre(0.5));
  EXPECT_THAT(m.parameters[0].stddev, ElementsAre(0.1));
  EXPECT_THAT(m.parameters[0].interval95, ElementsAre(std::pair(0.3, 0.7)));
  EXPECT_THAT(m.parameters[1].stddev, ElementsAre(std::nullopt));
  EXPECT_EQ(m.parameters[2].name, "alpha");
}

TEST(MaterialJsonTest, PassesOverTheTimingOfAFitsOutput) {
  EXPECT_EQ(refusal(changed("\"version\": 1", R"("version": 1, "timing": {"fit_s": 0.1})")), "");
}

TEST(MaterialJsonTest, SaysWhichFieldIsWrongAndWhatWasExpected) {
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const Case cases[] = {
      {changed("gonio-material", "gonio-recipe"),
       {"/format: found \"gonio-recipe\", expected \"gonio-material\""}},
      {changed("\"format\": \"gonio-material\", ", ""), {"\"format\" is missing"}},
      {changed("\"version\": 1", "\"version\": 2"), {"/version: ", "version 2", "newer gonio"}},
      {changed("\"version\": 1", "\"version\": 0"), {"/version: found 0"}},
      {changed("\"version\": 1", "\"version\": 1.5"), {"/version: found 1.5", "whole number"}},
      {changed("\"version\": 1", "\"version\": \"1\""), {"/version: found \"1\""}},
      {changed("ward-aniso", "torrance"), {"/model: ", "'torrance'", "ward-gmd-aniso"}},
      {changed("\"ward-aniso\"", "7"), {"/model: found 7, expected a text"}},
      {changed("[\"R\", \"G\"]", "[]"), {"/channels: found no channel"}},
      {changed("[\"R\", \"G\"]", "[\"R\", \"R\"]"), {"/channels: ", "'R' stands twice"}},
      {changed("[\"R\", \"G\"]", "[\"R\", \"a,b\"]"), {"/channels: ", "'a,b'"}},
      {changed("[\"R\", \"G\"]", "[\"R\", \"weight\"]"), {"/channels: ", "'weight'"}},
      {changed("[\"R\", \"G\"]", "[\"R\", 5]"), {"/channels/1: found 5"}},
      {changed("[\"R\", \"G\"]", "\"R\""), {"/channels: found \"R\", expected an array"}},
      {changed("[0.1, 0.2]", "[0.1]"),
       {"/parameters/rho_d/value: found 1 value, expected 2, one per channel"}},
      {changed("[0.1, 0.2]", "0.1"), {"/parameters/rho_d/value: found 1 value, expected 2"}},
      {changed("[0.1, 0.2]", "[0.1, \"x\"]"), {"/parameters/rho_d/value/1: found \"x\""}},
      {changed("[0.1, 0.2]", "[0.1, null]"), {"/parameters/rho_d/value/1: found null"}},
      {changed("[0.1, 0.2]", "[0.1, -1e-9]"), {"/parameters/rho_d/value: found -1e-09"}},
      {changed("[0.1, 0.2]", "[0.1, 1e999]"), {"line 3, column", "1e999", "double"}},
      {changed("0.05", "[0.05]"), {"/parameters/alpha_x/value: ", "one number, shared"}},
      {changed("0.05", "0"), {"/parameters/alpha_x/value: found 0, outside the bounds"}},
      {changed("0.05", "10.5"), {"/parameters/alpha_x/value: ", "expected 1e-04 to 10"}},
      {changed("{\"value\": 0.05}", "0.05"),
       {"/parameters/alpha_x: found 0.05, expected an object"}},
      {changed("{\"value\": 0.05}", "{}"), {"/parameters/alpha_x: ", "\"value\" is missing"}},
      {changed("{\"value\": 0.05}", "{\"value\": 0.05, \"std\": 1}"),
       {"/parameters/alpha_x/std: unknown member", "stddev"}},
      {changed("alpha_y", "alpha"),
       {"/parameters/alpha: not a parameter of lambert+ward-aniso", "alpha_y"}},
      {changed("0.05}", "0.05}, \"psi\": {\"value\": 90}"),
       {"/parameters/psi/value: found 90, outside the bounds of psi",
        "1.5707963267948966, in rad"}},
      {changed("0.05}", "0.05}, \"psi\": {\"value\": [0.1, 0.1]}"),
       {"/parameters/psi/value: ", "one number, shared"}},
      {changed("0.05}", "0.05}, \"psi_2\": {\"value\": 0.1}"),
       {"/parameters/psi_2: not a parameter of lambert+ward-aniso, expected", "psi"}},
      {changed("\"ward-aniso\"", "\"ward\""), {"/parameters/alpha_x: not a parameter"}},
      {changed("alpha_y", "a~/b"), {"/parameters/a~0~1b: not a parameter"}},
      {changed(", \"alpha_y\": {\"value\": 0.16}", ""),
       {"/parameters: \"alpha_y\": missing, expected all parameters"}},
      {changed("alpha_y", "alpha_x"), {"\"alpha_x\" stands twice"}},
      {changed("{\"value\": 0.05}", "{\"value\": 0.05, \"stddev\": -1}"),
       {"/parameters/alpha_x/stddev: found -1"}},
      {changed("{\"value\": 0.05}", "{\"value\": 0.05, \"interval95\": [2, 1]}"),
       {"/parameters/alpha_x/interval95: ", "[lower, upper]"}},
      {changed("\"value\": [0.1, 0.2]", "\"value\": [0.1, 0.2], \"stddev\": [0.1]"),
       {"/parameters/rho_d/stddev: found an array of 1, expected an array of 2"}},
      {changed("\"version\": 1", R"("version": 1, "fit": {"converged": 1})"),
       {"/fit/converged: found 1, expected true or false"}},
      {changed(
           "\"version\": 1",
           R"("version": 1, "fit": {"correlation_parameters": ["a"], "correlation": [[1, 2]]})"),
       {"/fit/correlation/0: found an array of 2, expected a row of 1"}},
      {changed("\"version\": 1", R"("version": 1, "provenance": [])"),
       {"/provenance: found an array of 0, expected an object"}},
      {changed("\"R\", \"G\"]", "\"R\", \"G\""),
       {"line 3, column 15: not JSON (unexpected ':'; expected ']')"}},
      {"", {"line 1, column 1: not JSON"}},
      {"[]", {"the document: found an array of 0, expected an object"}},
      {std::string("\x7f"
                   "ELF\0\x01\xff",
                   7),
       {"line 1, column 1: not JSON"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const std::string message = refusal(c.text);
    EXPECT_THAT(message, StartsWith("brass.json: "));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
    for (const std::string& part : c.parts) EXPECT_THAT(message, HasSubstr(part));
  }
}

TEST(MaterialJsonTest, WritesAFileThatItReads) {
  const auto path = std::filesystem::path(testing::TempDir()) / "gonio_material_json_test.json";
  write_material(fitted_material(), path.string());
  EXPECT_EQ(to_json(read_material(path.string())), to_json(fitted_material()));
  std::filesystem::remove(path);
}

TEST(MaterialJsonTest, WritesNothingThatItCouldNotRead) {
  const auto path = std::filesystem::path(testing::TempDir()) / "gonio_material_json_bad.json";
  Material m = fitted_material();
  m.fit->errors[0].second = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_material(m, path.string()), table::FileError);
  m = fitted_material();
  m.parameters.pop_back();
  EXPECT_THROW(write_material(m, path.string()), table::FileError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(MaterialJsonTest, NamesAFileThatIsNotThere) {
  EXPECT_THROW(read_material("no/such/material.json"), table::FileError);
  EXPECT_THROW(read_material(testing::TempDir()), table::FileError);
}

TEST(EvaluateTest, GivesEveryChannelAtEverySampleOfATable) {
  const Material m = parse_material(by_hand, "brass.json");
  table::SampleTable t;
  for (const double theta : {0.0, 30.0, 60.0}) {
    t.wi.push_back(brdf::direction_from_degrees(theta, 0));
    t.wo.push_back(brdf::direction_from_degrees(30, 180));
  }
  t.mask = {table::MaskReason::none, table::MaskReason::hole, table::MaskReason::none};
  const auto f_r = evaluate(m, t);
  ASSERT_EQ(f_r.size(), 2U);
  const brdf::Model model("ward-aniso");
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array shape{0.05, 0.16};
    EXPECT_EQ(f_r[0][i], model.evaluate(std::array{0.1, 0.3}, shape, t.wi[i], t.wo[i]));
    EXPECT_EQ(f_r[1][i], model.evaluate(std::array{0.2, 0.0}, shape, t.wi[i], t.wo[i]));
  }
}

TEST(EvaluateTest, IsZeroAtTheHorizon) {
  const Material m = parse_material(by_hand, "brass.json");
  table::SampleTable t;
  t.wi.push_back(brdf::direction_from_degrees(90, 0));  // its cosine rounds to 6e-17
  t.wo.push_back(brdf::direction_from_degrees(30, 180));
  t.mask = {table::MaskReason::horizon};
  EXPECT_EQ(evaluate(m, t), (std::vector<std::vector<double>>{{0}, {0}}));
}

}  // namespace
}  // namespace gonio::material
