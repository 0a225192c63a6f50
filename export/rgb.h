// A material seen by a renderer that knows three colours: which of its channels are red, green and
// blue.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "material/comparison.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::exports {

/// The channel of the material that each of R, G and B is taken from, and one sentence that says
/// so.
struct RgbChannels {
  std::array<std::size_t, 3> channel;
  std::string statement;
  /// They are wavelengths outside 380 to 780 nm.
  bool is_invisible = false;
};

/// Three channels R, G and B in any order and case; three wavelengths ("630nm", "465 nm"), the
/// longest of which is R and the shortest B; or a single channel for all three. Nothing for
/// anything else.
std::optional<RgbChannels> find_rgb_channels(const material::Material& material);

/// The same; throws table::FileError if there are none.
RgbChannels rgb_channels(const material::Material& material);

/// A material bound to its values, with the directions and values that stand-ins are compared with.
struct RgbMaterial {
  const material::Material* material;  // not owned
  brdf::BoundModel model;
  RgbChannels channels;
  /// Of the channels R, G and B in this order, on material::default_incidence() with the azimuths
  /// counted from the first tangent.
  table::SampleTable samples;
  /// The azimuths of the material's tangents, in radians, one at least: 0 if it has none.
  std::vector<double> tangents;
};

/// Where a material's stand-ins are compared with it: material::default_incidence(), its azimuths
/// counted from the first tangent.
material::Incidence incidence_for(const brdf::BoundModel& model);

/// Throws as rgb_channels() and material::bind() do.
RgbMaterial rgb_material(const material::Material& material);

}  // namespace gonio::exports
