#include "bench/shader_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace gonio::bench {
namespace {

/// The shapes of one term, each in the order of its parameters without the tangent angle.
using Shapes = std::vector<std::vector<double>>;

/// A term's own parameters, by which its shapes are chosen.
std::vector<std::string_view> own_parameters(const brdf::TermEntry& term) {
  std::vector<std::string_view> names;
  for (const brdf::Parameter& p : term.shape) {
    if (p.name != "psi") names.push_back(p.name);
  }
  return names;
}

Shapes ordinary_shapes(const brdf::TermEntry& term) {
  static const std::map<std::vector<std::string_view>, Shapes> table{
      {{}, {{}}},
      {{"alpha"}, {{1e-2}, {0.05}, {0.3}, {1}}},
      {{"alpha_x", "alpha_y"}, {{1e-2, 0.05}, {0.3, 1e-2}, {0.05, 0.3}, {1, 0.3}, {1e-2, 1}}},
      {{"exponent"}, {{0}, {1}, {50}, {1e4}}},
      {{"n"}, {{0}, {1}, {50}, {1e4}}},
      {{"nu", "nv"}, {{0, 1e4}, {1e4, 50}, {1, 50}, {1e4, 1e4}, {0, 1}}},
      {{"sigma"}, {{0}, {0.5}, {1.5}}},
      // s = 0.9997: the exponent 1e4. All corners of m and t at the mirror and next to it.
      {{"s", "m", "t"},
       {{0, 0, 0},
        {0, 1, 0.5},
        {0, 1, 1},
        {0.5, 0.5, 0.5},
        {0.5, 1, 0},
        {0.97, 0, 0.5},
        {0.97, 1, 0},
        {0.97, 0.5, 1},
        {0.9997, 0, 0},
        {0.9997, 1, 0},
        {0.9997, 0, 1},
        {0.9997, 1, 1},
        {1, 0, 0},
        {1, 1, 0},
        {1, 0, 1},
        {1, 1, 1},
        {1, 0.5, 0.5}}}};
  const auto shapes = table.find(own_parameters(term));
  if (shapes == table.end()) {
    throw std::logic_error(fmt::format("shader_materials has no shapes for the parameters of '{}'",
                                       term.description.name));
  }
  return shapes->second;
}

/// Empty for a term that cannot be narrower.
Shapes narrow_shapes(const brdf::TermEntry& term) {
  static const std::map<std::vector<std::string_view>, Shapes> table{
      {{"alpha"}, {{1e-3}, {1e-4}}},
      {{"alpha_x", "alpha_y"}, {{1e-3, 3e-3}, {1e-3, 1e-4}}},
      {{"exponent"}, {{1e5}, {1e6}}},
      {{"n"}, {{1e5}, {1e6}}},
      {{"nu", "nv"}, {{1e5, 2e4}, {1e5, 1e6}}},
      // The exponents 3/(1 - s) = 1e5 and 1e6.
      {{"s", "m", "t"}, {{0.99997, 0.5, 0}, {0.999997, 0.5, 0}}}};
  const auto shapes = table.find(own_parameters(term));
  return shapes == table.end() ? Shapes{} : shapes->second;
}

/// The values of an amplitude in the channels: no channel is black, one has no diffuse light.
std::vector<double> amplitude_values(std::string_view name) {
  static const std::map<std::string_view, std::vector<double>> table{
      {"rho_d", {0.2, 0, 0.6}}, {"rho_s", {0.3, 0.1, 0.8}}, {"ks", {1, 0.2, 30}},
      {"Rd", {0.5, 0, 0.3}},    {"Rs", {0.05, 0.9, 0.5}},   {"c", {0.4, 1, 0}}};
  return table.at(name);
}

/// How narrow the cosine lobe of an exponent is: as Ward's of this alpha (Walter et al. 2007).
double scale_of_exponent(double exponent) { return std::sqrt(2 / (exponent + 2)); }

/// A mirror lobe narrows its half vector's by four.
double scale_of_mirror_exponent(double exponent) { return scale_of_exponent(4 * exponent); }

/// The lobe of a term, if it has one, for its own shape.
std::vector<LobeScale> lobe_of(const brdf::TermEntry& term, const std::vector<double>& shape) {
  const auto names = own_parameters(term);
  const auto is = [&](std::string_view first) { return !names.empty() && names.front() == first; };
  const auto same = [](double scale) { return std::vector{LobeScale{scale, scale}}; };
  if (is("alpha")) return same(shape[0]);
  if (is("alpha_x")) return {{shape[0], shape[1]}};
  if (is("n")) return same(scale_of_exponent(shape[0]));
  if (is("nu")) return {{scale_of_exponent(shape[0]), scale_of_exponent(shape[1])}};
  if (is("exponent")) {
    return same(term.description.name == "phong" ? scale_of_mirror_exponent(shape[0])
                                                 : scale_of_exponent(shape[0]));
  }
  // The mirror of s = 1 has no width; pairs about it are drawn at that of a narrow lobe.
  if (is("s")) return same(scale_of_mirror_exponent(3 / (shape[0] < 1 ? 1 - shape[0] : 3e-4)));
  return {};
}

/// The shape of a whole model: one of each term's shapes, and angles for free tangents.
struct ModelShape {
  std::vector<double> values;  // as in model.shape()
  std::vector<LobeScale> lobes;
};

ModelShape nth_shape(const brdf::Model& model, const std::vector<Shapes>& shapes, std::size_t n) {
  constexpr double angles[] = {0.4, -1.2, 1.5707963267948966, -0.7};
  ModelShape shape;
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    // Terms go through their shapes out of step, so that unlike lobes meet.
    const std::vector<double>& own = shapes[t][(n + t) % shapes[t].size()];
    const brdf::TermEntry& term = *model.terms()[t];
    std::vector<LobeScale> lobe = lobe_of(term, own);
    shape.values.insert(shape.values.end(), own.begin(), own.end());
    if (term.shape.size() > own.size()) {
      const double psi = angles[n % std::size(angles)];
      shape.values.push_back(psi);
      for (LobeScale& l : lobe) l.psi = psi;
    }
    shape.lobes.insert(shape.lobes.end(), lobe.begin(), lobe.end());
  }
  return shape;
}

brdf::BoundModel bind(const brdf::Model& model, const std::vector<double>& shape) {
  std::vector<std::vector<double>> amplitudes;
  for (const brdf::ModelParameter& p : model.amplitudes()) {
    amplitudes.push_back(amplitude_values(p.descriptor.name));
  }
  std::vector<brdf::NamedValues> values;
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    values.push_back({model.amplitudes()[a].name, amplitudes[a]});
  }
  for (std::size_t s = 0; s < shape.size(); ++s) {
    values.push_back({model.shape()[s].name, std::span(&shape[s], 1)});
  }
  return {model, amplitudes.front().size(), values};
}

std::string text_of(const brdf::Model& model, const std::vector<double>& shape) {
  std::string text;
  for (std::size_t s = 0; s < shape.size(); ++s) {
    text += fmt::format("{}{} {:.6g}", s > 0 ? ", " : "", model.shape()[s].name, shape[s]);
  }
  return text;
}

}  // namespace

std::vector<ShaderMaterial> shader_materials(const brdf::Model& model, LobeWidths widths) {
  std::vector<Shapes> shapes;
  std::size_t count = widths == LobeWidths::ordinary ? 1 : 0;
  for (const brdf::TermEntry* term : model.terms()) {
    Shapes narrow = narrow_shapes(*term);
    const bool is_narrow = widths == LobeWidths::narrow && !narrow.empty();
    shapes.push_back(is_narrow ? std::move(narrow) : ordinary_shapes(*term));
    if (is_narrow || widths == LobeWidths::ordinary) count = std::max(count, shapes.back().size());
  }
  std::vector<ShaderMaterial> materials;
  for (std::size_t n = 0; n < count; ++n) {
    ModelShape shape = nth_shape(model, shapes, n);
    const bool is_mirror =
        model.shape().size() == 3 && model.shape()[0].name == "s" && shape.values[0] == 1;
    materials.push_back({model.name() + (model.has_free_frame() ? ", free frame" : ""),
                         text_of(model, shape.values), bind(model, shape.values),
                         std::move(shape.lobes), is_mirror});
  }
  return materials;
}

std::vector<brdf::Model> shader_models() {
  std::vector<brdf::Model> models;
  for (const std::string& name : brdf::model_names()) models.emplace_back(name);
  models.emplace_back("lambert+ward-gmd-aniso", brdf::Frame::free);
  models.emplace_back("oren-nayar+ward-gmd");
  models.emplace_back("lambert+ward+ward-aniso");
  models.emplace_back("lambert+ashikhmin-shirley");
  models.emplace_back("lambert+ashikhmin-shirley-aniso", brdf::Frame::free);
  models.emplace_back("ashikhmin-shirley-aniso", brdf::Frame::free);
  return models;
}

}  // namespace gonio::bench
