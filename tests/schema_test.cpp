// The JSON schemas accept what gonio reads and writes, judged by an independent validator, and
// reject what it refuses.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "instrument/recipe.h"
#include "material/material_json.h"
#include "table/file_error.h"
#include "table/json_file.h"
#include "tests/json_schema.h"

namespace gonio::tests {
namespace {

using nlohmann::json;

const std::filesystem::path source_folder = GONIO_SOURCE_DIR;

json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

json example_material() {
  return json::parse(R"({"format": "gonio-material", "version": 1, "name": "rolled brass",
      "model": "lambert+ward-aniso", "channels": ["R", "G"], "parameters": {
      "rho_d": {"value": [0.1, 0.2], "stddev": [0.01, null], "interval95": [[0, 1], null]},
      "rho_s": {"value": [0.3, 0.4]}, "alpha_x": {"value": 0.05, "stddev": 0.01,
      "interval95": [0.04, 0.06]}, "alpha_y": {"value": 0.16, "stddev": null,
      "interval95": null}}, "fit": {"metric": "cosine-l2", "loss": "none",
      "covariance": "residual", "samples": 9, "used": 8, "converged": true, "iterations": 7,
      "errors": {"l2": 0.5}, "loss_scale": 0.02, "outliers": {"threshold": 0.1, "count": 2,
      "listed": [{"sample": 0, "channel": "G", "residual": -0.5}]}, "held_out": {"errors":
      {"l2": 0.6}, "folds": [{"theta_i_deg": [0, 20], "values": 4, "error": 0.25}]}, "aicc": -12.5,
      "bic": -10, "nested": {"in": "lambert+ward-gmd-aniso", "test": "wald", "statistic": 1.5,
      "p_value": 0.25, "text": "one roughness is enough"},
      "reduced_chi2": 1.25, "correlation_parameters": ["alpha_x"],
      "correlation": [[1.0]], "warnings": ["w"]}, "provenance": {"table": "t.csv", "sha256": "",
      "gonio": "0.1.0", "command": "gonio fit t.csv"}})");
}

json example_recipe() {
  return read_json(source_folder / "data" / "synthetic" / "rolled_brass.json");
}

/// What a change makes of a document that was good.
struct Break {
  const char* what;
  std::function<void(json&)> change;
};

TEST(MaterialSchema, AcceptsWhatGonioWrites) {
  const Schema schema("material.schema.json");
  EXPECT_EQ(schema.complaint(example_material()), "");
  const auto material = material::parse_material(example_material().dump(), "example");
  const json written = json::parse(table::json_text(material::to_json(material)));
  EXPECT_EQ(schema.complaint(written), "");
}

TEST(MaterialSchema, AcceptsAMaterialWrittenByHand) {
  const Schema schema("material.schema.json");
  json m = json::parse(R"({"format": "gonio-material", "version": 1, "model": "ward",
      "channels": ["Y"], "parameters": {"rho_d": {"value": 0.5}, "rho_s": {"value": [0.1]},
      "alpha": {"value": 1}}})");
  EXPECT_EQ(schema.complaint(m), "");
  m["timing"] = {{"fit_s", 0.1}};
  EXPECT_EQ(schema.complaint(m), "") << "the output of gonio fit --json is a material too";
}

TEST(MaterialSchema, AcceptsTwoLobesAndAFreeFrame) {
  const Schema schema("material.schema.json");
  const json m = json::parse(R"({"format": "gonio-material", "version": 1,
      "model": "lambert+ward+ward-aniso", "channels": ["Y"], "parameters": {
      "rho_d": {"value": 0.5}, "rho_s": {"value": 0.1}, "alpha": {"value": 0.3},
      "rho_s_2": {"value": [0.2]}, "alpha_x_2": {"value": 0.1}, "alpha_y_2": {"value": 0.2},
      "psi_2": {"value": -0.5, "stddev": 0.01, "interval95": [-0.52, -0.48]}}})");
  EXPECT_EQ(schema.complaint(m), "");
  const auto material = material::parse_material(m.dump(), "two lobes");
  EXPECT_EQ(schema.complaint(json::parse(table::json_text(material::to_json(material)))), "");
}

TEST(MaterialSchema, RejectsWhatTheReaderRefuses) {
  const Schema schema("material.schema.json");
  const Break breaks[] = {
      {"format", [](json& m) { m["format"] = "gonio-recipe"; }},
      {"newer", [](json& m) { m["version"] = 2; }},
      {"no version", [](json& m) { m.erase("version"); }},
      {"no model", [](json& m) { m.erase("model"); }},
      {"no channels", [](json& m) { m.erase("channels"); }},
      {"empty channels", [](json& m) { m["channels"] = json::array(); }},
      {"double channel",
       [](json& m) {
         m["channels"] = {"R", "R"};
       }},
      {"comma in a channel",
       [](json& m) {
         m["channels"] = {"R", "a,b"};
       }},
      {"no parameters", [](json& m) { m.erase("parameters"); }},
      {"no value", [](json& m) { m["parameters"]["alpha_x"].erase("value"); }},
      {"text value", [](json& m) { m["parameters"]["alpha_x"]["value"] = ".05"; }},
      {"null value", [](json& m) { m["parameters"]["rho_d"]["value"][0] = nullptr; }},
      {"bare value", [](json& m) { m["parameters"]["alpha_x"] = 0.05; }},
      {"unknown member", [](json& m) { m["parameters"]["alpha_x"]["std"] = 1; }},
      {"negative stddev", [](json& m) { m["parameters"]["alpha_x"]["stddev"] = -1; }},
      {"half interval", [](json& m) { m["parameters"]["alpha_x"]["interval95"] = {1}; }},
      {"count", [](json& m) { m["fit"]["samples"] = -1; }},
      {"converged", [](json& m) { m["fit"]["converged"] = "yes"; }},
      {"warnings", [](json& m) { m["fit"]["warnings"] = "w"; }},
      {"negative error", [](json& m) { m["fit"]["errors"]["l2"] = -0.5; }},
      {"loss scale", [](json& m) { m["fit"]["loss_scale"] = 0; }},
      {"no threshold", [](json& m) { m["fit"]["outliers"].erase("threshold"); }},
      {"threshold", [](json& m) { m["fit"]["outliers"]["threshold"] = -1; }},
      {"part of a count", [](json& m) { m["fit"]["outliers"]["count"] = 1.5; }},
      {"sample", [](json& m) { m["fit"]["outliers"]["listed"][0]["sample"] = -1; }},
      {"channel", [](json& m) { m["fit"]["outliers"]["listed"][0]["channel"] = 1; }},
      {"residual", [](json& m) { m["fit"]["outliers"]["listed"][0].erase("residual"); }},
      {"too many listed",
       [](json& m) {
         json& outliers = m["fit"]["outliers"];
         outliers["count"] = 1001;
         outliers["listed"] = json(1001, outliers["listed"][0]);
       }},
      {"no folds", [](json& m) { m["fit"]["held_out"].erase("folds"); }},
      {"half a fold", [](json& m) { m["fit"]["held_out"]["folds"][0]["theta_i_deg"] = {0}; }},
      {"fold below",
       [](json& m) {
         m["fit"]["held_out"]["folds"][0]["theta_i_deg"] = {0, 91};
       }},
      {"fold's error", [](json& m) { m["fit"]["held_out"]["folds"][0]["error"] = nullptr; }},
      {"aicc", [](json& m) { m["fit"]["aicc"] = "-1"; }},
      {"bic", [](json& m) { m["fit"]["bic"] = nullptr; }},
      {"probability", [](json& m) { m["fit"]["nested"]["p_value"] = 1.5; }},
      {"no statistic", [](json& m) { m["fit"]["nested"].erase("statistic"); }},
      {"provenance", [](json& m) { m["provenance"] = json::array(); }},
  };
  for (const Break& b : breaks) {
    SCOPED_TRACE(b.what);
    json broken = example_material();
    b.change(broken);
    EXPECT_NE(schema.complaint(broken), "");
    EXPECT_THROW(material::parse_material(broken.dump(), "broken"), table::FileError);
  }
}

TEST(RecipeSchema, AcceptsEveryRecipeOfTheProject) {
  const Schema schema("recipe.schema.json");
  int count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(source_folder / "data" / "synthetic")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_EQ(schema.complaint(read_json(entry.path())), "") << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 18);  // of Ward's model ten, of Strauss's eight
}

TEST(RecipeSchema, AcceptsATangentAngle) {
  json recipe = example_recipe();
  recipe["parameters"]["psi"] = -0.5;
  EXPECT_EQ(Schema("recipe.schema.json").complaint(recipe), "");
  EXPECT_NO_THROW(instrument::parse_recipe(recipe.dump(), "turned"));
}

TEST(RecipeSchema, RejectsWhatTheReaderRefuses) {
  const Schema schema("recipe.schema.json");
  const Break breaks[] = {
      {"format", [](json& r) { r["format"] = "gonio-material"; }},
      {"newer", [](json& r) { r["version"] = 2; }},
      {"unknown member", [](json& r) { r["sigmas"] = true; }},
      {"no name", [](json& r) { r.erase("name"); }},
      {"text parameter", [](json& r) { r["parameters"]["rho_d"] = "0.1"; }},
      {"no angle", [](json& r) { r["incidence_angles_deg"] = json::array(); }},
      {"grazing lamp", [](json& r) { r["incidence_angles_deg"] = {90}; }},
      {"lamp below", [](json& r) { r["incidence_angles_deg"] = {-5}; }},
      {"rotation", [](json& r) { r["sample_rotations_deg"] = {"0"}; }},
      {"no hemisphere", [](json& r) { r["exitant_directions"].erase("hemisphere"); }},
      {"theta max", [](json& r) { r["exitant_directions"]["theta_max_deg"] = 100; }},
      {"no step", [](json& r) { r["exitant_directions"]["hemisphere"]["phi_step_deg"] = 0; }},
      {"part of a direction",
       [](json& r) { r["exitant_directions"]["mirror_patch"]["directions_per_ring"] = 1.5; }},
      {"negative noise", [](json& r) { r["noise"]["relative"] = -0.1; }},
      {"no seed", [](json& r) { r["noise"].erase("seed"); }},
      {"negative seed", [](json& r) { r["noise"]["seed"] = -1; }},
      {"sigma", [](json& r) { r["sigma_columns"] = 1; }},
      {"quantity", [](json& r) { r["quantity"] = "radiance"; }},
  };
  for (const Break& b : breaks) {
    SCOPED_TRACE(b.what);
    json broken = example_recipe();
    b.change(broken);
    EXPECT_NE(schema.complaint(broken), "");
    EXPECT_THROW(instrument::parse_recipe(broken.dump(), "broken"), table::FileError);
  }
}

}  // namespace
}  // namespace gonio::tests
