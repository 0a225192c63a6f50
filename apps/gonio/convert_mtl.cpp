// gonio convert FILE.mtl: the Phong materials of a Wavefront material library as material JSONs.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "apps/gonio/convert.h"
#include "brdf/albedo.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "material/wavefront_mtl.h"
#include "table/file_error.h"

namespace gonio::app {
namespace {

namespace fs = std::filesystem;
using material::Conversion;
using material::MtlMaterial;

std::string lobe_in(const ConvertArguments& arguments) {
  if (arguments.lobe.empty()) return "blinn-phong";
  if (arguments.lobe == "phong" || arguments.lobe == "blinn-phong") return arguments.lobe;
  throw std::invalid_argument(
      fmt::format("--lobe {}: expected blinn-phong or phong", arguments.lobe));
}

std::optional<double> default_exponent_in(const ConvertArguments& arguments) {
  if (arguments.default_exponent.empty()) return std::nullopt;
  return number_of("--default-exponent", arguments.default_exponent);
}

bool has_highlight(const MtlMaterial& mtl) {
  return std::any_of(mtl.specular.begin(), mtl.specular.end(), [](double k) { return k > 0; });
}

/// Without a highlight: Lambert's reflector, exactly.
Conversion matt(const MtlMaterial& mtl) {
  material::Material material;
  material.model = "lambert";
  material.channels = {"R", "G", "B"};
  material.parameters = {{"rho_d", {mtl.diffuse.begin(), mtl.diffuse.end()}, {}, {}}};
  material.conversion = material::ConversionRecord{.from = "lambert",
                                                   .method = "closed-form",
                                                   .metric = "cosine-l2",
                                                   .peak = 0,
                                                   .rms = 0,
                                                   .albedo = 0};
  return {std::move(material), 0, {}};
}

Conversion convert_one(const MtlMaterial& mtl, const std::string& lobe, const std::string& to,
                       const material::ConversionOptions& options) {
  Conversion conversion = [&] {
    if (!has_highlight(mtl)) return matt(mtl);
    material::LobeMaterial from{.name = mtl.name,
                                .channels = {"R", "G", "B"},
                                .rho_d = {mtl.diffuse.begin(), mtl.diffuse.end()},
                                .lobe = {lobe, mtl.exponent, {}},
                                .is_classic = true};
    for (const double k : mtl.specular) {
      from.lobe.amplitudes.push_back(
          material::raw_amplitude(material::Amplitude::classic, k, mtl.exponent));
    }
    return convert(from, to, options);
  }();
  conversion.material.name = mtl.name;
  return conversion;
}

/// A file name for the material: letters, digits, `-`, `_` and `.` stay; unlike any in `taken`,
/// whatever the case.
std::string file_name(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : name) {
    const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || (c == '.' && !stem.empty());
    stem += stays ? c : '_';
  }
  if (stem.size() > 100) stem.resize(100);
  if (stem.empty()) stem = "material";
  const auto key = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
  };
  std::string candidate = stem;
  for (int k = 2; !taken.insert(key(candidate)).second; ++k) {
    candidate = fmt::format("{}_{}", stem, k);
  }
  return candidate + ".json";
}

void create_folder(const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return;
  throw table::FileError(
      fmt::format("{}: the folder for the materials cannot be made ({}): name a folder with -o",
                  folder, error ? error.message() : "it is a file"));
}

/// Says where more light leaves than arrives.
void note_gain(const std::string& source, const material::Material& material) {
  const auto albedo = brdf::albedo(bind(material), 0, 0, 1e-3);
  const double largest = *std::max_element(albedo.values.begin(), albedo.values.end());
  if (largest <= 1) return;
  print_note(
      fmt::format("{}: {}: reflects {:.3g} times the light that arrives at normal incidence, as "
                  "its Kd and Ks do",
                  source, material.name, largest));
}

std::string numbers(const material::ParameterValue& parameter) {
  std::string text;
  for (const double value : parameter.value) {
    text += fmt::format("{}{:.4g}", text.empty() ? "" : " ", value);
  }
  return text;
}

struct Converted {
  const MtlMaterial* mtl;
  Conversion conversion;
  std::string file;  // empty without -o
};

std::string line_of(const Converted& entry, std::size_t name_width) {
  const auto& material = entry.conversion.material;
  const auto& remaining = entry.conversion.remaining;
  if (material.parameters.size() == 1) {
    return fmt::format("  {:<{}}  {:>8}  {:>9}  {:<24}  {:>8} {:>8} {:>9}\n", material.name,
                       name_width, "-", "-", "none", "exact", "exact", "exact");
  }
  return fmt::format("  {:<{}}  {:>8.5g}  {:>9.5g}  {:<24}  {:>8} {:>8} {:>9.3g}\n", material.name,
                     name_width, entry.mtl->exponent, material.parameters[2].value.front(),
                     numbers(material.parameters[1]), percent(remaining.peak),
                     percent(remaining.rms), remaining.albedo);
}

void print_list(const ConvertArguments& arguments, const std::string& lobe, const std::string& to,
                const std::vector<Converted>& converted,
                const material::ConversionOptions& options) {
  const brdf::Model model("lambert+" + to);
  std::size_t width = 4;
  for (const Converted& entry : converted) {
    width = std::max(width, entry.conversion.material.name.size());
  }
  std::string text = fmt::format("{}: {} highlights (classic) as {}, {}{}\n\n", arguments.source,
                                 lobe, model.name(), name(options.method),
                                 arguments.output.empty() ? "" : ", in " + arguments.output);
  text += fmt::format("  {:<{}}  {:>8}  {:>9}  {:<24}  {:>8} {:>8} {:>9}\n", "name", width, "Ns",
                      model.shape()[0].name, model.amplitudes()[1].name + " (R G B)", "peak", "rms",
                      "albedo");
  for (const Converted& entry : converted) text += line_of(entry, width);
  print(text + "\n" + error_legend(options));
}

void print_json_of(const std::vector<Converted>& converted,
                   const std::vector<MtlMaterial>& library) {
  nlohmann::ordered_json json;
  json["materials"] = nlohmann::ordered_json::array();
  for (const Converted& entry : converted) {
    json["materials"].push_back(to_json(entry.conversion.material));
  }
  json["problems"] = nlohmann::ordered_json::array();
  for (const MtlMaterial& mtl : library) {
    if (!mtl.problem.empty()) {
      json["problems"].push_back({{"name", mtl.name}, {"problem", mtl.problem}});
    }
  }
  print_json(json);
}

}  // namespace

void convert_mtl(const ConvertArguments& arguments, Invocation& invocation) {
  const std::string lobe = lobe_in(arguments);
  const std::string to = target_term_in(arguments);
  const material::ConversionOptions options = conversion_options_in(arguments);
  std::vector<MtlMaterial> library =
      material::read_wavefront_mtl(arguments.source, default_exponent_in(arguments));
  create_folder(arguments.output);

  std::vector<Converted> converted;
  std::set<std::string> taken;
  for (MtlMaterial& mtl : library) {
    for (const std::string& note : mtl.notes) {
      print_note(fmt::format("{}: {}: {}", arguments.source, mtl.name, note));
    }
    if (mtl.problem.empty()) {
      try {
        converted.push_back({&mtl, convert_one(mtl, lobe, to, options), {}});
      } catch (const std::invalid_argument& error) {
        mtl.problem =
            fmt::format("{}:{}: {}: {}", arguments.source, mtl.line, mtl.name, error.what());
      }
    }
    if (!mtl.problem.empty()) {
      print_note(mtl.problem);
      invocation.exit_status = 1;
      continue;
    }
    Converted& entry = converted.back();
    set_provenance(entry.conversion.material, arguments.source, invocation);
    note_gain(arguments.source, entry.conversion.material);
    if (arguments.output.empty()) continue;
    entry.file = (fs::path(arguments.output) / file_name(mtl.name, taken)).string();
    write_material(entry.conversion.material, entry.file);
  }
  if (arguments.json) {
    print_json_of(converted, library);
  } else {
    print_list(arguments, lobe, to, converted, options);
  }
  const std::size_t bad = library.size() - converted.size();
  print_note(fmt::format("{}: {} of {} materials converted{}", arguments.source, converted.size(),
                         library.size(), bad == 0 ? "" : "; the others are listed above"));
}

}  // namespace gonio::app
