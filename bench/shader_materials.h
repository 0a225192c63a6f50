// The materials that exported shaders are judged with: for every model several sets of parameters,
// the ends of the intervals among them, in three channels of different amplitudes.
#pragma once

#include <string>
#include <vector>

#include "brdf/bound_model.h"

namespace gonio::bench {

/// Which shapes: those that the figure is for (alpha from 1e-2, exponents to 1e4), or narrower
/// lobes (alpha 1e-3 and 1e-4, exponents 1e5 and 1e6).
enum class LobeWidths { ordinary, narrow };

/// How far from the mirror direction a lobe reaches: the slopes hx/hz and hy/hz of the half vector
/// at which it has fallen to 1/e, in its own frame.
struct LobeScale {
  double x, y;
  double psi = 0;  // the azimuth of the lobe's frame
};

struct ShaderMaterial {
  std::string model;       // with its frame: "lambert+ward-gmd-aniso, free frame"
  std::string parameters;  // the shape: "alpha_x 0.01, alpha_y 0.05"; empty without one
  brdf::BoundModel bound;
  /// One per term that has a lobe; empty for diffuse models.
  std::vector<LobeScale> lobes;
  /// Strauss's mirror, s = 1: it is 0 wherever wo is not the mirror image of wi.
  bool is_mirror = false;
};

/// The materials of the model in that frame; none if no parameter of it has such a width.
std::vector<ShaderMaterial> shader_materials(const brdf::Model& model, LobeWidths widths);

/// The models of the study: brdf::model_names(), and sums with two lobes, another diffuse term and
/// a free frame.
std::vector<brdf::Model> shader_models();

}  // namespace gonio::bench
