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

std::vector<std::string> ordered_names(const Model& model) {
  std::vector<std::string> result;
  for (const OrderedParameter& p : ordered_parameters(model)) result.push_back(p.parameter->name);
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
  EXPECT_THAT(ordered_names(model), ElementsAre("rho_d", "rho_s", "alpha_x", "alpha_y"));
}

TEST(ModelTest, TheSecondSpecularTermsParametersBearASuffix) {
  const Model model("lambert+ward-gmd+ward-aniso");
  EXPECT_EQ(model.name(), "lambert+ward-gmd+ward-aniso");
  EXPECT_THAT(names(model.amplitudes()), ElementsAre("rho_d", "rho_s", "rho_s_2"));
  EXPECT_THAT(names(model.shape()), ElementsAre("alpha", "alpha_x_2", "alpha_y_2"));
  EXPECT_THAT(ordered_names(model),
              ElementsAre("rho_d", "rho_s", "alpha", "rho_s_2", "alpha_x_2", "alpha_y_2"));
  const Model twice("lambert+ward+ward");
  EXPECT_EQ(twice.name(), "lambert+ward+ward");
  EXPECT_THAT(ordered_names(twice), ElementsAre("rho_d", "rho_s", "alpha", "rho_s_2", "alpha_2"));
}

TEST(ModelTest, AFreeFrameGivesEveryAnisotropicTermItsTangentAngle) {
  const Model one("ward-aniso", Frame::free);
  EXPECT_EQ(one.name(), "lambert+ward-aniso") << "the frame is no part of the name";
  EXPECT_THAT(ordered_names(one), ElementsAre("rho_d", "rho_s", "alpha_x", "alpha_y", "psi"));
  const Model second("lambert+ward+ward-gmd-aniso", Frame::free);
  EXPECT_THAT(names(second.shape()), ElementsAre("alpha", "alpha_x_2", "alpha_y_2", "psi_2"));
  const Model both("lambert+ward-aniso+ward-aniso", Frame::free);
  EXPECT_THAT(names(both.shape()),
              ElementsAre("alpha_x", "alpha_y", "psi", "alpha_x_2", "alpha_y_2", "psi_2"));
  const Parameter& psi = one.shape()[2].descriptor;
  EXPECT_EQ(psi.unit, "rad");
  EXPECT_EQ(psi.scale, Scale::periodic);
  EXPECT_EQ(psi.upper - psi.lower, std::numbers::pi) << "one period";
}

TEST(ModelTest, OnlyAnisotropicModelsHaveAFrame) {
  EXPECT_TRUE(Model("ward-aniso", Frame::free).has_free_frame());
  EXPECT_FALSE(Model("ward-aniso").has_free_frame());
  EXPECT_TRUE(Model("ward-aniso").is_anisotropic());
  for (const char* name : {"lambert", "ward", "lambert+ward+ward-gmd"}) {
    const Model free(name, Frame::free);
    EXPECT_FALSE(free.has_free_frame());
    EXPECT_FALSE(free.is_anisotropic());
    EXPECT_EQ(names(free.shape()), names(Model(name).shape()));
  }
}

TEST(ModelTest, RefusesWhatIsNoModelAndListsWhatThereIsOrWhatIsNearest) {
  for (const char* name :
       {"", "+", "word", "ward+", "+ward", "ward+lambert", "lambert+lambert", "ward+ward", "Ward",
        " ward", "lambert + ward", "lambert+ward+", "lambert++ward", "lambert+ward+lambert",
        "ward+ward+ward", "lambert+ward+ward+ward", "lambert+ward+word"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(refusal([&] { Model{name}; }),
                testing::AllOf(HasSubstr("'" + std::string(name) + "'"),
                               testing::AnyOf(testing::AllOf(HasSubstr("lambert"),
                                                             HasSubstr("diffuse+specular+specular"),
                                                             HasSubstr("ward-gmd-aniso")),
                                              HasSubstr("did you mean '"))));
  }
}

TEST(ModelTest, EveryListedNameIsAModelOfThatName) {
  std::set<std::string> seen;
  for (const std::string& name : model_names()) {
    EXPECT_EQ(Model(name).name(), name);
    EXPECT_TRUE(seen.insert(name).second) << name << " is listed twice";
  }
  // A specular term and the whole model of its name are one in this list.
  std::set<std::string_view> names;
  for (const TermEntry& term : all_terms()) names.insert(term.description.name);
  EXPECT_EQ(seen.size(), names.size());
}

TEST(ModelTest, AWholeModelStandsAloneAndItsSpecularPartInASum) {
  const Model whole("ashikhmin-shirley");
  ASSERT_EQ(whole.terms().size(), 1U);
  EXPECT_EQ(whole.terms()[0]->description.kind, TermKind::whole);
  const Model hybrid("oren-nayar+ashikhmin-shirley");
  ASSERT_EQ(hybrid.terms().size(), 2U);
  EXPECT_EQ(hybrid.terms()[1]->description.kind, TermKind::specular);
  EXPECT_THAT(refusal([] { Model("lambert+strauss"); }),
              HasSubstr("'strauss' is a whole model and takes no other term"));
  EXPECT_THAT(refusal([] { Model("lambert+oren-nayar"); }),
              HasSubstr("'oren-nayar' is a second diffuse term"));
  EXPECT_THAT(refusal([] { Model("lambert+blin-phong"); }),
              HasSubstr("did you mean 'blinn-phong'?"));
}

TEST(ModelTest, ATermsIndexTellsItsPlaceAmongTheEvaluatedOnes) {
  const auto terms = all_terms();
  for (std::size_t i = 0; i < terms.size(); ++i) EXPECT_EQ(terms[i].index, i);
  const Model fixed("ward-aniso");
  const Model free("ward-aniso", Frame::free);
  EXPECT_LT(fixed.terms()[1]->index, terms.size());
  EXPECT_GE(free.terms()[1]->index, terms.size());
  EXPECT_EQ(free.terms()[0]->index, fixed.terms()[0]->index);
  EXPECT_EQ(free.terms()[1]->description.name, "ward-aniso");
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

TEST(ModelTest, TwoLobesAddUpEachWithItsOwnShape) {
  const Model model("lambert+ward+ward-gmd-aniso");
  const auto wi = direction_from_degrees(30, 20);
  const auto wo = direction_from_degrees(40, 190);
  const std::array shape{0.2, 0.3, 0.4};
  EXPECT_DOUBLE_EQ(model.evaluate(std::array{0.3, 0.25, 0.15}, shape, wi, wo),
                   0.3 / std::numbers::pi + 0.25 * WardLobe::value(0.2, 0.2, wi, wo) +
                       0.15 * WardGmdLobe::value(0.3, 0.4, wi, wo));
}

TEST(ModelTest, EachLobeHasItsOwnTangent) {
  const Model model("lambert+ward-aniso+ward-duer-aniso", Frame::free);
  const std::array shape{0.1, 0.3, 0.4, 0.2, 0.5, -0.7};
  const auto turned = [](double theta, double phi, double psi) {
    return direction_from_radians(theta, phi - psi);
  };
  const double first = WardLobe::value(0.1, 0.3, turned(.5, .1, .4), turned(.6, 3, .4));
  const double second = WardDuerLobe::value(0.2, 0.5, turned(.5, .1, -.7), turned(.6, 3, -.7));
  EXPECT_NEAR(
      model.evaluate(std::array{0.0, 0.25, 0.15}, shape, turned(.5, .1, 0), turned(.6, 3, 0)) /
          (0.25 * first + 0.15 * second),
      1, 1e-12);  // free_frame_test derives it
}

TEST(ModelForTest, TheFrameIsFreeIfATangentAngleIsGiven) {
  const std::array value{0.1};
  const auto is_free = [&](const char* name, const char* parameter) {
    const std::array<NamedValues, 2> values{{{"rho_d", value}, {parameter, value}}};
    return model_for(name, values).has_free_frame();
  };
  EXPECT_TRUE(is_free("ward-aniso", "psi"));
  EXPECT_TRUE(is_free("lambert+ward+ward-aniso", "psi_2"));
  EXPECT_FALSE(is_free("ward-aniso", "alpha_x"));
  EXPECT_FALSE(is_free("ward", "psi"));
  EXPECT_THROW(is_free("phlogiston", "psi"), std::invalid_argument);
}

TEST(BoundModelTest, WantsTheTangentAngleOfEveryAnisotropicTermOrOfNone) {
  using Given = std::vector<std::pair<const char*, double>>;
  const auto refusal_of = [](const char* model, const Given& given) {
    std::vector<NamedValues> values;
    for (const auto& [name, value] : given) values.push_back({name, {&value, 1}});
    return refusal([&] { BoundModel(model_for(model, values), 1, values); });
  };
  const char* two = "lambert+ward-aniso+ward-aniso";
  Given given{{"rho_d", .1},   {"rho_s", .1},     {"alpha_x", .1},  {"alpha_y", .2},
              {"rho_s_2", .1}, {"alpha_x_2", .1}, {"alpha_y_2", .2}};
  EXPECT_EQ(refusal_of(two, given), "");
  given.emplace_back("psi_2", 0.5);
  EXPECT_THAT(refusal_of(two, given), HasSubstr("missing, expected all parameters of "
                                                "lambert+ward-aniso+ward-aniso: rho_d, rho_s, "
                                                "alpha_x, alpha_y, psi, rho_s_2"));
  given.emplace_back("psi", 1.6);
  EXPECT_THAT(refusal_of(two, given),
              HasSubstr("found 1.6, outside the bounds of psi, expected -1.5707963267948966 to "
                        "1.5707963267948966, in rad"));
  given.back().second = std::numbers::pi / 2;
  EXPECT_EQ(refusal_of(two, given), "") << "the bounds are closed";
  EXPECT_THAT(refusal_of("ward", {{"rho_d", .1}, {"rho_s", .1}, {"alpha", .1}, {"psi", .1}}),
              HasSubstr("not a parameter of lambert+ward, expected rho_d, rho_s, alpha"));
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
