#include "shader/stage_spirv.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <stdexcept>

namespace gonio::shader {
namespace {

/// glslang counts who uses its tables.
class Compiler {
 public:
  Compiler() { glslang::InitializeProcess(); }
  ~Compiler() { glslang::FinalizeProcess(); }
  Compiler(const Compiler&) = delete;
  Compiler& operator=(const Compiler&) = delete;
};

std::vector<std::uint32_t> words_of(const glslang::TIntermediate& tree) {
  glslang::SpvOptions options;
  options.disableOptimizer = false;  // its passes make legal SPIR-V of what HLSL may write
  options.validate = true;
  spv::SpvBuildLogger logger;
  std::vector<std::uint32_t> words;
  glslang::GlslangToSpv(tree, words, &logger, &options);
  const std::string log = logger.getAllMessages();
  if (!log.empty()) throw std::runtime_error("HLSL shader: " + log);
  return words;
}

}  // namespace

std::vector<std::uint32_t> compile_drawing(const std::string& hlsl, DrawingStage stage) {
  static const Compiler compiler;
  constexpr int semantics_version = 100;  // of Vulkan, as glslang counts
  const EShLanguage language = stage == DrawingStage::vertex ? EShLangVertex : EShLangFragment;
  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgReadHlsl);
  const char* const text = hlsl.c_str();

  glslang::TShader shader(language);
  shader.setStrings(&text, 1);
  shader.setEnvInput(glslang::EShSourceHlsl, language, glslang::EShClientVulkan, semantics_version);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  shader.setEntryPoint("main");
  shader.setSourceEntryPoint("main");
  if (!shader.parse(GetDefaultResources(), semantics_version, false, rules)) {
    throw std::runtime_error(std::string("HLSL shader: ") + shader.getInfoLog());
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) {
    throw std::runtime_error(std::string("HLSL shader: ") + program.getInfoLog());
  }
  return words_of(*program.getIntermediate(language));
}

}  // namespace gonio::shader
