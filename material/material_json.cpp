#include "material/material_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "material/evaluate.h"
#include "material/fit_summary_json.h"
#include "table/channel_names.h"
#include "table/json_file.h"
#include "table/output_file.h"

namespace gonio::material {
namespace {

using nlohmann::ordered_json;
using table::JsonField;

constexpr std::string_view format_word = "gonio-material";
constexpr std::uint64_t newest_version = 1;

// Reading ------------------------------------------------------------------------------------

/// The model named at `field`, in the frame that the members of `parameters` are for.
brdf::Model read_model(const JsonField& field, const JsonField& parameters) {
  const auto members = parameters.members();
  std::vector<brdf::NamedValues> names;
  for (const auto& [name, value] : members) names.push_back({name, {}});
  try {
    return brdf::model_for(field.text(), names);
  } catch (const std::invalid_argument& error) {
    field.refuse(error.what());
  }
}

std::vector<std::string> read_channels(const JsonField& field) {
  std::vector<std::string> names = field.texts();
  if (const auto problem = table::channel_names_problem(names)) field.refuse(*problem);
  return names;
}

std::optional<double> read_stddev(const JsonField& field) {
  if (field.is_null()) return std::nullopt;
  const double value = field.number();
  if (value < 0) field.expected("a standard deviation, 0 or more, or null");
  return value;
}

std::optional<std::pair<double, double>> read_interval(const JsonField& field) {
  if (field.is_null()) return std::nullopt;
  const std::vector<double> ends = field.numbers();
  if (ends.size() != 2 || ends[0] > ends[1]) field.refuse("expected [lower, upper] or null");
  return std::pair(ends[0], ends[1]);
}

/// The entries of an array as long as the values, or the one entry beside a plain value.
std::vector<JsonField> entries(const JsonField& field, bool is_list, std::size_t count) {
  if (!is_list) return {field};
  std::vector<JsonField> elements = field.elements();
  if (elements.size() != count) {
    field.expected(fmt::format("an array of {}, one per value", count));
  }
  return elements;
}

ParameterValue read_parameter(const std::string& name, const JsonField& field, bool is_shape) {
  field.allow_only({"value", "stddev", "interval95"});
  const JsonField value = field.member("value");
  if (is_shape && !value.is_number()) value.expected("one number, shared by all channels");
  const bool is_list = value.is_array();
  ParameterValue parameter;
  parameter.name = name;
  if (is_list) {
    parameter.value = value.numbers();
  } else {
    parameter.value = {value.number()};
  }
  if (const auto stddev = field.find("stddev")) {
    for (const JsonField& entry : entries(*stddev, is_list, parameter.value.size())) {
      parameter.stddev.push_back(read_stddev(entry));
    }
  }
  if (const auto interval = field.find("interval95")) {
    for (const JsonField& entry : entries(*interval, is_list, parameter.value.size())) {
      parameter.interval95.push_back(read_interval(entry));
    }
  }
  return parameter;
}

bool is_shape(const brdf::Model& model, std::string_view name) {
  return std::any_of(model.shape().begin(), model.shape().end(),
                     [&](const brdf::ModelParameter& p) { return p.name == name; });
}

bool has_parameter(const brdf::Model& model, std::string_view name) {
  const auto known = brdf::ordered_parameters(model);
  return std::any_of(known.begin(), known.end(),
                     [&](const brdf::OrderedParameter& p) { return p.parameter->name == name; });
}

/// Throws an error at the field of the parameter that does not suit the model.
void require_suitable(const Material& material, const brdf::Model& model,
                      const JsonField& parameters) {
  try {
    bind(material);
  } catch (const brdf::ParameterError& error) {
    const std::string& name = error.parameter();
    const auto field = parameters.find(name);
    if (!field) parameters.refuse(fmt::format("\"{}\": {}", name, error.what()));
    if (!has_parameter(model, name)) field->refuse(error.what());
    field->member("value").refuse(error.what());
  }
}

/// Into the model's order, whatever the order of the file.
std::vector<ParameterValue> in_order(const brdf::Model& model,
                                     const std::vector<ParameterValue>& values) {
  std::vector<ParameterValue> ordered;
  for (const brdf::OrderedParameter& p : brdf::ordered_parameters(model)) {
    ordered.push_back(*std::find_if(values.begin(), values.end(), [&](const ParameterValue& v) {
      return v.name == p.parameter->name;
    }));
  }
  return ordered;
}

ConversionRecord read_conversion(const JsonField& field) {
  const JsonField error = field.member("error");
  return {.from = field.member("from").text(),
          .method = field.member("method").text(),
          .metric = field.member("metric").text(),
          .metric_error = error.member("metric").number(),
          .theta_i_deg = field.member("theta_i_deg").numbers(),
          .peak = error.member("peak").number(),
          .rms = error.member("rms").number(),
          .albedo = error.member("albedo").number()};
}

MaterialProvenance read_provenance(const JsonField& field) {
  const auto text = [&](std::string_view key) {
    const auto member = field.find(key);
    return member ? member->text() : std::string();
  };
  return {.table = text("table"),
          .sha256 = text("sha256"),
          .gonio = text("gonio"),
          .command = text("command")};
}

Material material_of(const table::JsonFile& file) {
  file.require_format(format_word, newest_version);
  const JsonField root = file.root();
  const JsonField parameters = root.member("parameters");
  const brdf::Model model = read_model(root.member("model"), parameters);
  Material material;
  material.model = model.name();
  material.channels = read_channels(root.member("channels"));
  if (const auto name = root.find("name")) material.name = name->text();
  for (const auto& [name, field] : parameters.members()) {
    material.parameters.push_back(read_parameter(name, field, is_shape(model, name)));
  }
  require_suitable(material, model, parameters);
  material.parameters = in_order(model, material.parameters);
  if (const auto fit = root.find("fit")) material.fit = read_fit_summary(*fit);
  if (const auto conversion = root.find("conversion")) {
    material.conversion = read_conversion(*conversion);
  }
  if (const auto provenance = root.find("provenance")) {
    material.provenance = read_provenance(*provenance);
  }
  return material;
}

// Writing ------------------------------------------------------------------------------------

ordered_json json_of(double value) { return value; }

ordered_json json_of(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json json_of(const std::optional<std::pair<double, double>>& interval) {
  return interval ? ordered_json{interval->first, interval->second} : ordered_json(nullptr);
}

template <class T>
ordered_json array_of(const std::vector<T>& values) {
  ordered_json array = ordered_json::array();
  for (const T& value : values) array.push_back(json_of(value));
  return array;
}

template <class T>
void add_values(ordered_json& parameter, const char* key, const std::vector<T>& values,
                bool is_list) {
  if (values.empty()) return;
  parameter[key] = is_list ? array_of(values) : json_of(values.front());
}

ordered_json parameters_of(const Material& material) {
  const brdf::Model model = model_of(material);
  ordered_json parameters = ordered_json::object();
  for (const ParameterValue& p : material.parameters) {
    const bool is_list = !is_shape(model, p.name);
    ordered_json parameter = ordered_json::object();
    add_values(parameter, "value", p.value, is_list);
    add_values(parameter, "stddev", p.stddev, is_list);
    add_values(parameter, "interval95", p.interval95, is_list);
    parameters[p.name] = parameter;
  }
  return parameters;
}

ordered_json json_of(const ConversionRecord& conversion) {
  return {{"from", conversion.from},
          {"method", conversion.method},
          {"metric", conversion.metric},
          {"theta_i_deg", conversion.theta_i_deg},
          {"error",
           {{"metric", conversion.metric_error},
            {"peak", conversion.peak},
            {"rms", conversion.rms},
            {"albedo", conversion.albedo}}}};
}

ordered_json json_of(const MaterialProvenance& provenance) {
  return {{"table", provenance.table},
          {"sha256", provenance.sha256},
          {"gonio", provenance.gonio},
          {"command", provenance.command}};
}

}  // namespace

Material read_material(const std::string& path) { return material_of(table::JsonFile::read(path)); }

Material parse_material(std::string_view json, const std::string& path) {
  return material_of(table::JsonFile::parse(json, path));
}

ordered_json to_json(const Material& material) {
  ordered_json json;
  json["format"] = format_word;
  json["version"] = newest_version;
  json["name"] = material.name;
  json["model"] = material.model;
  json["channels"] = material.channels;
  json["parameters"] = parameters_of(material);
  if (material.fit) json["fit"] = json_of(*material.fit);
  if (material.conversion) json["conversion"] = json_of(*material.conversion);
  if (material.provenance) json["provenance"] = json_of(*material.provenance);
  return json;
}

void write_material(const Material& material, const std::string& path) {
  const std::string text = table::json_text(to_json(material));
  parse_material(text, path);
  table::write_file(path, text);
}

}  // namespace gonio::material
