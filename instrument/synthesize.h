// The virtual gonioreflectometer: from a recipe to the table that the instrument would deliver.
#pragma once

#include "instrument/recipe.h"
#include "table/sample_table.h"

namespace gonio::instrument {

/// Measures the recipe's material.
///
/// Frames: turning the sample by the rotation psi, counter-clockwise as seen from above (from x
/// towards y), leaves the lamp at azimuth 0 of the laboratory; in the sample's frame, which the
/// table uses, every azimuth is phi_lab - psi. The lamp is at phi_i = -psi, the mirror direction
/// at 180 deg - psi. Azimuths lie in [0, 360).
///
/// Order of the samples: by incidence angle, rotation, then the hemisphere, then the patch. Angles
/// are rounded to 1e-6 deg and the directions are those of the rounded angles, so that the table's
/// text states them exactly. Exitant directions beyond theta_max_deg or within 1e-6 deg of the
/// horizon are left out.
///
/// Noise: a reading takes two draws of std::mt19937_64, seeded with noise.seed, channels within
/// samples. Their upper 52 bits n give u1, u2 = (n + 1/2) / 2^52, and Box and Muller (1958) the
/// normals e1 = sqrt(-2 ln u1) cos(2 pi u2), e2 = sqrt(-2 ln u1) sin(2 pi u2): the same for every
/// standard library, but for the last bit of its log, cos and sin. sigma = sqrt((relative q)^2 +
/// floor^2) of the true quantity q. Values and sigma are converted to f_r.
///
/// Throws std::invalid_argument with the text of find_problem().
table::SampleTable synthesize(const Recipe& recipe);

}  // namespace gonio::instrument
