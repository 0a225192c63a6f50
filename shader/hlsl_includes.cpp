#include <algorithm>
#include <stdexcept>
#include <vector>

#include "shader/hlsl_sources.h"

namespace gonio::shader {
namespace {

std::string_view text_of(std::string_view file) {
  const std::span<const HlslSource> all = hlsl_sources();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const HlslSource& s) { return s.file == file; });
  if (found == all.end()) {
    throw std::logic_error("there is no HLSL source '" + std::string(file) + "' in shader/hlsl");
  }
  return found->text;
}

/// The file that a line `#include "file"` names; empty for any other line.
std::string_view included_file(std::string_view line) {
  constexpr std::string_view start = "#include \"";
  if (!line.starts_with(start)) return {};
  line.remove_prefix(start.size());
  return line.substr(0, line.find('"'));
}

/// Writes files in the order of their dependencies, depth first.
class IncludedText {
 public:
  void add(std::string_view file) {
    if (std::find(seen_.begin(), seen_.end(), file) != seen_.end()) return;
    seen_.push_back(file);
    std::string own;
    bool after_include = false;
    for (std::string_view rest = text_of(file); !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('\n') + 1);
      rest.remove_prefix(line.size());
      const std::string_view included = included_file(line);
      if (!included.empty()) add(included);
      // The empty line that parts the includes from the code goes with them.
      if (included.empty() && !(after_include && line == "\n")) own += line;
      after_include = !included.empty();
    }
    text_ += own + '\n';
  }

  const std::string& text() const { return text_; }

 private:
  std::vector<std::string_view> seen_;
  std::string text_;
};

}  // namespace

std::string hlsl_with_includes(std::span<const std::string_view> files) {
  IncludedText included;
  for (const std::string_view file : files) included.add(file);
  return included.text();
}

}  // namespace gonio::shader
