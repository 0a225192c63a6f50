// gonio convert: what its kinds of source share.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/gonio/command.h"
#include "material/conversion.h"

namespace gonio::app {

/// The command line as it was given; empty where an option is absent.
struct ConvertArguments {
  std::string source;
  std::string exponent, alpha;
  std::string ks, rho_s, specular_share;
  std::string amplitude;
  std::string lobe;
  std::string default_exponent;
  std::string to;
  std::string method;
  std::string metric = "cosine-l2";
  std::string theta;
  std::string output;
  bool json = false;
};

/// Metric, incidence and method (the best fit unless given).
material::ConversionOptions conversion_options_in(const ConvertArguments& arguments);

/// The methods to show: the one that was asked for, or both.
std::vector<material::ConversionMethod> methods_in(const ConvertArguments& arguments);

/// The isotropic specular term that old Phong materials become.
std::string target_term_in(const ConvertArguments& arguments);

/// A number that an option gives. Throws std::invalid_argument that names the option.
double number_of(std::string_view option, std::string_view text);

// One per kind of source. Each prints its result and may set invocation.exit_status.
void convert_lobe(const ConvertArguments& arguments, Invocation& invocation);
void convert_material(const ConvertArguments& arguments, Invocation& invocation);
void convert_csv(const ConvertArguments& arguments, Invocation& invocation);
void convert_mtl(const ConvertArguments& arguments, Invocation& invocation);

/// "12.3 %", for a share of a whole.
std::string percent(double share);

/// What the errors of the tables are, in words.
std::string error_legend(const material::ConversionOptions& options);

/// The converted material with its provenance: the command line and the source file, if it was one.
void set_provenance(material::Material& material, const std::string& source_file,
                    const Invocation& invocation);

}  // namespace gonio::app
