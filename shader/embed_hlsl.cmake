# Writes OUTPUT, a C++ source with the text of every file of SOURCES (separated by |) in it, in their
# order, so that the programs need no files to write shaders.
#
# Run by the build: cmake -DSOURCES=a.hlsl|b.hlsl -DOUTPUT=hlsl_sources.cpp -P embed_hlsl.cmake
string(REPLACE "|" ";" SOURCES "${SOURCES}")
set(entries "")
set(count 0)
foreach(source IN LISTS SOURCES)
  file(READ "${source}" text)
  get_filename_component(name "${source}" NAME)
  string(APPEND entries "    {\"${name}\", R\"hlsl(${text})hlsl\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE "${OUTPUT}" "// Made from shader/hlsl by embed_hlsl.cmake.
#include \"shader/hlsl_sources.h\"

#include <array>

namespace gonio::shader {

std::span<const HlslSource> hlsl_sources() {
  static constexpr std::array<HlslSource, ${count}> sources{{
${entries}  }};
  return sources;
}

}  // namespace gonio::shader
")
