// Names, composition and values of models; what is refused, and how.
#include "brdf/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>
#include <set>

#include "brdf/bound_model.h"
#include "brdf/ward.h"

namespace gonio::brdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(std::span<const ModelParameter> parameters) {
  std::vector<std::string> result;
  for (const ModelParameter& p : parameters) result.push_back(p.name);
  return result;
}

template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ModelTest, ABareSpecularNameBringsItsAuthorsDiffuseTerm) {
  EXPECT_EQ(Model("ward-aniso").name(), "lambert+ward-aniso");
  EXPECT_EQ(Model("ward-gmd").name(), "lambert+ward-gmd");
  EXPECT_EQ(Model("lambert").name(), "lambert");
  EXPECT_EQ(Model("lambert+ward-duer").name(), "lambert+ward-duer");
}

TEST(ModelTest, ParametersStandPerTermAmplitudesFirst) {
  const Model model("ward-aniso");
  EXPECT_THAT(names(model.amplitudes()), ElementsAre("rho_d", "rho_s"));
  EXPECT_THAT(names(model.shape()), ElementsAre("alpha_x", "alpha_y"));
  std::vector<std::string> ordered;
  for (const auto& p : ordered_parameters(model)) ordered.push_back(p.parameter->name);
  EXPECT_THAT(ordered, ElementsAre("rho_d", "rho_s", "alpha_x", "alpha_y"));
}

TEST(ModelTest, RefusesWhatIsNoModelAndListsWhatThereIs) {
  for (const char* name : {"", "+", "word", "ward+", "+ward", "ward+lambert", "lambert+lambert",
                           "ward+ward", "lambert+ward+ward", "Ward", " ward", "lambert + ward"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(refusal([&] { Model{name}; }),
                testing::AllOf(HasSubstr("'" + std::string(name) + "'"), HasSubstr("lambert"),
                               HasSubstr("ward-gmd-aniso")));
  }
}

TEST(ModelTest, EveryListedNameIsAModelOfThatName) {
  std::set<std::string> seen;
  for (const std::string& name : model_names()) {
    EXPECT_EQ(Model(name).name(), name);
    EXPECT_TRUE(seen.insert(name).second) << name << " is listed twice";
  }
  EXPECT_EQ(seen.size(), all_terms().size());
}

TEST(ModelTest, EveryParameterIsDescribed) {
  for (const TermEntry& term : all_terms()) {
    SCOPED_TRACE(term.description.name);
    EXPECT_FALSE(term.description.summary.empty());
    EXPECT_FALSE(term.description.source.empty());
    for (const auto& parameters : {term.amplitudes, term.shape}) {
      for (const Parameter& p : parameters) {
        SCOPED_TRACE(p.name);
        EXPECT_FALSE(p.unit.empty());
        EXPECT_FALSE(p.meaning.empty());
        EXPECT_FALSE(p.source.empty());
        EXPECT_LT(p.lower, p.upper);
        EXPECT_LE(p.lower, p.search_lower);
        EXPECT_LT(p.search_lower, p.search_upper);
        EXPECT_LE(p.search_upper, p.upper);
      }
    }
  }
}

TEST(ModelTest, ValueIsTheSumOfItsTerms) {
  const Model model("ward-aniso");
  const auto wi = direction_from_degrees(30, 20);
  const auto wo = direction_from_degrees(40, 190);
  const std::array shape{0.2, 0.4};
  const double lobe = WardLobe::value(0.2, 0.4, wi, wo);
  EXPECT_DOUBLE_EQ(model.evaluate(std::array{0.3, 0.25}, shape, wi, wo),
                   0.3 / std::numbers::pi + 0.25 * lobe);
  std::array<double, 2> basis{};
  model.basis(shape, wi, wo, basis);
  EXPECT_DOUBLE_EQ(basis[0], 1 / std::numbers::pi);
  EXPECT_EQ(basis[1], lobe);
}

TEST(BoundModelTest, EvaluatesEveryChannelWithItsAmplitudes) {
  const std::array rho_d{0.1, 0.2, 0.3};
  const std::array rho_s{0.3, 0.0, 0.1};
  const std::array alpha{0.15};
  const std::array<NamedValues, 3> values{
      {{"alpha", alpha}, {"rho_s", rho_s}, {"rho_d", rho_d}}};  // in any order
  const BoundModel bound(Model("ward"), 3, values);
  const auto wi = direction_from_degrees(30, 0);
  const auto wo = direction_from_degrees(35, 170);
  std::array<double, 3> f_r{};
  bound.f_r(wi, wo, f_r);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(f_r[c], Model("ward").evaluate(std::array{rho_d[c], rho_s[c]}, alpha, wi, wo));
  }
}

TEST(BoundModelTest, RefusesUnsuitableValuesAndNamesTheParameter) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  struct Case {
    std::vector<double> rho_d, rho_s, alpha;
    std::string parameter, reason;
  };
  const Case cases[] = {
      {{.1, .2}, {.1}, {.1}, "rho_s", "found 1 value, expected 2, one per channel"},
      {{.1, .2}, {.1, .1}, {.1, .1}, "alpha", "found 2 values, expected 1, shared"},
      {{.1, -.2}, {.1, .1}, {.1}, "rho_d", "found -0.2, outside the bounds"},
      {{.1, nan}, {.1, .1}, {.1}, "rho_d", "found nan"},
      {{.1, infinity}, {.1, .1}, {.1}, "rho_d", "found inf"},
      {{.1, .1}, {.1, .1}, {9e-5}, "alpha", "found 9e-05"},
      {{.1, .1}, {.1, .1}, {11}, "alpha", "expected 1e-04 to 10"},
  };
  for (const Case& c : cases) {
    const std::array<NamedValues, 3> values{
        {{"rho_d", c.rho_d}, {"rho_s", c.rho_s}, {"alpha", c.alpha}}};
    try {
      const BoundModel accepted(Model("ward"), 2, values);
      ADD_FAILURE() << "accepted: " << c.reason;
    } catch (const ParameterError& error) {
      EXPECT_EQ(error.parameter(), c.parameter);
      EXPECT_THAT(error.what(), HasSubstr(c.reason));
    }
  }
}

TEST(BoundModelTest, RefusesMissingUnknownAndDoubleParameters) {
  const std::array one{0.1};
  const auto bind = [](std::vector<NamedValues> values) { BoundModel(Model("ward"), 1, values); };
  EXPECT_THAT(refusal([&] {
                bind({{"rho_d", one}, {"rho_s", one}});
              }),
              HasSubstr("missing, expected all parameters of lambert+ward: rho_d, rho_s, alpha"));
  EXPECT_THAT(refusal([&] {
                bind({{"roughness", one}});
              }),
              HasSubstr("not a parameter of lambert+ward, expected rho_d, rho_s, alpha"));
  EXPECT_THAT(refusal([&] {
                bind({{"rho_d", one}, {"rho_s", one}, {"alpha", one}, {"alpha", one}});
              }),
              HasSubstr("twice"));
}

}  // namespace
}  // namespace gonio::brdf
