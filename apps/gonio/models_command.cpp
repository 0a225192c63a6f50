// gonio models: the terms, the models composed of them, and what each parameter means.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "apps/gonio/command.h"
#include "brdf/bound_model.h"
#include "brdf/free_frame.h"

namespace gonio::app {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t text_width = 100;

struct ModelsOptions {
  std::string model;
  bool json = false;
};

std::string_view kind_of(const brdf::TermDescription& term) {
  switch (term.kind) {
    case brdf::TermKind::diffuse:
      return "diffuse";
    case brdf::TermKind::specular:
      return "specular";
    case brdf::TermKind::whole:
      break;
  }
  return "whole";
}

// Readable -----------------------------------------------------------------------------------

/// The words of `text` from column `indent` on, broken before text_width.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (column > indent && column + 1 + word.size() > text_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
    text.remove_prefix(std::min(word.size() + 1, text.size()));
  }
  return result;
}

std::string bound_text(double value) {
  constexpr double quarter_turn = std::numbers::pi / 2;
  if (std::isinf(value)) return "";
  if (std::abs(value) == quarter_turn) return value < 0 ? "-pi/2" : "pi/2";
  return fmt::format("{}", value);
}

std::string bounds_text(const brdf::Parameter& parameter) {
  return bound_text(parameter.lower) + ".." + bound_text(parameter.upper);
}

std::string term_row(const brdf::TermEntry& term) {
  const std::string head =
      fmt::format("  {:<23} {:<9} ", term.description.name, kind_of(term.description));
  return head + wrapped(term.description.summary, head.size()) + "\n";
}

std::string model_row(const std::string& name) {
  const brdf::Model model(name);
  std::string row = fmt::format("  {:<27}", name);
  for (const brdf::OrderedParameter& p : brdf::ordered_parameters(model)) {
    row += " " + p.parameter->name;
  }
  return row + "\n";
}

void print_list() {
  std::string text = "Terms, with unit amplitude and in 1/sr\n";
  for (const brdf::TermEntry& term : brdf::all_terms()) text += term_row(term);
  text += "\nModels and their parameters\n";
  for (const std::string& name : brdf::model_names()) text += model_row(name);
  text +=
      "\nA model is diffuse, specular, diffuse+specular or diffuse+specular+specular, or a whole "
      "one\n"
      "that takes no other term. A specular term alone brings its author's diffuse term, or is "
      "the\n"
      "whole model of that name; a second one has parameters that end in _2. With --free-frame "
      "every\n"
      "anisotropic term has the tangent's angle psi besides. 'gonio models MODEL' explains "
      "symbols\n"
      "and parameters.\n";
  print(text);
}

/// The parameters that --free-frame adds to the model.
std::vector<brdf::ModelParameter> free_frame_parameters(const brdf::Model& model) {
  const brdf::Model free(model.name(), brdf::Frame::free);
  std::vector<brdf::ModelParameter> angles;
  for (const auto& p : free.shape()) {
    if (p.descriptor.name == brdf::tangent_angle.name) angles.push_back(p);
  }
  return angles;
}

/// The names of those parameters that belong to a term, by its place in the model.
std::vector<std::string> names_of(std::span<const brdf::ModelParameter> parameters,
                                  std::size_t term) {
  std::vector<std::string> names;
  for (const brdf::ModelParameter& p : parameters) {
    if (p.term == term) names.push_back(p.name);
  }
  return names;
}

/// One summand: "rho_s ward(wi, wo; alpha)", or with the amplitudes among the arguments where the
/// term is not proportional to one.
std::string summand(const brdf::Model& model, std::size_t term) {
  const brdf::TermDescription& description = model.terms()[term]->description;
  std::vector<std::string> arguments = names_of(model.shape(), term);
  std::vector<std::string> factors = names_of(model.amplitudes(), term);
  if (description.coefficients != brdf::Coefficients::linear) {
    arguments.insert(arguments.begin(), factors.begin(), factors.end());
    factors.clear();
  }
  return fmt::format("{}{}{}(wi, wo{}{})", fmt::join(factors, " "), factors.empty() ? "" : " ",
                     description.name, arguments.empty() ? "" : "; ", fmt::join(arguments, ", "));
}

std::string formula(const brdf::Model& model) {
  std::vector<std::string> summands;
  for (std::size_t term = 0; term < model.terms().size(); ++term) {
    summands.push_back(summand(model, term));
  }
  return fmt::format("{}", fmt::join(summands, " + "));
}

std::string term_paragraph(const brdf::TermDescription& term) {
  std::string text =
      fmt::format("\n{} ({})\n  {}\n", term.name, kind_of(term), wrapped(term.summary, 2));
  if (!term.symbols.empty()) text += fmt::format("  {}\n", wrapped(term.symbols, 2));
  text += fmt::format("  {}\n", wrapped(term.source, 2));
  if (!term.reciprocal) text += "  not reciprocal: exchanging wi and wo changes the value\n";
  return text;
}

std::string parameter_row(const brdf::ModelParameter& parameter, bool per_channel) {
  const brdf::Parameter& descriptor = parameter.descriptor;
  const std::string head =
      fmt::format("  {:<9} {:<5} {:<11} {:<12} ", parameter.name, descriptor.unit,
                  bounds_text(descriptor), per_channel ? "per channel" : "shared");
  const std::string indent(head.size(), ' ');
  return fmt::format("{}{}\n{}({})\n", head, wrapped(descriptor.meaning, head.size()), indent,
                     wrapped(descriptor.source, head.size()));
}

/// The model's terms, one that stands twice only once.
std::vector<const brdf::TermEntry*> distinct_terms(const brdf::Model& model) {
  std::vector<const brdf::TermEntry*> distinct;
  for (const brdf::TermEntry* term : model.terms()) {
    if (std::find(distinct.begin(), distinct.end(), term) == distinct.end()) {
      distinct.push_back(term);
    }
  }
  return distinct;
}

void print_model(const brdf::Model& model) {
  std::string text =
      fmt::format("{}\n  f_r = {}, in 1/sr\n", model.name(), wrapped(formula(model), 8));
  for (const brdf::TermEntry* term : distinct_terms(model)) {
    text += term_paragraph(term->description);
  }
  text += fmt::format("\n  {:<9} {:<5} {:<11} {:<12} {}\n", "parameter", "unit", "bounds", "values",
                      "meaning (source)");
  for (const auto& p : brdf::ordered_parameters(model)) {
    text += parameter_row(*p.parameter, p.per_channel);
  }
  if (model.is_anisotropic()) text += "\n  with --free-frame\n";
  for (const auto& p : free_frame_parameters(model)) text += parameter_row(p, false);
  print(text);
}

// JSON ---------------------------------------------------------------------------------------

ordered_json json_of(const brdf::TermDescription& term) {
  return {{"name", term.name},       {"kind", kind_of(term)}, {"summary", term.summary},
          {"symbols", term.symbols}, {"source", term.source}, {"reciprocal", term.reciprocal}};
}

/// An infinite bound is null.
ordered_json bound_json(double bound) {
  return std::isinf(bound) ? ordered_json() : ordered_json(bound);
}

ordered_json json_of(const brdf::Model& model, const brdf::ModelParameter& parameter,
                     bool per_channel) {
  const brdf::Parameter& descriptor = parameter.descriptor;
  return {{"name", parameter.name},
          {"term", model.terms()[parameter.term]->description.name},
          {"unit", descriptor.unit},
          {"lower", bound_json(descriptor.lower)},
          {"upper", bound_json(descriptor.upper)},
          {"per_channel", per_channel},
          {"meaning", descriptor.meaning},
          {"source", descriptor.source}};
}

ordered_json json_of(const brdf::Model& model) {
  ordered_json terms = ordered_json::array();
  for (const brdf::TermEntry* term : model.terms()) terms.push_back(json_of(term->description));
  ordered_json parameters = ordered_json::array();
  for (const auto& p : brdf::ordered_parameters(model)) {
    parameters.push_back(json_of(model, *p.parameter, p.per_channel));
  }
  ordered_json free_frame = ordered_json::array();
  for (const auto& p : free_frame_parameters(model)) {
    free_frame.push_back(json_of(model, p, false));
  }
  return {{"model", model.name()},
          {"terms", terms},
          {"parameters", parameters},
          {"free_frame_parameters", free_frame}};
}

ordered_json json_of_all() {
  ordered_json terms = ordered_json::array();
  for (const brdf::TermEntry& term : brdf::all_terms()) terms.push_back(json_of(term.description));
  ordered_json models = ordered_json::array();
  for (const std::string& name : brdf::model_names()) models.push_back(json_of(brdf::Model(name)));
  return {{"terms", terms}, {"models", models}};
}

void models(const ModelsOptions& options) {
  if (options.model.empty()) {
    options.json ? print_json(json_of_all()) : print_list();
    return;
  }
  const brdf::Model model(options.model);
  options.json ? print_json(json_of(model)) : print_model(model);
}

}  // namespace

void add_models_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<ModelsOptions>();
  CLI::App* command =
      app.add_subcommand("models", "List the models, or explain the parameters of one");
  command->add_option("MODEL", options->model, "The model to explain");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options] { models(*options); });
}

}  // namespace gonio::app
