// The options that say which look-up table is meant, and the layout that they ask for.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "brdf/bound_model.h"
#include "lut/layout.h"

namespace gonio::app {

/// As given; empty where it is not.
struct LutOptions {
  std::string table;
  std::string size;
  std::string coordinate;
  std::string reach;
  std::string format;
  std::string alpha;
  std::string exponent;
  // Without a material:
  std::string transparency;
  std::string model;
};

/// Adds --table, --size, --coordinate, --reach, --format, --alpha and --exponent.
void add_lut_options(CLI::App& command, LutOptions& options);

/// Adds --t and --model, by which a table without a material is described.
void add_lut_parameter_options(CLI::App& command, LutOptions& options);

/// The layout for the model's parameters, by default of its first table; without a model for the
/// parameters given. --alpha and --exponent may widen the model's to a range. Unless said
/// otherwise: 512 texels of r32f over `cosine` (more than one alpha or exponent: `fourth-root`,
/// strauss-j: `sqrt`), as far as the lobe reaches. Throws std::invalid_argument that names the
/// option and says what is possible.
lut::Layout layout_from(const LutOptions& options, const brdf::BoundModel* model);

}  // namespace gonio::app
