// Small OpenMATERIAL 3D tables as text.
#pragma once

#include <fmt/format.h>

#include <string>

#include "table/formats/openmaterial.h"
#include "table/sample_table.h"

namespace gonio::tests {

/// An OpenMATERIAL 3D table of these wavelengths and rows.
inline std::string document(const std::string& wavelengths, const std::string& rows) {
  return R"({"metadata": {"name": "small", "openMaterial3dVersion": "1.0.0"}, "brdf": )"
         R"({"wavelengths": [)" +
         wavelengths + R"(], "lookupTable": [)" + rows + "]}}";
}

inline table::SampleTable read_text(const std::string& content) {
  return table::read_openmaterial(content, "t.xompt", {});
}

/// A function of the angles that is linear in each of them.
inline double trilinear(double theta_i, double theta_o, double phi) {
  return (1 + theta_i) * (2 + 3 * theta_o) * (0.5 + 0.25 * phi);
}

/// Rows of that function at one wavelength, nested: each incident zenith has other exit zeniths.
inline std::string trilinear_rows(const std::string& wavelength, int azimuths,
                                  double last_azimuth) {
  std::string rows;
  for (const double theta_i : {0.0, 0.4, 1.2}) {
    for (const double theta_o : {0.0, 0.3 + 0.1 * theta_i, 1.1, 1.5}) {
      for (int k = 0; k <= azimuths; ++k) {
        const double phi = last_azimuth * k / azimuths;
        rows += fmt::format("{}[{}, {}, {}, {}, {}]", rows.empty() ? "" : ", ", wavelength, theta_i,
                            theta_o, phi, trilinear(theta_i, theta_o, phi));
      }
    }
  }
  return rows;
}

}  // namespace gonio::tests
