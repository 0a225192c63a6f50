// gonio export: a material as a renderer or a shader takes it, with what was lost.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "apps/gonio/command.h"
#include "export/account.h"
#include "export/target.h"
#include "material/material_json.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

struct ExportOptions {
  std::string material;
  std::string to;
  std::optional<std::string> table;
  std::string output;
  bool json = false;
};

/// The path of a file of the export, beside the one that the user named.
std::string path_of(const std::string& output, const exports::ExportedFile& file) {
  if (file.suffix.empty()) return output;
  const std::filesystem::path path(output);
  return path.parent_path() / (path.stem().string() + file.suffix);
}

nlohmann::ordered_json json_of(const exports::Exported& exported, const exports::Target& target,
                               const std::vector<std::string>& paths) {
  return {{"target", target.name},
          {"files", paths},
          {"stand_in", exported.fitted_as},
          {"loss",
           {{"peak", exported.loss.peak},
            {"rms", exported.loss.rms},
            {"albedo", exported.loss.albedo}}},
          {"warnings", exported.warnings}};
}

/// What the user has to know, to stdout or beside the exported text.
std::string report(const exports::Exported& exported, const std::vector<std::string>& paths) {
  std::string text;
  for (const std::string& path : paths) text += fmt::format("{}\n", path);
  text += fmt::format("  stand-in: {}\n  loss of reflected radiance: {}\n", exported.fitted_as,
                      exports::loss_text(exported.loss));
  for (const std::string& warning : exported.warnings) {
    text += fmt::format("  warning: {}\n", warning);
  }
  return text;
}

/// The targets that read a look-up table.
std::vector<std::string> targets_with_table() {
  std::vector<std::string> names;
  for (const exports::Target& target : exports::all_targets()) {
    if (target.write_with_table != nullptr) names.push_back(target.name);
  }
  return names;
}

exports::Exported write_with_table(const ExportOptions& options, const exports::Target& target,
                                   const std::string& path) {
  if (target.write_with_table == nullptr) {
    throw std::invalid_argument(
        fmt::format("export --to {}: --table {}: expected none: only {} read a table", target.name,
                    path, fmt::join(targets_with_table(), " and ")));
  }
  const material::Material material = material::read_material(options.material);
  const exports::ShaderTable table = exports::read_shader_table(path);
  try {
    return target.write_with_table(material, table);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("export {} --table {}: {}", options.material, path, error.what()));
  }
}

exports::Exported write(const ExportOptions& options, const exports::Target& target) {
  if (options.table) return write_with_table(options, target, *options.table);
  return target.write(material::read_material(options.material),
                      std::filesystem::path(options.output).stem().string());
}

void export_material(const ExportOptions& options) {
  const exports::Target& target = exports::target_named(options.to);
  const exports::Exported exported = write(options, target);
  if (options.output.empty()) {
    if (options.json || exported.files.size() > 1) {
      throw std::invalid_argument(
          fmt::format("export --to {}: -o FILE is missing: {}", target.name,
                      options.json ? "stdout is for the report" : "there is more than one file"));
    }
    print(exported.files.front().text);
    std::string notes = report(exported, {});
    notes.pop_back();
    print_note(notes);
    return;
  }
  std::vector<std::string> paths;
  for (const exports::ExportedFile& file : exported.files) {
    paths.push_back(path_of(options.output, file));
    refuse_overwriting(options.material, paths.back());
    if (options.table) refuse_overwriting(*options.table, paths.back());
  }
  for (std::size_t k = 0; k < paths.size(); ++k) {
    table::write_file(paths[k], exported.files[k].text);
  }
  if (options.json) {
    print_json(json_of(exported, target, paths));
  } else {
    print(report(exported, paths));
  }
}

std::string list_of_targets() {
  std::string text = "Targets:\n";
  for (const exports::Target& target : exports::all_targets()) {
    text += fmt::format("  {:<14}{}\n", target.name, target.summary);
  }
  return text;
}

}  // namespace

void add_export_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export", "Write a material for a renderer or a shader, and say what was lost");
  std::vector<std::string> names;
  for (const exports::Target& target : exports::all_targets()) names.push_back(target.name);
  command->add_option("MATERIAL", options->material, "The material (JSON)")->required();
  command->add_option("--to", options->to, fmt::format("{}", fmt::join(names, ", ")))
      ->required()
      ->type_name("TARGET");
  command
      ->add_option("--table", options->table,
                   fmt::format("A look-up table (gonio lut bake) that the shader reads the lobe "
                               "from; for {}",
                               fmt::join(targets_with_table(), " and ")))
      ->type_name("EXR");
  command->add_option("-o,--output", options->output,
                      "The file to write; without it, to stdout, and the loss to stderr");
  command->add_flag("--json", options->json, "Print what was written and lost as JSON");
  command->footer(list_of_targets());
  command->callback([options] { export_material(*options); });
}

}  // namespace gonio::app
