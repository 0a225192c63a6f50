// From one reflectance model to another: old Phong materials as Ward materials, Ward materials as
// the cheaper Blinn-Phong for the distance, with the error that remains.
//
// The closed form (phong_conversion.h) knows isotropic lobes on Lambert's diffuse; the best fit
// takes any material to any model, by least squares over stated directions (comparison.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fit/options.h"
#include "material/comparison.h"
#include "material/material.h"
#include "material/phong_conversion.h"

namespace gonio::material {

enum class ConversionMethod { closed_form, best_fit };
std::string_view name(ConversionMethod method);
/// Throws std::invalid_argument that lists the methods.
ConversionMethod conversion_method_from_name(std::string_view name);

struct ConversionOptions {
  ConversionMethod method = ConversionMethod::best_fit;
  /// What the best fit minimises, and what metric_error is an error of; chi2 has no meaning here.
  fit::Metric metric = fit::Metric::cosine_l2;
  /// The polar angles of the lights under which the two are compared; azimuths as suits the models.
  std::vector<double> theta_deg = Incidence{}.theta_deg;
  /// The result is to be a highlight without the cosine of the incidence (Amplitude::classic), as a
  /// shader draws it: what is fitted is ks cos^n / cos_i. For phong and blinn-phong and the metric
  /// cosine-l2 only; the material that comes out has to be drawn in this way, too.
  bool to_classic = false;
};

/// Lambert's diffuse and one isotropic lobe.
struct LobeMaterial {
  std::string name;
  std::vector<std::string> channels;
  std::vector<double> rho_d;  // one per channel
  Lobe lobe;
  /// The lobe reflects without the cosine of the incidence (Amplitude::classic): f_r = ks cos^n /
  /// cos_i.
  bool is_classic = false;
};

struct Conversion {
  /// With its ConversionRecord.
  Material material;
  Difference remaining;
};

/// The lobe with the specular term `to`; the diffuse part is kept. A best fit is never worse than
/// the closed form in the metric, where there is one; a lobe of amplitude 0 keeps its width by the
/// closed form. Throws std::invalid_argument where there is no closed form and it is asked for, for
/// a term that is not convertible, options that do not suit it, and values that no fit can be made
/// to.
Conversion convert(const LobeMaterial& from, std::string_view to, const ConversionOptions& options);

/// The material as another model by the best fit; a diffuse term that both have is kept. Throws
/// std::invalid_argument if the closed form is asked for and the material is no LobeMaterial, or
/// the model none either.
Conversion convert(const Material& from, const brdf::Model& to, const ConversionOptions& options);

/// The material as a diffuse part and one lobe with a closed form, if it is one.
std::optional<LobeMaterial> lobe_material_of(const Material& material);

}  // namespace gonio::material
