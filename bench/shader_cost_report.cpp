#include "bench/shader_cost_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace gonio::bench {
namespace {

/// "Is the first cheaper than the second?" of two listings.
struct Question {
  std::string_view text;
  std::string_view subject;
  std::string_view path;
  std::string_view rival;
};

constexpr std::array<Question, 7> questions{{
    {"Oren-Nayar: is van Ouwerkerk's rewrite cheaper than sin and tan?", "Oren-Nayar",
     "van Ouwerkerk's rewrite", "sin and tan of the angles"},
    {"Oren-Nayar: is the form without normalise and root cheaper than the rewrite?", "Oren-Nayar",
     "no normalise, no root", "van Ouwerkerk's rewrite"},
    {"Phong: is Blinn-Phong by lit() cheaper than Phong?", "Phong", "Blinn-Phong by lit()",
     "Phong"},
    {"Phong: is Blinn-Phong cheaper than Phong?", "Phong", "Blinn-Phong", "Phong"},
    {"Ward: is the look-up cheaper than tan(acos(n.h))?", "Ward isotropic", "512-texel table",
     "tan(acos(n.h))"},
    {"Ward: is the look-up cheaper than 1/(n.h)^2 - 1?", "Ward isotropic", "512-texel table",
     "1/(n.h)^2 - 1"},
    {"Ward: is the look-up cheaper than the components of l + v?", "Ward isotropic",
     "512-texel table", "components of l + v"},
}};

const shader::InstructionCounts& counts_of(const ChipCosts& costs, std::string_view subject,
                                           std::string_view path) {
  const auto found = std::find_if(costs.costs.begin(), costs.costs.end(), [&](const auto& cost) {
    return cost.shader.subject == subject && cost.shader.path == path;
  });
  if (found == costs.costs.end()) {
    throw std::logic_error(fmt::format("shader_cost counts no '{}' of '{}'", path, subject));
  }
  return found->counts;
}

/// The numbers by which one shader is cheaper than another.
std::array<int, 3> measures_of(const shader::InstructionCounts& counts) {
  return {counts.operations.instructions, counts.estimated_latency,
          counts.estimated_inverse_throughput};
}

std::string_view verdict(const std::array<int, 3>& of, const std::array<int, 3>& rival) {
  int smaller = 0;
  int larger = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    smaller += of[i] < rival[i] ? 1 : 0;
    larger += of[i] > rival[i] ? 1 : 0;
  }
  if (larger == 0) return smaller > 0 ? "yes" : "no: the same";
  return smaller == 0 ? "no" : "by one measure, not by another";
}

std::string comparison(const shader::InstructionCounts& of,
                       const shader::InstructionCounts& rival) {
  const auto a = measures_of(of);
  const auto b = measures_of(rival);
  return fmt::format("{} (instructions {} : {}, latency {} : {}, busy {} : {})\n", verdict(a, b),
                     a[0], b[0], a[1], b[1], a[2], b[2]);
}

/// What the listings' authors claim.
std::string answers_on_listings(const ChipCosts& costs) {
  std::string text;
  for (const Question& question : questions) {
    text += fmt::format("{}\n    {}", question.text,
                        comparison(counts_of(costs, question.subject, question.path),
                                   counts_of(costs, question.subject, question.rival)));
  }
  return text;
}

/// Every table against the arithmetic that it stands for, the parameters being literals in both.
std::string answers_on_tables(const ChipCosts& costs) {
  std::string text = "Is the table cheaper than the composed function without it?\n";
  const ShaderCost* computed = nullptr;
  for (const ShaderCost& cost : costs.costs) {
    if (cost.shader.parameters != "literals") continue;
    if (cost.shader.path == "analytic") {
      computed = &cost;
    } else if (computed != nullptr) {
      text += fmt::format("    {}, {}: {}", cost.shader.subject, cost.shader.path,
                          comparison(cost.counts, computed->counts));
    }
  }
  return text;
}

std::string line_of(const ShaderCost& cost) {
  const shader::InstructionCounts& counts = cost.counts;
  const shader::OperationCounts& operations = counts.operations;
  std::string line = fmt::format(
      "  {:<34}{:<10}{:>6}{:>9}{:>9}{:>7}{:>7}{:>7}{:>9}{:>7}{:>8}", cost.shader.path,
      cost.shader.parameters, operations.instructions, operations.transcendental,
      operations.texture_reads, operations.memory_loads, counts.vector_registers,
      counts.scalar_registers, counts.estimated_latency, counts.estimated_inverse_throughput,
      cost.shader.published > 0 ? fmt::format("{}", cost.shader.published) : "");
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

}  // namespace

std::string shader_cost_preface() {
  return R"(Pixel shaders as Mesa's RADV compiles them for a chip that need not be there.

  instr       instructions, of all branches
  transc      exp, log, rcp, rsq, sqrt, sin and cos among them
  texture     texture reads
  loads       of constants and of the descriptors of textures
  VGPR, SGPR  registers
  latency     of a wave alone, in cycles: the compiler's estimate, not measured
  busy        of the busiest unit for each wave (inverse throughput), in cycles: the same
  D3D10       instructions published for Direct3D 10

The published listings and their rivals normalise interpolated n, l and v; the composed functions
(analytic, tables) wi and wo in the local frame. `interface` is what that alone costs. Parameters
are uniforms, or literals with which the compiler reckons ahead.
)";
}

std::string shader_cost_table(const std::string& chip, const ChipCosts& costs) {
  std::string text = fmt::format("\n{}: {}\n", chip, costs.device);
  text += fmt::format("  {:<44}{:>6}{:>9}{:>9}{:>7}{:>7}{:>7}{:>9}{:>7}{:>8}\n", "", "instr",
                      "transc", "texture", "loads", "VGPR", "SGPR", "latency", "busy", "D3D10");
  std::string_view subject;
  for (const ShaderCost& cost : costs.costs) {
    if (cost.shader.subject != subject) text += cost.shader.subject + '\n';
    subject = cost.shader.subject;
    text += line_of(cost);
  }
  text += '\n';
  return text + answers_on_listings(costs) + answers_on_tables(costs);
}

std::string shader_cost_json(const std::string& chip, const ChipCosts& costs) {
  nlohmann::ordered_json shaders = nlohmann::ordered_json::array();
  for (const ShaderCost& cost : costs.costs) {
    const shader::InstructionCounts& counts = cost.counts;
    nlohmann::ordered_json entry{
        {"subject", cost.shader.subject},
        {"path", cost.shader.path},
        {"parameters", cost.shader.parameters},
        {"instructions", counts.operations.instructions},
        {"transcendental", counts.operations.transcendental},
        {"texture_reads", counts.operations.texture_reads},
        {"memory_loads", counts.operations.memory_loads},
        {"vector_registers", counts.vector_registers},
        {"scalar_registers", counts.scalar_registers},
        {"estimated_latency", counts.estimated_latency},
        {"estimated_inverse_throughput", counts.estimated_inverse_throughput}};
    if (cost.shader.published > 0) entry["published_direct3d10"] = cost.shader.published;
    shaders.push_back(std::move(entry));
  }
  return nlohmann::ordered_json{{"chip", chip}, {"device", costs.device}, {"shaders", shaders}}
      .dump(1);
}

}  // namespace gonio::bench
