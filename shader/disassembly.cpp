#include "shader/disassembly.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

namespace gonio::shader {
namespace {

constexpr std::array<std::string_view, 7> transcendental_starts{
    "v_exp_", "v_log_", "v_rcp_", "v_rsq_", "v_sqrt_", "v_sin_", "v_cos_"};
constexpr std::array<std::string_view, 3> texture_starts{"image_sample", "image_load",
                                                         "image_gather"};
constexpr std::array<std::string_view, 7> load_starts{
    "s_load_",      "s_buffer_load_", "buffer_load_", "tbuffer_load_",
    "global_load_", "flat_load_",     "scratch_load_"};

bool starts_with_one_of(std::string_view word, std::span<const std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return word.starts_with(start); });
}

/// The first word of the line.
std::string_view first_word(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  line.remove_prefix(first);
  return line.substr(0, line.find_first_of(" \t\r;"));
}

/// Of lower-case letters, which labels (`BB1:`) are not, digits and underscores.
bool is_mnemonic(std::string_view word) {
  const auto belongs = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !word.empty() && word.front() >= 'a' && word.front() <= 'z' &&
         std::all_of(word.begin(), word.end(), belongs);
}

/// N of a line `(then repeated N times)`, 0 for another line.
int repetitions(std::string_view line) {
  constexpr std::string_view start = "(then repeated ";
  const std::size_t found = line.find(start);
  int count = 0;
  if (found == std::string_view::npos) return 0;
  line.remove_prefix(found + start.size());
  std::from_chars(line.data(), line.data() + line.size(), count);
  return count;
}

void add(OperationCounts& counts, std::string_view mnemonic, int times) {
  counts.instructions += times;
  if (starts_with_one_of(mnemonic, transcendental_starts)) counts.transcendental += times;
  if (starts_with_one_of(mnemonic, texture_starts)) counts.texture_reads += times;
  if (starts_with_one_of(mnemonic, load_starts)) counts.memory_loads += times;
}

}  // namespace

OperationCounts count_operations(std::string_view disassembly) {
  OperationCounts counts;
  std::string_view last;
  while (!disassembly.empty()) {
    const std::size_t end = std::min(disassembly.find('\n'), disassembly.size());
    const std::string_view line = disassembly.substr(0, end);
    const std::string_view word = first_word(line);
    disassembly.remove_prefix(std::min(end + 1, disassembly.size()));
    if (is_mnemonic(word)) {
      add(counts, word, 1);
      last = word;
    } else {
      add(counts, last, repetitions(line));
    }
  }
  return counts;
}

}  // namespace gonio::shader
