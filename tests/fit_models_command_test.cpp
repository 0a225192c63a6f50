// gonio fit with a free frame, a homogeneous material, two lobes, and several models compared.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "instrument/synthesize.h"
#include "tests/fit_command.h"
#include "tests/json_schema.h"

namespace gonio::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Models --------------------------------------------------------------------------------------

TEST(FitCommand, AFreeFrameFindsATurnedTangentAndTheMaterialGivesTheTableBack) {
  const TemporaryFolder folder;
  for (const double psi : {0.5, -1.2}) {
    SCOPED_TRACE(psi);
    instrument::Recipe recipe = brass_recipe();
    recipe.parameters["psi"] = {psi};
    const table::SampleTable table = instrument::synthesize(recipe);
    const std::string path = write_table(folder, "turned.csv", table);
    const std::string file = folder / "turned.json";
    const json material = json_of({path, "-m", "ward-aniso", "--free-frame", "-o", file});
    // The table is noise-free.
    EXPECT_NEAR(value_of(material, "psi"), psi, 1e-6);
    EXPECT_LT(worst_error(material), 1e-6);

    const CommandResult eval = run_gonio({"eval", file, "--table", path});
    ASSERT_EQ(eval.exit_status, 0) << eval.err;
    const std::vector<double> model = column_of(eval.out, "Y_model");
    ASSERT_EQ(model.size(), table.size());
    for (std::size_t i = 0; i < model.size(); ++i) {
      // An exponent of up to 30 feels 2e-6 of the roughness as 1e-4.
      EXPECT_NEAR(model[i] / table.values[0][i], 1, 1e-4) << i;
    }
    const json in_frame = json_of({path, "-m", "ward-aniso"});
    EXPECT_GT(worst_error(in_frame), 0.1) << "the frame of the table is not the material's";
  }
}

TEST(FitCommand, EveryAnisotropicModelIsAskedInAFreeFrame) {
  const json fits = json_of({brass, "--free-frame"}).at("fits");
  std::set<std::string> models;
  for (const json& material : fits) {
    const std::string model = material.at("model");
    models.insert(model);
    EXPECT_EQ(material.at("parameters").contains("psi"), model.ends_with("-aniso")) << model;
  }
  for (const std::string model : {"ward", "ward-approx", "ward-duer", "ward-gmd"}) {
    EXPECT_TRUE(models.contains("lambert+" + model)) << model;
    EXPECT_TRUE(models.contains("lambert+" + model + "-aniso")) << model;
  }
  const CommandResult idle = fit({brass, "-m", "ward", "--free-frame"});
  EXPECT_EQ(idle.exit_status, 0);
  EXPECT_THAT(idle.err, HasSubstr("--free-frame: no model of this fit has a tangent"));
}

TEST(FitCommand, AHomogeneousMaterialAbsorbsNothing) {
  const TemporaryFolder folder;
  instrument::Recipe recipe = brass_recipe();
  recipe.parameters["rho_d"] = {0.4};
  recipe.parameters["rho_s"] = {0.6};
  const std::string path = write_table(folder, "table.csv", instrument::synthesize(recipe));
  const json material = json_of({path, "-m", "ward-aniso", "--homogeneous"});
  EXPECT_NEAR(value_of(material, "rho_d"), 0.4, 1e-6);  // noise-free
  EXPECT_DOUBLE_EQ(value_of(material, "rho_d") + value_of(material, "rho_s"), 1);
  // The plastic absorbs half of the light: the constraint costs something there, and still holds.
  const json forced = json_of({plastic, "-m", "ward", "--homogeneous"});
  EXPECT_DOUBLE_EQ(value_of(forced, "rho_d") + value_of(forced, "rho_s"), 1);

  const CommandResult all = fit({path, "-m", "all", "--homogeneous"});
  EXPECT_EQ(all.exit_status, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr("lambert: left out, it has no rho_s"));
  const CommandResult named = fit({path, "-m", "lambert", "--homogeneous"});
  EXPECT_EQ(named.exit_status, 2);
  EXPECT_THAT(named.err, HasSubstr("homogeneous"));
}

TEST(FitCommand, FindsTwoLobesInOneModel) {
  const TemporaryFolder folder;
  instrument::Recipe recipe = brass_recipe();
  recipe.model = "lambert+ward+ward";
  recipe.parameters = {{"rho_d", {0.2}},
                       {"rho_s", {0.05}},
                       {"alpha", {0.06}},
                       {"rho_s_2", {0.1}},
                       {"alpha_2", {0.25}}};
  const std::string path = write_table(folder, "coated.csv", instrument::synthesize(recipe));
  const json material = json_of({path, "-m", recipe.model});
  EXPECT_EQ(Schema("material.schema.json").complaint(material), "");
  for (const auto& [name, value] : recipe.parameters) {
    EXPECT_NEAR(value_of(material, name) / value[0], 1, 1e-5) << name;  // noise-free
  }
}

// Comparing models ----------------------------------------------------------------------------

TEST(FitCommand, SeveralModelsTellTheErrorsHeldOutAndWhetherTheRicherOneIsNeeded) {
  const Schema schema("material.schema.json");
  const json fits = json_of({plastic, "-m", "lambert,ward,ward-aniso"}).at("fits");
  ASSERT_EQ(fits.size(), 3U);
  for (const json& material : fits) {
    const std::string model = material.at("model");
    SCOPED_TRACE(model);
    EXPECT_EQ(schema.complaint(material), "");
    const json& result = material.at("fit");
    const json& held_out = result.at("held_out");
    // The recipe's four incidence angles, one held out at a time; every sample once.
    ASSERT_EQ(held_out.at("folds").size(), 4U);
    std::size_t values = 0;
    for (const json& fold : held_out.at("folds")) values += fold.at("values").get<std::size_t>();
    EXPECT_EQ(values, result.at("used"));
    // The model's own samples are always fitted better than others.
    EXPECT_GT(held_out.at("errors").at("cosine-l2"), result.at("errors").at("cosine-l2"));
    EXPECT_EQ(result.contains("nested"), model == "lambert+ward");
  }
  const json single = json_of({plastic, "-m", "ward"});
  EXPECT_FALSE(single.at("fit").contains("held_out"));
  EXPECT_FALSE(single.at("fit").contains("nested"));
}

TEST(FitCommand, TheSummaryHasTheErrorsHeldOut) {
  const std::string csv = fit({plastic, "-m", "ward,lambert", "--summary"}).out;
  const json best = json_of({plastic, "-m", "ward,lambert"}).at("fits").at(0).at("fit");
  EXPECT_THAT(csv, HasSubstr("relative,metric_error,held_out,warnings"));
  const std::vector<std::string> fields = split(split(csv, '\n').at(1), ',');
  // table, model, rank, metric, loss, used, converged, five errors, then these.
  EXPECT_NEAR(std::stod(fields.at(12)) / best.at("errors").at("cosine-l2").get<double>(), 1, 1e-12);
  EXPECT_NEAR(
      std::stod(fields.at(13)) / best.at("held_out").at("errors").at("cosine-l2").get<double>(), 1,
      1e-12);
}

TEST(FitCommand, RanksTheIsotropicModelFirstWhereTheRicherOneIsNoBetter) {
  for (const auto& [table, best] :
       {std::pair{plastic, "lambert+ward"}, std::pair{brass, "lambert+ward-aniso"}}) {
    const json fits = json_of({table, "-m", "ward-aniso,ward"}).at("fits");
    EXPECT_EQ(fits.at(0).at("model"), best);
    const bool isotropic_is_first = fits.at(0).at("fit").contains("nested");
    const json& isotropic = fits.at(isotropic_is_first ? 0 : 1).at("fit");
    const json& anisotropic = fits.at(isotropic_is_first ? 1 : 0).at("fit");
    EXPECT_EQ(isotropic.at("nested").at("in"), "lambert+ward-aniso");
    EXPECT_EQ(isotropic.at("nested").at("p_value") > 0.05, isotropic_is_first);
    // By its error alone the richer model would always be the first.
    EXPECT_LE(anisotropic.at("errors").at("cosine-l2"), isotropic.at("errors").at("cosine-l2"));
  }
}

TEST(FitCommand, InformationCriteriaDifferByChiSquareAndTheUnknowns) {
  const json fits = json_of({brass, "-m", "ward-aniso,ward", "--metric", "chi2"}).at("fits");
  const double n = 1696;
  const auto chi2 = [&](const json& material, double k) {
    return material.at("fit").at("reduced_chi2").get<double>() * (n - k);
  };
  const auto penalty = [&](double k) { return 2 * k + 2 * k * (k + 1) / (n - k - 1); };
  const json& rich = fits.at(0);
  const json& plain = fits.at(1);
  const auto difference = [&](const std::string& name) {
    return plain.at("fit").at(name).get<double>() - rich.at("fit").at(name).get<double>();
  };
  // ln of the normalisation is the same for both. chi2 is some 9e5: 1e-6 of it is rounding of the
  // sums.
  const double chi2_difference = chi2(plain, 3) - chi2(rich, 4);
  EXPECT_NEAR(difference("aicc"), chi2_difference + penalty(3) - penalty(4), 1e-3);
  EXPECT_NEAR(difference("bic"), chi2_difference - std::log(n), 1e-3);
}

TEST(FitCommand, TheReportKeepsToAHundredColumns) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{brass, "--metric", "chi2"},
        std::vector<std::string>{plastic, "--free-frame", "--loss", "cauchy"},
        std::vector<std::string>{brass, "-m", "lambert+ward-approx-aniso+ward-approx-aniso",
                                 "--fix", "rho_s_2=0.1", "--fix", "alpha_x_2=0.3", "--fix",
                                 "alpha_y_2=0.3", "--loss", "tukey", "--loss-scale", "0.01"}}) {
    const std::string text = fit(arguments).out;
    std::size_t begin = text.find('\n') + 1;  // the first line begins with the path of the table
    EXPECT_GT(text.size(), begin);
    while (begin < text.size()) {
      const std::size_t end = text.find('\n', begin);
      EXPECT_LE(end - begin, 100U) << text.substr(begin, end - begin);
      begin = end + 1;
    }
  }
}

}  // namespace
}  // namespace gonio::tests
