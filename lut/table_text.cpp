#include "lut/table_text.h"

#include <fmt/format.h>

#include "brdf/ward.h"
#include "lut/table.h"

namespace gonio::lut {
namespace {

constexpr std::string_view half_vector_text =
    "h = wi + wo; w = 1 - n.h = (h.x^2 + h.y^2) / (|h| (|h| + h.z))";

/// How the alpha of an anisotropic lobe follows, also where h is the normal, and what E goes into.
std::string ward_text() {
  return fmt::format(
      "if anisotropic: q = h.x^2 + h.y^2; "
      "1 / alpha^2 = q > 1e-30 ? ((h.x / ax)^2 + (h.y / ay)^2) / q : 1 / ax^2\n"
      "f_r / rho_s: {} {}; {} {}; {} {}",
      brdf::WardLobe::name, brdf::WardLobe::summary, brdf::WardDuerLobe::name,
      brdf::WardDuerLobe::summary, brdf::WardGmdLobe::name, brdf::WardGmdLobe::summary);
}

/// c(w) and the coordinate of an axis.
std::string coordinate_text(const Layout& layout, char axis, std::string_view w, int size) {
  if (layout.coordinate == Coordinate::listing) return fmt::format("{} = 1 - {} / 2", axis, w);
  const std::string share =
      layout.reach == 1 ? std::string(w) : fmt::format("{} / {:.9g}", w, layout.reach);
  const std::string c = layout.coordinate == Coordinate::sqrt ? fmt::format("sqrt({})", share)
                        : layout.coordinate == Coordinate::fourth_root
                            ? fmt::format("sqrt(sqrt({}))", share)
                            : share;
  return fmt::format("{} = ({} * {} + 0.5) / {}", axis, c, size - 1, size);
}

std::string row_text(const Layout& layout, std::string_view parameter) {
  if (layout.height == 1) return "v = 0.5";
  return fmt::format("v = (clamp(log({} / {:.9g}) / log({:.9g} / {:.9g}), 0, 1) * {} + 0.5) / {}",
                     parameter, layout.lowest, layout.highest, layout.lowest, layout.height - 1,
                     layout.height);
}

std::string exponent_text(const Layout& layout) {
  const float scale = decoding_of(layout)[0].scale;
  if (layout.storage == Storage::r32f) {
    return fmt::format("E = exp(texel / alpha^2)\n{}", ward_text());
  }
  return fmt::format("E = {} ? exp({:.9g} * texel / alpha^2) : 0\n{}",
                     layout.storage == Storage::r16f ? "texel > -65504" : "texel < 1", scale,
                     ward_text());
}

std::string strauss_j_text(const Layout& layout) {
  const std::string_view w_in = layout.of_cosine ? "w_i" : "wi.z";
  const std::string_view w_out = layout.of_cosine ? "w_o" : "wo.z";
  return fmt::format("{}{}\n{}\nj = texel.r; F = 1 - texel.g",
                     layout.of_cosine ? "w_i = 1 - wi.z; w_o = 1 - wo.z\n" : "",
                     coordinate_text(layout, 'u', w_in, layout.width),
                     coordinate_text(layout, 'v', w_out, layout.height));
}

}  // namespace

std::string served_text(const Layout& layout) {
  const auto range = [&](std::string_view name) {
    if (layout.lowest == layout.highest) return fmt::format("{} {:.6g}", name, layout.lowest);
    return fmt::format("{} {:.6g} to {:.6g}", name, layout.lowest, layout.highest);
  };
  switch (layout.kind) {
    case TableKind::ward_exponent:
      return serves_any_alpha(layout) ? "any alpha" : range("alpha");
    case TableKind::ward_lobe:
      return range("alpha");
    case TableKind::blinn_phong_power:
      return range("exponent");
    case TableKind::strauss_j:
      return layout.of_cosine ? "strauss-listing" : "strauss";
    case TableKind::strauss_terms:
      return fmt::format("t = {}", layout.transparency);
  }
  return {};
}

std::string sampling_text(const Layout& layout) {
  const auto lobe = [&](std::string_view parameter, std::string_view value) {
    return fmt::format("{}\n{}\n{}\n{}", half_vector_text,
                       coordinate_text(layout, 'u', "w", layout.width), row_text(layout, parameter),
                       value);
  };
  switch (layout.kind) {
    case TableKind::ward_exponent:
      return lobe("", exponent_text(layout));
    case TableKind::ward_lobe:
      return lobe("alpha", fmt::format("E = texel\n{}", ward_text()));
    case TableKind::blinn_phong_power:
      return lobe("exponent", "(n.h)^exponent = texel");
    case TableKind::strauss_j:
      return strauss_j_text(layout);
    case TableKind::strauss_terms:
      return fmt::format("{}\n{}\nd Rd = texel.r; r = texel.g",
                         coordinate_text(layout, 'u', "s", layout.width),
                         coordinate_text(layout, 'v', "m", layout.height));
  }
  return {};
}

}  // namespace gonio::lut
