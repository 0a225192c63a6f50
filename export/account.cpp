#include "export/account.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

namespace gonio::exports {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The text on one line: control characters become blanks.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

std::string values_text(const std::vector<double>& values) {
  if (values.size() == 1) return fmt::format("{}", values[0]);
  return fmt::format("({})", fmt::join(values, ", "));
}

std::string parameters_text(const material::Material& material) {
  std::vector<std::string> parameters;
  for (const material::ParameterValue& parameter : material.parameters) {
    parameters.push_back(fmt::format("{} = {}", parameter.name, values_text(parameter.value)));
  }
  return fmt::format("{}", fmt::join(parameters, "; "));
}

}  // namespace

std::string number_text(double value) {
  // What a fit leaves of a 0.
  constexpr double nothing = 1e-12;
  return fmt::format("{:.12g}", std::abs(value) < nothing ? 0 : value);
}

double as_written(double value) {
  const std::string text = number_text(value);
  double read = 0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return read;
}

std::string loss_text(const material::Difference& loss) {
  const std::string where =
      loss.peak > 0
          ? fmt::format(" at incidence {:.0f} deg, viewer {:.0f} deg, channel {}",
                        loss.where.theta_i_deg, loss.where.theta_o_deg, loss.where.channel)
          : "";
  return fmt::format("peak {:.3g} %{}; rms {:.3g} %; albedo {:+.2g}", 100 * loss.peak, where,
                     100 * loss.rms, loss.albedo);
}

std::vector<std::string> origin_lines(const material::Material& material) {
  return {
      fmt::format("written by gonio {}", GONIO_VERSION),
      one_line(fmt::format("material: {}", material.name)),
      one_line(fmt::format("model: {}; channels {}; {}", material.model,
                           fmt::join(material.channels, ", "), parameters_text(material))),
  };
}

std::vector<std::string> account(const RgbMaterial& material, const Exported& exported) {
  std::vector<std::string> lines = origin_lines(*material.material);
  const auto add = [&](const std::string& line) { lines.push_back(one_line(line)); };
  add(fmt::format("channels: {}", material.channels.statement));
  add(fmt::format("stand-in: {}", exported.fitted_as));
  add(fmt::format("loss of reflected radiance: {}", loss_text(exported.loss)));
  for (const std::string& warning : exported.warnings) add(fmt::format("warning: {}", warning));
  return lines;
}

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    plain += is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '.' ? c : '_';
  }
  if (plain.empty()) return "material";
  if (!is_letter(plain[0]) && plain[0] != '_') plain.insert(plain.begin(), '_');
  return plain;
}

void add_warnings(const RgbMaterial& material, Exported& exported) {
  constexpr double large_rms = 0.5;
  constexpr double large_albedo = 0.2;
  constexpr double stretched = 8;
  const auto warn = [&](std::string text) { exported.warnings.push_back(std::move(text)); };
  if (exported.loss.rms > large_rms || std::abs(exported.loss.albedo) > large_albedo) {
    warn(fmt::format(
        "the target has nothing like this model: the stand-in is off by {:.0f} % of the "
        "reflected radiance (rms), and by {:+.2f} in albedo",
        100 * exported.loss.rms, exported.loss.albedo));
  }
  const double anisotropy = material::largest_anisotropy(material.model);
  if (anisotropy > stretched) {
    warn(
        fmt::format("the lobe is {:.0f} times as wide one way as the other: the stand-in and its "
                    "loss are known roughly only",
                    anisotropy));
  }
  if (material.tangents.size() > 1 && material.tangents[0] != material.tangents[1]) {
    warn("the material has two tangents and the stand-in has one of them");
  }
  if (material.channels.is_invisible) {
    warn("not all wavelengths are visible: red, green and blue stand for others");
  }
}

bool is_exact(const material::Difference& loss) {
  return loss.peak < exact_difference && loss.rms < exact_difference;
}

}  // namespace gonio::exports
