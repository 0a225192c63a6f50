// gonio convert FILE.mtl: the Phong materials of a Wavefront material library as material JSONs.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "apps/gonio/convert.h"
#include "apps/gonio/progress.h"
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
                                                   .metric_error = 0,
                                                   .theta_i_deg = {},
                                                   .peak = 0,
                                                   .rms = 0,
                                                   .albedo = 0};
  return {std::move(material), {}};
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

/// A file name for the material: letters of any script, digits, `-`, `_` and `.` stay; unlike any
/// in `taken`, whatever the case.
std::string file_name(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : name) {
    const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       static_cast<unsigned char>(c) >= 0x80 || c == '-' || c == '_' ||
                       (c == '.' && !stem.empty());
    stem += stays ? c : '_';
  }
  std::size_t length = std::min<std::size_t>(stem.size(), 100);
  // Not within a letter of several bytes.
  while (length < stem.size() && (static_cast<unsigned char>(stem[length]) & 0xC0) == 0x80)
    --length;
  stem.resize(length);
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
  constexpr double tolerance = 1e-3;
  const auto albedo = brdf::albedo(bind(material), 0, 0, tolerance);
  const double largest = *std::max_element(albedo.values.begin(), albedo.values.end());
  if (largest <= 1 + 2 * tolerance) return;
  print_note(
      fmt::format("{}: {}: reflects {:.3g} times the light that arrives at normal incidence, as "
                  "its Kd and Ks do",
                  source, material.name, largest));
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.4g}", text.empty() ? "" : " ", value);
  return text;
}

/// A name of at most 32 bytes that a terminal takes as text.
std::string shown(const std::string& name) {
  std::string text;
  for (const char c : name) text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  constexpr std::size_t most = 32;
  return text.size() <= most ? text : text.substr(0, most - 3) + "...";
}

struct Converted {
  const MtlMaterial* mtl;
  Conversion conversion;
  std::string file;  // its name in the folder; empty without -o
};

std::string line_of(const Converted& entry, std::size_t name_width) {
  const auto& remaining = entry.conversion.remaining;
  const auto lobe = material::lobe_material_of(entry.conversion.material);
  const std::string errors = lobe ? fmt::format("{:>8} {:>8} {:>9.3g}", percent(remaining.peak),
                                                percent(remaining.rms), remaining.albedo)
                                  : fmt::format("{:>8} {:>8} {:>9}", "exact", "exact", "exact");
  return fmt::format("  {:<{}}  {:>8}  {:>9}  {:<24}  {}  {}\n", shown(entry.mtl->name), name_width,
                     lobe ? fmt::format("{:.5g}", entry.mtl->exponent) : "-",
                     lobe ? fmt::format("{:.5g}", lobe->lobe.shape) : "-",
                     lobe ? numbers(lobe->lobe.amplitudes) : "none", errors, entry.file);
}

void print_list(const ConvertArguments& arguments, const std::string& lobe, const std::string& to,
                const std::vector<Converted>& converted,
                const material::ConversionOptions& options) {
  std::size_t width = 4;
  for (const Converted& entry : converted) width = std::max(width, shown(entry.mtl->name).size());
  std::string text =
      fmt::format("{}: {} highlights (classic) as lambert+{}, {}{}\n\n", arguments.source, lobe, to,
                  name(options.method), arguments.output.empty() ? "" : ", in " + arguments.output);
  text +=
      fmt::format("  {:<{}}  {:>8}  {:>9}  {:<24}  {:>8} {:>8} {:>9}  {}\n", "name", width, "Ns",
                  material::shape_parameter(to).name, fmt::format("{} (R G B)", amplitude_name(to)),
                  "peak", "rms", "albedo", arguments.output.empty() ? "" : "file");
  for (const Converted& entry : converted) text += line_of(entry, width);
  print(text + "\nOf the whole materials, diffuse part included.\n" + error_legend(options));
}

void print_json_of(const std::vector<Converted>& converted,
                   const std::vector<MtlMaterial>& library) {
  nlohmann::ordered_json json;
  json["materials"] = nlohmann::ordered_json::array();
  for (const Converted& entry : converted) {
    nlohmann::ordered_json material = to_json(entry.conversion.material);
    if (!entry.file.empty()) material["file"] = entry.file;
    material["notes"] = entry.mtl->notes;
    json["materials"].push_back(material);
  }
  json["problems"] = nlohmann::ordered_json::array();
  for (const MtlMaterial& mtl : library) {
    if (!mtl.problem.empty()) {
      json["problems"].push_back({{"name", mtl.name}, {"problem", mtl.problem}});
    }
  }
  print_json(json);
}

/// Converts what is usable; what turns out not to be gets its problem.
std::vector<Converted> convert_all(std::vector<MtlMaterial>& library, const std::string& source,
                                   const std::string& lobe, const std::string& to,
                                   const material::ConversionOptions& options) {
  std::vector<Converted> converted;
  ProgressLine progress("converting " + source);
  for (MtlMaterial& mtl : library) {
    progress.set("converting " + source, double(&mtl - library.data()) / double(library.size()));
    if (!mtl.problem.empty()) continue;
    try {
      converted.push_back({&mtl, convert_one(mtl, lobe, to, options), {}});
    } catch (const std::invalid_argument& error) {
      mtl.problem = fmt::format("{}: line {}: material '{}': {}", source, mtl.line, shown(mtl.name),
                                error.what());
    }
  }
  return converted;
}

void print_notes(const std::vector<MtlMaterial>& library, const std::string& source) {
  for (const MtlMaterial& mtl : library) {
    for (const std::string& note : mtl.notes) {
      print_note(fmt::format("{}: {}: {}", source, shown(mtl.name), note));
    }
    if (!mtl.problem.empty()) print_note(mtl.problem);
  }
}

}  // namespace

void convert_mtl(const ConvertArguments& arguments, Invocation& invocation) {
  const std::string& source = arguments.source;
  const std::string lobe = lobe_in(arguments);
  const std::string to = target_term_in(arguments, "ward");
  const material::ConversionOptions options = conversion_options_in(arguments);
  std::vector<MtlMaterial> library =
      material::read_wavefront_mtl(source, default_exponent_in(arguments));
  create_folder(arguments.output);
  std::vector<Converted> converted = convert_all(library, source, lobe, to, options);
  print_notes(library, source);

  const SourceFile file = source_file(source);
  std::set<std::string> taken;
  for (Converted& entry : converted) {
    material::Material& material = entry.conversion.material;
    set_provenance(material, file, invocation);
    note_gain(source, material);
    if (arguments.output.empty()) continue;
    entry.file = file_name(entry.mtl->name, taken);
    write_material(material, (fs::path(arguments.output) / entry.file).string());
  }
  if (arguments.json) {
    print_json_of(converted, library);
  } else {
    print_list(arguments, lobe, to, converted, options);
  }
  const bool is_complete = converted.size() == library.size();
  if (!is_complete) invocation.exit_status = 1;
  print_note(fmt::format("{}: {} of {} materials converted{}", source, converted.size(),
                         library.size(), is_complete ? "" : "; the others are listed above"));
}

}  // namespace gonio::app
