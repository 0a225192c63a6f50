#include "shader/spirv.h"

#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <sstream>
#include <stdexcept>
#include <string>

namespace gonio::shader {
namespace {

/// The compiler's tables, once for the process.
class Compiler {
 public:
  Compiler() { glslang::InitializeProcess(); }
  ~Compiler() { glslang::FinalizeProcess(); }
  Compiler(const Compiler&) = delete;
  Compiler& operator=(const Compiler&) = delete;
};

std::string in_one_line(const std::string& log) {
  std::istringstream lines(log);
  std::string joined;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last == std::string::npos) continue;
    if (!joined.empty()) joined += "; ";
    joined.append(line, 0, last + 1);
  }
  return joined;
}

[[noreturn]] void refuse(Language language, const std::string& log) {
  throw std::runtime_error(std::string(language == Language::hlsl ? "HLSL" : "GLSL") +
                           " shader: " + in_one_line(log));
}

EShMessages message_rules(Language language) {
  const int rules = EShMsgSpvRules | EShMsgVulkanRules;
  return static_cast<EShMessages>(language == Language::hlsl ? rules | EShMsgReadHlsl : rules);
}

EShLanguage glslang_stage(Stage stage) {
  switch (stage) {
    case Stage::vertex:
      return EShLangVertex;
    case Stage::fragment:
      return EShLangFragment;
    case Stage::compute:
      break;
  }
  return EShLangCompute;
}

void set_target(glslang::TShader& shader, Language language, EShLanguage stage) {
  constexpr int glsl_of_vulkan = 100;
  shader.setEnvInput(language == Language::hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl,
                     stage, glslang::EShClientVulkan, glsl_of_vulkan);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  shader.setEntryPoint("main");
  shader.setSourceEntryPoint("main");
}

std::vector<std::uint32_t> words_of(const glslang::TProgram& program, Language language,
                                    EShLanguage stage) {
  glslang::SpvOptions options;
  options.disableOptimizer = false;  // HLSL has constructs that only its passes make legal SPIR-V
  options.validate = true;
  spv::SpvBuildLogger logger;
  std::vector<std::uint32_t> words;
  const glslang::TIntermediate& program_tree = *program.getIntermediate(stage);
  if (program_tree.getNumEntryPoints() == 0) refuse(language, "there is no function main");
  glslang::GlslangToSpv(program_tree, words, &logger, &options);
  const std::string log = logger.getAllMessages();
  if (!log.empty()) refuse(language, log);
  return words;
}

}  // namespace

std::vector<std::uint32_t> compile(std::string_view source, Language language, Stage stage) {
  static const Compiler compiler;
  constexpr int default_version = 450;  // of a GLSL text without #version
  const EShMessages rules = message_rules(language);
  const char* text = source.data();
  const int length = static_cast<int>(source.size());

  const EShLanguage own_stage = glslang_stage(stage);
  glslang::TShader shader(own_stage);
  shader.setStringsWithLengths(&text, &length, 1);
  set_target(shader, language, own_stage);
  if (!shader.parse(GetDefaultResources(), default_version, false, rules)) {
    refuse(language, shader.getInfoLog());
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) refuse(language, program.getInfoLog());
  return words_of(program, language, own_stage);
}

}  // namespace gonio::shader
