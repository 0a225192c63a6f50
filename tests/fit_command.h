// gonio fit as a program calls it: tables in files, results as JSON and CSV.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "instrument/recipe.h"
#include "table/formats/gonio_csv.h"
#include "tests/run_gonio.h"
#include "tests/ward_materials.h"

namespace gonio::tests {

inline std::string synthetic(const std::string& name) {
  return std::string(GONIO_SOURCE_DIR) + "/data/synthetic/" + name + ".csv";
}
inline const std::string brass = synthetic("rolled_brass");
inline const std::string plastic = synthetic("ivory_computer_plastic");

inline CommandResult fit(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fit");
  return run_gonio(arguments);
}

/// What `gonio fit ARGUMENTS.. --json` prints.
inline nlohmann::json json_of(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const CommandResult result = fit(arguments);
  EXPECT_EQ(result.exit_status, 0) << fmt::format("{}", fmt::join(arguments, " ")) << "\n"
                                   << result.err;
  return nlohmann::json::parse(result.out);
}

inline double value_of(const nlohmann::json& material, const std::string& name) {
  const nlohmann::json& value = material.at("parameters").at(name).at("value");
  return value.is_array() ? value.at(0).get<double>() : value.get<double>();
}

inline std::string write_table(const TemporaryFolder& folder, const std::string& name,
                               const table::SampleTable& table) {
  std::string text;
  table::write_gonio_csv(table, {}, [&](std::string_view piece) { text += piece; });
  return folder.write(name, text);
}

inline instrument::Recipe brass_recipe() { return ward_recipe(ward_materials[0], "ward-aniso"); }

/// Of a material with these parameters: the largest relative error of any.
inline double worst_error(const nlohmann::json& material) {
  const std::map<std::string, double> truth{{"rho_d", ward_materials[0].rho_d},
                                            {"rho_s", ward_materials[0].rho_s},
                                            {"alpha_x", ward_materials[0].alpha_x},
                                            {"alpha_y", ward_materials[0].alpha_y}};
  double worst = 0;
  for (const auto& [name, value] : truth) {
    worst = std::max(worst, std::abs(value_of(material, name) / value - 1));
  }
  return worst;
}

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// A column of a gonio-table, by name; NaN where it is empty.
inline std::vector<double> column_of(const std::string& text, const std::string& name) {
  std::vector<double> column;
  std::ptrdiff_t at = -1;
  for (const std::string& line : split(text, '\n')) {
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = split(line, ',');
    if (at < 0) {
      at = std::find(fields.begin(), fields.end(), name) - fields.begin();
    } else {
      const std::string& field = fields.at(std::size_t(at));
      column.push_back(field.empty() ? NAN : std::stod(field));
    }
  }
  return column;
}

}  // namespace gonio::tests
