// compose_shaders FOLDER: writes the pixel shader of every model in HLSL, for any of its materials,
// and with each look-up table for one, for bench/compile_shaders to compile as the project is
// built.
//
// Exit status: 0 written; 2 wrong usage; 3 the folder cannot be written to.
#include <filesystem>
#include <stdexcept>
#include <string>

#include "bench/material_functions.h"
#include "bench/material_shader.h"
#include "bench/shader_materials.h"
#include "bench/study_main.h"
#include "table/output_file.h"

namespace gonio::bench {
namespace {

/// `lambert+ward-aniso`, `lambert+ward-aniso.free-frame.ward-exponent-sqrt`
std::string stem_of(const brdf::Model& model, const MaterialFunction& function) {
  std::string stem = model.name() + (model.has_free_frame() ? ".free-frame" : "");
  if (!function.reads_table) return stem;
  std::string table = function.path;
  table.replace(table.find(", "), 2, "-");
  return stem + "." + table;
}

/// The parameters of a function with a table are numbers in it, because the table depends on them.
void write_shaders(const brdf::Model& model, const std::filesystem::path& folder) {
  for (const MaterialFunction& function : material_functions(model, {})) {
    const auto source =
        function.reads_table ? ParameterSource::literals : ParameterSource::uniforms;
    const std::filesystem::path file = folder / (stem_of(model, function) + ".hlsl");
    table::write_file(file.string(), material_pixel_shader(function.text, source));
  }
}

int run(int argc, char** argv) {
  if (argc != 2) throw std::invalid_argument("usage: compose_shaders FOLDER");
  for (const brdf::Model& model : shader_models()) write_shaders(model, argv[1]);
  return 0;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("compose_shaders", gonio::bench::run, argc, argv);
}
