// Shader functions composed for materials: what is in the text, and that it compiles. What they
// compute is compared with the models in shader_accuracy_test.cpp.
#include "shader/compose.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lut/table.h"
#include "shader/glsl.h"
#include "shader/hlsl_sources.h"
#include "shader/identifier.h"
#include "shader/spirv.h"
#include "shader/term_source.h"

namespace gonio::tests {
namespace {

using brdf::BoundModel;
using brdf::Frame;
using brdf::Model;
using shader::Language;
using testing::HasSubstr;

constexpr std::array languages{Language::hlsl, Language::glsl};

/// Every model that has a name, those with a tangent in either frame, and one with two lobes.
std::vector<Model> models() {
  std::vector<Model> all;
  for (const std::string& name : brdf::model_names()) {
    all.emplace_back(name);
    if (all.back().is_anisotropic()) all.emplace_back(name, Frame::free);
  }
  all.emplace_back("oren-nayar-full+ward-gmd-aniso+ashikhmin-shirley-aniso", Frame::free);
  return all;
}

using Values = std::map<std::string, std::vector<double>>;

BoundModel material_of(const Model& model, std::size_t channels, const Values& values) {
  std::vector<brdf::NamedValues> named;
  named.reserve(values.size());
  for (const auto& [name, list] : values) named.push_back({name, list});
  return {model, channels, named};
}

/// A material with parameters of as many digits as a double has, drawn within the bounds and up
/// to 1 where there is none.
BoundModel drawn_material(const Model& model, std::size_t channels, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto draw = [&](const brdf::Parameter& p) {
    return std::uniform_real_distribution(p.lower, std::min(p.upper, 1.0))(generator);
  };
  Values values;
  for (const brdf::ModelParameter& p : model.shape()) values[p.name] = {draw(p.descriptor)};
  for (const brdf::ModelParameter& p : model.amplitudes()) {
    for (std::size_t c = 0; c < channels; ++c) values[p.name].push_back(draw(p.descriptor));
  }
  return material_of(model, channels, values);
}

BoundModel lambert(const std::vector<double>& rho_d) {
  return material_of(Model("lambert"), rho_d.size(), {{"rho_d", rho_d}});
}

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The words of the code, comments left out.
std::multiset<std::string> words_of(std::string_view text) {
  std::multiset<std::string> words;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (is_word_character(text[i])) {
      const auto* const end = std::find_if_not(text.begin() + i, text.end(), is_word_character);
      words.emplace(text.begin() + i, end);
      i = std::size_t(end - text.begin());
    } else {
      ++i;
    }
  }
  return words;
}

/// Every number in the text, also in its comments; a sign is read with the number.
std::set<double> numbers_of(std::string_view text) {
  std::set<double> numbers;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool inside_word = i > 0 && (is_word_character(text[i - 1]) || text[i - 1] == '.');
    double value = 0;
    if (inside_word) continue;
    if (std::from_chars(text.data() + i, text.data() + text.size(), value).ec == std::errc()) {
      numbers.insert(value);
    }
  }
  return numbers;
}

/// What the compiler has against a fragment shader of WebGL 2; empty if nothing.
std::string complaint_of_glsl_es(const std::string& source) {
  const std::string text = "#version 300 es\n" + source + "void main() {}\n";
  const char* const start = text.c_str();
  glslang::InitializeProcess();
  std::string log;
  {
    glslang::TShader shader(EShLangFragment);
    shader.setStrings(&start, 1);
    if (!shader.parse(GetDefaultResources(), 300, false, EShMsgDefault)) log = shader.getInfoLog();
  }
  glslang::FinalizeProcess();
  return log;
}

TEST(ShaderIdentifier, IsMadeOfTheNamesLettersAndDigits) {
  EXPECT_EQ(shader::identifier_from("rolled brass"), "brdf_rolled_brass");
  EXPECT_EQ(shader::identifier_from("Lack (rot), 2 Schichten"), "brdf_Lack_rot_2_Schichten");
  EXPECT_EQ(shader::identifier_from("5052"), "brdf_5052");
  EXPECT_EQ(shader::identifier_from("float"), "brdf_float");
}

TEST(ShaderIdentifier, HasNoTwoUnderscoresInARow) {  // GLSL reserves such names
  EXPECT_EQ(shader::identifier_from("__a - _b__"), "brdf_a_b");
}

TEST(ShaderIdentifier, OfANameWithoutLettersIsMaterial) {
  EXPECT_EQ(shader::identifier_from(""), "brdf_material");
  EXPECT_EQ(shader::identifier_from("\xc3\xa9\xe2\x82\xac"), "brdf_material");
}

TEST(ShaderIdentifier, OfALongNameIsCutOff) {
  EXPECT_EQ(shader::identifier_from(std::string(5000, 'x')), "brdf_" + std::string(64, 'x'));
}

TEST(HlslSources, GiveEveryTermAFunctionForItsBasis) {
  const std::array<std::string, 4> type{"", "float ", "float2 ", "float3 "};
  for (const Frame frame : {Frame::of_table, Frame::free}) {
    for (const brdf::TermEntry& named : brdf::all_terms()) {
      // A specular term is reached by a sum; a whole or a diffuse one by its name.
      const std::string name(named.description.name);
      const bool is_specular = named.description.kind == brdf::TermKind::specular;
      const Model model(is_specular ? "lambert+" + name : name, frame);
      const brdf::TermEntry& term = *model.terms().back();
      SCOPED_TRACE(model.name());

      const shader::TermSource& source = shader::term_source(term);
      EXPECT_EQ(source.coefficients.size(), term.basis_size);
      const std::string file = std::string(source.name) + ".hlsl";
      EXPECT_THAT(shader::hlsl_with_includes(std::array<std::string_view, 1>{file}),
                  HasSubstr(type.at(term.basis_size) + "gonio_" + std::string(source.name) + "("));
    }
  }
}

TEST(HlslSources, CompileEachForItself) {
  for (const shader::HlslSource& source : shader::hlsl_sources()) {
    const std::string text = shader::hlsl_with_includes(std::array{source.file});
    EXPECT_NO_THROW(shader::compile(text + "[numthreads(1, 1, 1)] void main() {}", Language::hlsl))
        << source.file;
  }
}

TEST(HlslSources, NameAFileThatIsNotThere) {
  EXPECT_THROW(shader::hlsl_with_includes(std::array<std::string_view, 1>{"warp.hlsl"}),
               std::logic_error);
}

TEST(FunctionSource, HoldsTheParametersAsTheDoublesThatTheyAre) {
  for (const Model& model : models()) {
    SCOPED_TRACE(model.name());
    const BoundModel material = drawn_material(model, 3, 1);
    const std::set<double> numbers =
        numbers_of(function_source(material, Language::hlsl, {.name = "drawn", .header = {}}));
    for (const double shape : material.shape()) EXPECT_EQ(numbers.count(shape), 1U) << shape;
    for (std::size_t c = 0; c < 3; ++c) {
      for (const double value : material.coefficients(c)) {
        const bool is_fixed_part = value == 1;
        EXPECT_TRUE(is_fixed_part || numbers.count(value) == 1) << value;
      }
    }
  }
}

TEST(FunctionSource, HoldsTheParametersOfEveryChannelOfASpectrum) {
  const BoundModel material = drawn_material(Model("lambert+ward"), 31, 2);
  const std::set<double> numbers =
      numbers_of(function_source(material, Language::glsl, {.name = "spectral", .header = {}}));
  for (std::size_t c = 0; c < 31; ++c) {
    for (const double value : material.coefficients(c)) EXPECT_EQ(numbers.count(value), 1U);
  }
}

TEST(FunctionSource, HasOnlyTheHelpersThatItsModelNeeds) {
  for (const Model& model : models()) {
    SCOPED_TRACE(model.name());
    const std::string text = function_source(drawn_material(model, 3, 3), Language::hlsl,
                                             {.name = "drawn", .header = {}});
    const std::multiset<std::string> words = words_of(text);
    for (const std::string& word : std::set<std::string>(words.begin(), words.end())) {
      // Once where it is defined and again where it is used.
      EXPECT_TRUE(!word.starts_with("gonio_") || words.count(word) >= 2) << word;
    }
  }
}

TEST(FunctionSource, SaysWhatItComputes) {
  const std::string text = function_source(lambert({0.5}), Language::glsl,
                                           {.name = "chalk", .header = {"chalk", "rho_d 0.5"}});
  EXPECT_TRUE(
      text.starts_with("// chalk\n// rho_d 0.5\n//\n// float brdf_chalk(vec3 wi, vec3 wo)"));
  EXPECT_THAT(text, HasSubstr("f_r in 1/sr of the model lambert, without the cosine"));
}

TEST(FunctionSource, ReturnsAsManyComponentsAsThereAreChannels) {
  const std::array<std::string, 5> signature{
      "float brdf_m(vec3 wi, vec3 wo) {", "vec2 brdf_m(vec3 wi, vec3 wo) {",
      "vec3 brdf_m(vec3 wi, vec3 wo) {", "vec4 brdf_m(vec3 wi, vec3 wo) {",
      "void brdf_m(vec3 wi, vec3 wo, out float f_r[5]) {"};
  for (std::size_t channels = 1; channels <= signature.size(); ++channels) {
    EXPECT_THAT(function_source(lambert(std::vector(channels, 0.5)), Language::glsl,
                                {.name = "m", .header = {}}),
                HasSubstr(signature.at(channels - 1)));
  }
}

TEST(FunctionSource, WritesNumbersThatNoFloatHoldsAsOnesThatItDoesAndSaysSo) {
  const std::string text =
      function_source(lambert({1e300, 1e-310, 0.5}), Language::hlsl, {.name = "odd", .header = {}});
  EXPECT_THAT(text,
              HasSubstr("const float3 rho_d = float3(1e+18, 0.0, 0.5);  // 1e+300 is beyond a "
                        "shader's float; 1e-310 is beyond a shader's float\n"));
}

TEST(FunctionSource, SaysWhereAShapeIsTooSmallForAFloat) {
  const BoundModel material =
      material_of(Model("oren-nayar"), 1, {{"rho_d", {0.5}}, {"sigma", {1e-300}}});
  const std::string text = function_source(material, Language::glsl, {.name = "odd", .header = {}});
  EXPECT_THAT(text, testing::ContainsRegex(
                        "const float sigma = 0\\.0;  // .*; 1e-300 is beyond a shader's float\n"));
}

TEST(FunctionSource, KeepsItsHeaderInComments) {
  // A backslash at a line's end would take the next line into the comment.
  const shader::SourceText text{.name = "odd",
                                .header = {"one\ntwo", "*/ three \\", "", "four\r\\\n"}};
  for (const Language language : languages) {
    const std::string kernel = evaluation_kernel(lambert({0.5}), language, text);
    EXPECT_THAT(kernel, HasSubstr("// one two\n// */ three \\.\n//\n// four"));
    EXPECT_NO_THROW(shader::compile(kernel, language));
  }
}

TEST(EvaluationKernel, CompilesForEveryModelAndNumberOfChannels) {
  for (const Model& model : models()) {
    for (const Language language : languages) {
      for (const std::size_t channels : {1U, 2U, 3U, 4U, 5U, 40U}) {
        SCOPED_TRACE(model.name());
        const std::string kernel = evaluation_kernel(drawn_material(model, channels, 4), language,
                                                     {.name = model.name(), .header = {}});
        EXPECT_NO_THROW(shader::compile(kernel, language)) << kernel;
      }
    }
  }
}

TEST(FunctionSource, CompilesInGlslEsForEveryModelAndNumberOfChannels) {
  for (const Model& model : models()) {
    for (const std::size_t channels : {1U, 2U, 3U, 4U, 5U}) {
      SCOPED_TRACE(model.name());
      EXPECT_EQ(
          complaint_of_glsl_es(function_source(drawn_material(model, channels, 6), Language::glsl,
                                               {.name = "drawn", .header = {}})),
          "");
    }
  }
}

TEST(FunctionSource, OfEveryMaterialFitsIntoOneShader) {
  for (const Language language : languages) {
    std::string functions;
    for (const Model& model : models()) {
      const std::string name = model.name() + (model.has_free_frame() ? " free" : "");
      functions +=
          function_source(drawn_material(model, 3, 5), language, {.name = name, .header = {}});
    }
    const std::string kernel =
        evaluation_kernel(lambert({0.5}), language, {.name = "last", .header = {}});
    const std::size_t after_version = language == Language::glsl ? kernel.find('\n') + 1 : 0;
    EXPECT_NO_THROW(shader::compile(
        kernel.substr(0, after_version) + functions + kernel.substr(after_version), language));
  }
}

/// A small table of the kind for the material.
lut::Table table_of(const BoundModel& material, lut::TableKind kind) {
  lut::Layout layout = lut::layout_for(material, kind);
  layout.width = lut::least_size;
  if (layout.height != 1) layout.height = lut::least_size;
  layout.reach = lut::lobe_reach(layout);
  return lut::bake(layout);
}

/// What a shader that includes the function has to add.
std::string table_definition(const std::string& function) {
  return "vec4 " + function + "(vec2 uv) { return vec4(uv, uv); }\n";
}

TEST(FunctionSourceWithTable, HasOnlyTheHelpersThatItNeeds) {
  for (const Model& model : models()) {
    const BoundModel material = drawn_material(model, 3, 3);
    for (const lut::TableKind kind : lut::tables_for(model)) {
      SCOPED_TRACE(model.name() + " by " + std::string(name_of(kind)));
      const std::multiset<std::string> words = words_of(function_source(
          material, table_of(material, kind), Language::hlsl, {.name = "drawn", .header = {}}));
      for (const std::string& word : std::set<std::string>(words.begin(), words.end())) {
        EXPECT_TRUE(!word.starts_with("gonio_") || words.count(word) >= 2) << word;
      }
      // Declared once, read once by each term.
      EXPECT_GE(words.count("brdf_drawn_table"), 2U);
    }
  }
}

TEST(FunctionSourceWithTable, CompilesInGlslEsWithTheFunctionThatReadsTheTable) {
  for (const Model& model : models()) {
    const BoundModel material = drawn_material(model, 3, 6);
    for (const lut::TableKind kind : lut::tables_for(model)) {
      SCOPED_TRACE(model.name() + " by " + std::string(name_of(kind)));
      const std::string function = function_source(material, table_of(material, kind),
                                                   Language::glsl, {.name = "m", .header = {}});
      EXPECT_EQ(complaint_of_glsl_es(function + table_definition("brdf_m_table")), "");
    }
  }
}

TEST(FunctionSourceWithTable, SaysWhichTextureItsFunctionReads) {
  const BoundModel material = drawn_material(Model("ward"), 1, 7);
  const std::string text = function_source(material, table_of(material, lut::TableKind::ward_lobe),
                                           Language::glsl, {.name = "brass", .header = {}});
  EXPECT_EQ(shader::table_function({.name = "brass", .header = {}}), "brdf_brass_table");
  EXPECT_THAT(text, HasSubstr("// vec4 brdf_brass_table(vec2 uv)\n"));
  EXPECT_THAT(text, HasSubstr("ward-lobe"));
  EXPECT_THAT(text, HasSubstr("cosine, of 16 x 1 texels of the format r32f"));
  EXPECT_THAT(text, HasSubstr("\nvec4 brdf_brass_table(vec2 uv);\n"));
}

TEST(FunctionSourceWithTable, RefusesTheTableOfAnotherMaterial) {
  const BoundModel rough = drawn_material(Model("ward"), 1, 8);
  const BoundModel other = drawn_material(Model("ward"), 1, 9);
  const BoundModel phong = drawn_material(Model("phong"), 1, 8);
  const lut::Table table = table_of(rough, lut::TableKind::ward_lobe);
  const auto compose = [&](const BoundModel& material) {
    return function_source(material, table, Language::hlsl, {.name = "m", .header = {}});
  };
  EXPECT_NO_THROW(compose(rough));
  EXPECT_THROW(compose(other), std::invalid_argument);
  EXPECT_THROW(compose(phong), std::invalid_argument);
}

TEST(EvaluationKernelWithTable, CompilesForEveryModelAndNumberOfChannels) {
  for (const Model& model : models()) {
    for (const lut::TableKind kind : lut::tables_for(model)) {
      for (const Language language : languages) {
        for (const std::size_t channels : {1U, 3U, 5U}) {
          SCOPED_TRACE(model.name() + " by " + std::string(name_of(kind)));
          const BoundModel material = drawn_material(model, channels, 4);
          const std::string kernel = evaluation_kernel(material, table_of(material, kind), language,
                                                       {.name = model.name(), .header = {}});
          EXPECT_NO_THROW(shader::compile(kernel, language)) << kernel;
        }
      }
    }
  }
}

TEST(GlslFromHlsl, TranslatesWordsAndLeavesCommentsAndOtherWordsAlone) {
  EXPECT_EQ(shader::glsl_from_hlsl("static const float3 a_float3 = b.xyz;  // static float3\n"
                                   "#define X float3\n"
                                   "precise float2 c = float2(1e-3, asfloat(asuint(2.5)));\n"),
            "const vec3 a_float3 = b.xyz;  // static float3\n"
            "#define X float3\n"
            "GONIO_PRECISE vec2 c = vec2(1e-3, uintBitsToFloat(floatBitsToUint(2.5)));\n");
}

}  // namespace
}  // namespace gonio::tests
