// gonio convert: Phong to Ward, Ward to Blinn-Phong, with the error that remains.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "apps/gonio/convert.h"
#include "apps/gonio/polar_angles.h"
#include "brdf/nearest_name.h"
#include "table/input_file.h"
#include "table/read.h"

namespace gonio::app {
namespace {

bool is_convertible(std::string_view term) {
  const auto terms = material::convertible_terms();
  return std::find(terms.begin(), terms.end(), term) != terms.end();
}

[[noreturn]] void refuse_source(const std::string& source) {
  const auto terms = material::convertible_terms();
  const std::vector<std::string> known(terms.begin(), terms.end());
  const auto meant = brdf::nearest_name(source, known);
  throw std::invalid_argument(fmt::format(
      "convert {}: there is no such file, and no such lobe{}; lobes are {}; files are material "
      "JSON, "
      "CSV and Wavefront .mtl",
      source, meant ? fmt::format(" (did you mean '{}'?)", *meant) : "", fmt::join(terms, ", ")));
}

/// True if one of the first statements is one that only a .mtl file has.
bool looks_like_mtl(std::string_view text) {
  for (std::string_view rest = text.substr(0, 1 << 16); !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\xEF\xBB\xBF"), line.size()));
    constexpr std::string_view keyword = "newmtl";
    if (line.size() >= keyword.size() &&
        std::equal(keyword.begin(), keyword.end(), line.begin(), [](char k, char c) {
          return k == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
        })) {
      return true;
    }
  }
  return false;
}

enum class SourceKind { lobe, material, csv, mtl };

SourceKind kind_of(const std::string& source) {
  if (is_convertible(source)) return SourceKind::lobe;
  std::error_code error;
  if (!std::filesystem::exists(source, error)) refuse_source(source);
  if (source.ends_with(".mtl") || source.ends_with(".MTL")) return SourceKind::mtl;
  const table::InputFile file(source);
  const std::string_view text = file.bytes();
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && text[first] == '{') return SourceKind::material;
  return looks_like_mtl(text) ? SourceKind::mtl : SourceKind::csv;
}

/// Throws for an option that this kind of source has no use for.
void refuse_unused(const ConvertArguments& arguments, SourceKind kind) {
  struct Option {
    std::string_view name;
    const std::string& text;
    bool is_used;
  };
  const bool is_lobe = kind == SourceKind::lobe;
  const bool is_list = kind == SourceKind::csv || kind == SourceKind::mtl;
  const std::array<Option, 8> options{
      {{"--exponent", arguments.exponent, is_lobe},
       {"--alpha", arguments.alpha, is_lobe},
       {"--ks", arguments.ks, is_lobe},
       {"--rho-s", arguments.rho_s, is_lobe},
       {"--Rs", arguments.specular_share, is_lobe},
       {"--amplitude", arguments.amplitude, kind != SourceKind::mtl},
       {"--lobe", arguments.lobe, is_list},
       {"--default-exponent", arguments.default_exponent, kind == SourceKind::mtl}}};
  for (const Option& option : options) {
    if (option.text.empty() || option.is_used) continue;
    throw std::invalid_argument(
        fmt::format("convert {}: {} says nothing here: {}", arguments.source, option.name,
                    is_lobe ? "one lobe is given by its own name" : "the file says it"));
  }
}

void convert(const ConvertArguments& arguments, Invocation& invocation) {
  const SourceKind kind = kind_of(arguments.source);
  refuse_unused(arguments, kind);
  switch (kind) {
    case SourceKind::lobe:
      return convert_lobe(arguments, invocation);
    case SourceKind::material:
      return convert_material(arguments, invocation);
    case SourceKind::csv:
      return convert_csv(arguments, invocation);
    case SourceKind::mtl:
      return convert_mtl(arguments, invocation);
  }
}

}  // namespace

double number_of(std::string_view option, std::string_view text) {
  const auto value = parse_number(text);
  if (!value || !std::isfinite(*value)) {
    throw std::invalid_argument(fmt::format("{} {}: expected a number", option, text));
  }
  return *value;
}

material::ConversionOptions conversion_options_in(const ConvertArguments& arguments) {
  material::ConversionOptions options{.metric = fit::metric_from_name(arguments.metric)};
  if (!arguments.method.empty()) {
    options.method = material::conversion_method_from_name(arguments.method);
  }
  if (!arguments.theta.empty()) {
    options.theta_deg = parse_polar_angles("--theta", arguments.theta);
    for (const double theta : options.theta_deg) {
      if (theta <= material::largest_compared_theta_deg) continue;
      throw std::invalid_argument(
          fmt::format("--theta {}: {:g} degrees: lights are compared up to {:g}", arguments.theta,
                      theta, material::largest_compared_theta_deg));
    }
  }
  return options;
}

bool wants_classic(const ConvertArguments& arguments) {
  if (arguments.amplitude.empty()) return false;
  const auto convention = material::amplitude_from_name(arguments.amplitude);
  if (convention == material::Amplitude::normalised) {
    throw std::invalid_argument(
        "--amplitude normalised: says how a given ks is meant; of a result all three are printed");
  }
  return convention == material::Amplitude::classic;
}

std::vector<material::ConversionMethod> methods_in(const ConvertArguments& arguments) {
  if (!arguments.method.empty()) {
    return {material::conversion_method_from_name(arguments.method)};
  }
  return {material::ConversionMethod::closed_form, material::ConversionMethod::best_fit};
}

std::string target_term_in(const ConvertArguments& arguments, const std::string& otherwise) {
  std::string term = arguments.to.empty() ? otherwise : arguments.to;
  if (is_convertible(term)) return term;
  const auto terms = material::convertible_terms();
  const std::vector<std::string> known(terms.begin(), terms.end());
  const auto meant = brdf::nearest_name(term, known);
  throw std::invalid_argument(fmt::format(
      "--to {}: there is no such isotropic lobe{}; there are {}", term,
      meant ? fmt::format(" (did you mean '{}'?)", *meant) : "", fmt::join(terms, ", ")));
}

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

std::string error_legend(const material::ConversionOptions& options) {
  return fmt::format(
      "peak: largest difference of reflected radiance (f_r cos_i) per largest radiance; rms: the\n"
      "same in the mean, weighted by solid angle; albedo: largest difference of directional "
      "albedo.\n"
      "Light from {} deg, viewers up to {:g} deg. The best fit minimises {}.\n",
      fmt::join(options.theta_deg, ", "), material::largest_compared_theta_deg,
      name(options.metric));
}

SourceFile source_file(const std::string& path) { return {path, table::sha256_of_file(path)}; }

void set_provenance(material::Material& material, const SourceFile& source,
                    const Invocation& invocation) {
  material.provenance = material::MaterialProvenance{.table = source.path,
                                                     .sha256 = source.sha256,
                                                     .gonio = GONIO_VERSION,
                                                     .command = invocation.command_line};
}

void add_convert_command(CLI::App& app, Invocation& invocation) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Turn Phong materials into Ward's and back, with the error that remains");
  command
      ->add_option("SOURCE", arguments->source,
                   "a lobe (phong, blinn-phong, ward, ward-gmd, ashikhmin-shirley, ..), a material "
                   "(JSON), a CSV of lobes, or a Wavefront .mtl file")
      ->required();
  command->add_option("--to", arguments->to,
                      "the lobe to convert to (default ward, from a Ward lobe blinn-phong); for a "
                      "material any model");
  command
      ->add_option("--exponent", arguments->exponent, "of phong, blinn-phong or ashikhmin-shirley")
      ->type_name("N");
  command->add_option("--alpha", arguments->alpha, "roughness of a Ward lobe")->type_name("A");
  command->add_option("--ks", arguments->ks, "amplitude of phong or blinn-phong (default 1)")
      ->type_name("K");
  command
      ->add_option("--amplitude", arguments->amplitude,
                   "what ks is: raw (f_r in 1/sr, the default), normalised (times (n+2)/(2 pi)) or "
                   "classic (a shader's, with no cosine); from other lobes: classic for such a "
                   "result")
      ->type_name("WHAT");
  command->add_option("--rho-s", arguments->rho_s, "amplitude of a Ward lobe (default 1)")
      ->type_name("R");
  command
      ->add_option("--Rs", arguments->specular_share,
                   "amplitude of ashikhmin-shirley (default 0.05)")
      ->type_name("R");
  command
      ->add_option("--lobe", arguments->lobe,
                   "which lobe a file's exponents are of: blinn-phong (default) or phong")
      ->type_name("LOBE");
  command
      ->add_option("--default-exponent", arguments->default_exponent,
                   "of materials of a .mtl file that have a Ks and no Ns")
      ->type_name("N");
  command
      ->add_option("--method", arguments->method,
                   "closed-form or best-fit; without it a lobe shows both, and best-fit is written")
      ->type_name("METHOD");
  command
      ->add_option("--metric", arguments->metric,
                   "what the best fit minimises: cosine-l2, l2, log, cube-root or relative")
      ->capture_default_str()
      ->type_name("METRIC");
  command
      ->add_option("--theta", arguments->theta,
                   "polar angles of the light at which the two are compared (default "
                   "0,15,30,45,60,75)")
      ->type_name("T,T,..");
  command->add_option("-o,--output", arguments->output,
                      "write the material (JSON); from a .mtl file a folder, from a CSV a CSV");
  command->add_flag("--json", arguments->json, "print the result as JSON");
  command->callback([arguments, &invocation] { convert(*arguments, invocation); });
}

}  // namespace gonio::app
