// What `gonio lut check` says, for a person and as JSON.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "material/material.h"
#include "trade/table_check.h"
#include "trade/table_choice.h"

namespace gonio::app {

/// Everything that was found out.
struct LutCheckReport {
  std::string path;  // of the material
  const material::Material& material;
  std::string device;
  /// The table of samples, or why there is none.
  std::optional<std::string> samples_path;
  std::string no_samples;
  std::size_t samples;
  std::size_t grid;
  double max_theta_deg;
  bool default_tolerance;
  trade::FitErrors fit;
  trade::ResidualUse residual_use;
  /// The tolerance, and what the residual allows.
  trade::TableLimits limits;
  /// The file with the table that is checked, if it is one.
  std::string lut_path;
  /// None if --recommend found no table.
  std::optional<trade::TableCheck> check;
  /// With --recommend, the smallest of each format, the smallest first; without those that turned
  /// out to be past the limits when they were measured.
  std::optional<std::vector<trade::GoodTable>> recommended;
  std::vector<trade::TableCheck> passed_over;
  /// Where no table keeps the limits: whether some keep the tolerance alone.
  bool some_keep_tolerance;
};

/// True if there is a table and its error is within the tolerance.
bool within_tolerance(const LutCheckReport& report);

/// In lines of at most 100 columns but for paths and the device's name.
std::string text_of(const LutCheckReport& report);
nlohmann::ordered_json json_of(const LutCheckReport& report);

}  // namespace gonio::app
