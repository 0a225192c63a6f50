// gonio lut bake: a look-up table for a shader, as an EXR file that says how it is read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "apps/gonio/lut_command.h"
#include "apps/gonio/lut_options.h"
#include "lut/table.h"
#include "lut/table_exr.h"
#include "lut/table_text.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

struct BakeOptions {
  std::string material;
  LutOptions lut;
  std::string output;
  bool json = false;
};

/// How a shader reads the table, line by line.
std::vector<std::string> sampling_lines(const lut::Layout& layout) {
  std::istringstream text(lut::sampling_text(layout));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

/// The terms of a material's model: those that the table serves, and the rest.
struct Terms {
  std::vector<std::string_view> served;
  std::vector<std::string_view> computed;
};

Terms terms_of(const brdf::Model& model, lut::TableKind kind) {
  Terms terms;
  for (const brdf::TermEntry* term : model.terms()) {
    const bool is_served = lut::is_served(term->description, kind);
    (is_served ? terms.served : terms.computed).push_back(term->description.name);
  }
  return terms;
}

/// What is baked; without a material no terms are known.
struct Plan {
  lut::Layout layout;
  std::optional<Terms> terms;
};

nlohmann::ordered_json json_of(const lut::Table& table, const std::optional<Terms>& terms,
                               const std::string& file) {
  const lut::Layout& layout = table.layout;
  const std::size_t channels = static_cast<std::size_t>(table.texture.channels);
  nlohmann::ordered_json json{{"file", file},
                              {"table", lut::name_of(layout.kind)},
                              {"coordinate", lut::name_of(layout.coordinate)},
                              {"reach", layout.reach},
                              {"width", layout.width},
                              {"height", layout.height},
                              {"channels", channels},
                              {"format", lut::name_of(layout.storage)},
                              {"bytes", lut::bytes_of(table.texture)},
                              {"serves", lut::served_text(layout)}};
  if (channels == 1) {
    json["lowest"] = layout.lowest;
    json["highest"] = layout.highest;
  } else {
    json["argument"] = layout.of_cosine ? "cosine" : "angle";
    json["t"] = layout.transparency;
  }
  if (terms) json["terms"] = {{"served", terms->served}, {"computed", terms->computed}};
  std::vector<float> scale;
  for (std::size_t c = 0; c < channels; ++c) scale.push_back(table.decoding[c].scale);
  json["scale"] = scale;
  json["sampling"] = sampling_lines(layout);
  return json;
}

/// "\n  serves: ward; computed: lambert, blinn-phong"
std::string terms_text(const Terms& terms) {
  std::string text = fmt::format("\n  serves: {}", fmt::join(terms.served, ", "));
  if (!terms.computed.empty()) {
    text += fmt::format("; computed: {}", fmt::join(terms.computed, ", "));
  }
  return text;
}

std::string report(const lut::Table& table, const std::optional<Terms>& terms,
                   const std::string& file) {
  const lut::Layout& layout = table.layout;
  std::string text = fmt::format(
      "{}\n  table: {} for {}{}\n  texels: {} x {} of {}{}, {} bytes\n  coordinate: {}, reach "
      "{:.6g}\n"
      "  in a shader, with linear filtering and clamped addressing:\n",
      file, lut::name_of(layout.kind), lut::served_text(layout),
      terms ? terms_text(*terms) : std::string(), layout.width, layout.height,
      table.texture.channels == 2 ? "two channels of " : "", lut::name_of(layout.storage),
      lut::bytes_of(table.texture), lut::name_of(layout.coordinate), layout.reach);
  for (const std::string& line : sampling_lines(layout)) text += fmt::format("    {}\n", line);
  return text;
}

Plan plan_in(const BakeOptions& options) {
  if (options.material.empty()) return {layout_from(options.lut, nullptr), std::nullopt};
  refuse_overwriting(options.material, options.output);
  const brdf::BoundModel model = material::bind(material::read_material(options.material));
  const lut::Layout layout = layout_from(options.lut, &model);
  return {layout, terms_of(model.model(), layout.kind)};
}

void check_extension(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".exr") return;
  throw std::invalid_argument(fmt::format(
      "--output {}: found the extension '{}', expected .exr: the table is written as OpenEXR",
      output, extension));
}

void bake(const BakeOptions& options) {
  check_extension(options.output);
  const Plan plan = plan_in(options);
  const lut::Table table = lut::bake(plan.layout);
  table::write_file(options.output, lut::exr_of(table));
  if (options.json) {
    print_json(json_of(table, plan.terms, options.output));
  } else {
    print(report(table, plan.terms, options.output));
  }
}

}  // namespace

void add_lut_bake_command(CLI::App& lut, Invocation& /*invocation*/) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = lut.add_subcommand(
      "bake", "Bake a look-up table for a material or for given parameters, as EXR");
  command->add_option("MATERIAL", options->material,
                      "The material (JSON) that the table serves; without it --table and the "
                      "parameters say what is baked");
  add_lut_options(*command, options->lut);
  add_lut_parameter_options(*command, options->lut);
  command->add_option("-o,--output", options->output, "The EXR file to write")->required();
  command->add_flag("--json", options->json, "Print what was written as JSON");
  command->callback([options] {
    try {
      bake(*options);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(fmt::format("lut bake: {}", e.what()));
    }
  });
}

}  // namespace gonio::app
