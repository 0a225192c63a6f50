#include "shader/compose.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "lut/table_model.h"
#include "shader/function_text.h"
#include "shader/glsl.h"
#include "shader/hlsl_sources.h"
#include "shader/identifier.h"
#include "shader/table_source.h"

namespace gonio::shader {
namespace {

std::string comment_line(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, ' ');
  // A backslash there would make a comment of the next line too.
  if (line.ends_with('\\')) line += '.';
  return line.empty() ? "//\n" : "// " + line + '\n';
}

/// Code of shader/hlsl, in the language.
std::string in_language(const std::string& hlsl, Language language) {
  return language == Language::hlsl ? hlsl : glsl_from_hlsl(hlsl);
}

std::string comment_of(const std::optional<TableText>& table, Language language) {
  if (!table) return {};
  std::string comment = comment_line(in_language(table_signature(*table), language));
  for (const std::string& line : table_comment(*table)) comment += comment_line(line);
  return comment;
}

/// The comment at the top; the signature in the language.
std::string header(const std::string& signature, const brdf::Model& model, const SourceText& text,
                   const std::string& about_table) {
  std::string comment;
  for (const std::string& line : text.header) comment += comment_line(line);
  if (!text.header.empty()) comment += "//\n";
  comment += fmt::format("// {}\n", signature);
  comment +=
      fmt::format("// The BRDF f_r in 1/sr of the model {}, without the cosine.\n", model.name());
  comment +=
      "// wi points to the light, wo to the viewer: unit vectors in the local frame, x = tangent\n"
      "// (along the brushing), y = bitangent, z = surface normal. 0 where wi.z or wo.z is not\n"
      "// above 0.\n"
      "// The radiance that a directional light of unit perpendicular irradiance gives is f_r *\n"
      "// wi.z; where a shader's diffuse colour stands without 1/pi, pi * f_r * wi.z.\n";
  return comment + about_table + '\n';
}

/// The files of the terms, as hlsl_with_includes wants them.
std::string helpers(const FunctionText& function) {
  std::vector<std::string> files;
  for (const std::string_view name : function.files) files.push_back(std::string(name) + ".hlsl");
  const std::vector<std::string_view> views(files.begin(), files.end());
  return hlsl_with_includes(views);
}

/// What glsl_from_hlsl() takes for granted.
constexpr std::string_view glsl_preamble = R"(#ifndef GONIO_PRECISE
#ifdef GL_ES
precision highp float;
#define GONIO_PRECISE
#else
#define GONIO_PRECISE precise
#endif
#endif

)";

std::string source_of(const brdf::BoundModel& model, const std::optional<TableText>& table,
                      Language language, const SourceText& text) {
  const FunctionText function = function_text(model, identifier_from(text.name), table);
  const std::string declaration = table ? table_signature(*table) + ";\n\n" : "";
  return header(in_language(function.signature, language), model.model(), text,
                comment_of(table, language)) +
         std::string(language == Language::glsl ? glsl_preamble : "") +
         in_language(declaration + helpers(function) + function.text, language);
}

}  // namespace

std::string function_source(const brdf::BoundModel& model, Language language,
                            const SourceText& text) {
  return source_of(model, std::nullopt, language, text);
}

std::string function_source(const brdf::BoundModel& model, const lut::Table& table,
                            Language language, const SourceText& text) {
  lut::require_serves(model, table);
  const TableText table_text{table.layout, table.decoding, table_function(text)};
  return source_of(model, table_text, language, text);
}

std::string table_function(const SourceText& text) { return identifier_from(text.name) + "_table"; }

}  // namespace gonio::shader
