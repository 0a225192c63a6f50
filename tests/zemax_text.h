// Made-up Zemax tabular BSDFs, and the directions that their angles stand for.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "brdf/direction.h"
#include "table/file_error.h"
#include "table/formats/zemax.h"
#include "table/gridded_table.h"
#include "table/sample_table.h"

namespace gonio::tests::zemax {

using brdf::Direction;

inline constexpr double degree = std::numbers::pi / 180;

/// f_r of rotation, incidence, azimuth and radial angle in degrees.
using Reflectance = std::function<double(double, double, double, double)>;

inline std::vector<double> steps(double first, double last, double step) {
  std::vector<double> angles;
  for (double angle = first; angle <= last; angle += step) angles.push_back(angle);
  return angles;
}

struct Text {
  std::string symmetry = "PlaneSymmetrical";
  std::vector<double> rotations{0};
  std::vector<double> incidences{20, 40};
  std::vector<double> azimuths = steps(0, 180, 30);
  std::vector<double> radials = steps(0, 120, 10);

  std::string header(const std::string& content) const {
    std::string text = "# made up\n# Sample: velvet  \n#\nSource\tMeasured\nSymmetry\t" + symmetry +
                       "\nSpectralContent\t" + content + "\nScatterType\tBRDF\n";
    const auto list = [&](const char* keyword, const std::vector<double>& angles) {
      text += fmt::format("{}\t{}\n{}\n", keyword, angles.size(), fmt::join(angles, "\t"));
    };
    list("SampleRotation", rotations);
    list("AngleOfIncidence", incidences);
    list("ScatterAzimuth", azimuths);
    list("ScatterRadial", radials);
    return text + "\n";
  }

  std::string block(const std::string& name, const Reflectance& f) const {
    std::string text = name + "\nDataBegin\n";
    for (const double rotation : rotations) {
      for (const double incidence : incidences) {
        text += "TIS\t0.5\n";
        for (const double azimuth : azimuths) {
          for (std::size_t k = 0; k < radials.size(); ++k) {
            text += fmt::format("{}{}", k == 0 ? "" : "\t",
                                f(rotation, incidence, azimuth, radials[k]));
          }
          text += "\n";
        }
      }
    }
    return text + "DataEnd\n";
  }

  std::string monochrome(const Reflectance& f) const {
    return header("Monochrome") + block("Monochrome", f);
  }
};

inline table::SampleTable parse(const std::string& content) {
  EXPECT_TRUE(table::is_zemax(content)) << content.substr(0, 200);
  return table::read_zemax(content, "t.bsdf", {});
}

inline std::string refusal(const std::string& content) {
  try {
    parse(content);
  } catch (const table::FileError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

inline double ones(double, double, double, double) { return 1; }

inline std::size_t count(const table::SampleTable& t, table::MaskReason reason) {
  return static_cast<std::size_t>(std::count(t.mask.begin(), t.mask.end(), reason));
}

inline double dot(const Direction<double>& a, const Direction<double>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Direction<double> cross(const Direction<double>& a, const Direction<double>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Direction<double> combination(double p, const Direction<double>& a, double q,
                                     const Direction<double>& b) {
  return {p * a.x + q * b.x, p * a.y + q * b.y, p * a.z + q * b.z};
}

inline Direction<double> turned(const Direction<double>& d, double angle) {
  return {std::cos(angle) * d.x - std::sin(angle) * d.y,
          std::sin(angle) * d.x + std::cos(angle) * d.y, d.z};
}

/// The definition by vectors: wi at azimuth 0 before the sample is turned.
inline std::pair<Direction<double>, Direction<double>> directions(double rotation, double incidence,
                                                                  double azimuth, double radial) {
  const Direction<double> wi{std::sin(incidence * degree), 0, std::cos(incidence * degree)};
  const Direction<double> s{-wi.x, -wi.y, wi.z};
  const Direction<double> z{0, 0, 1};
  Direction<double> t = combination(1, z, -dot(z, s), s);
  const double length = std::sqrt(dot(t, t));
  t = combination(1 / length, t, 0, t);
  const Direction<double> around =
      combination(std::cos(azimuth * degree), t, std::sin(azimuth * degree), cross(s, t));
  const Direction<double> wo =
      combination(std::cos(radial * degree), s, std::sin(radial * degree), around);
  return {turned(wi, -rotation * degree), turned(wo, -rotation * degree)};
}

inline double at(const table::GriddedTable& grid, const Direction<double>& wi,
                 const Direction<double>& wo) {
  double value = 0;
  grid.f_r(wi, wo, std::span(&value, 1));
  return value;
}

inline double at(const table::GriddedTable& grid, double r, double i, double a, double d) {
  const auto [wi, wo] = directions(r, i, a, d);
  return at(grid, wi, wo);
}

}  // namespace gonio::tests::zemax
