// What the published listings share: the vectors and functions of a shading language, in float.
//
// Convention: n, l, v are unit vectors of one common frame (any), away from the surface; l points
// to the light, v to the viewer. Pi is written 3.14159: as a float 8.1e-7 of itself too small.
//
// maximum(), minimum() and saturate() let the NaN of a listing pass. Direct3D 10 and later return
// the other operand, so that it may end there as an unlit pixel; elsewhere it may be either.
#pragma once

#include <cmath>

namespace gonio::brdf::listings {

struct Float3 {
  float x, y, z;
};

inline Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Float3 operator*(float factor, const Float3& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
inline float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Float3 cross(const Float3& a, const Float3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// NaN for the null vector.
inline Float3 normalize(const Float3& a) { return (1 / std::sqrt(dot(a, a))) * a; }

/// The vector mirrored in the plane whose unit normal is n: of l, the direction below the surface.
inline Float3 reflect(const Float3& incident, const Float3& n) {
  return incident - 2 * dot(n, incident) * n;
}

/// The larger, or `b` if that is NaN.
inline float maximum(float a, float b) { return a > b ? a : b; }

/// The smaller, or `a` if that is NaN.
inline float minimum(float a, float b) { return b < a ? b : a; }

/// Cut to 0..1.
inline float saturate(float a) {
  const float at_least_0 = a < 0 ? 0 : a;
  return at_least_0 > 1 ? 1 : at_least_0;
}

/// base^exponent as shaders compute it, 2^(exponent log2 base): NaN for a negative base, whatever
/// the exponent, for 0^0 and for 1^infinity.
inline float power(float base, float exponent) { return std::exp2(exponent * std::log2(base)); }

inline constexpr float shader_pi = 3.14159F;

/// The vectors at a pixel: surface normal, to the light, to the viewer.
struct Geometry {
  Float3 n, l, v;
};

/// normalize(l + v); NaN where they are opposite.
inline Float3 half_vector(const Geometry& at) { return normalize(at.l + at.v); }

struct TangentFrame {
  Float3 tangent, bitangent;
};

/// The frame of the anisotropic listings, from epsilon = (1, 0, 0): tangent = normalize(n x
/// epsilon), bitangent = normalize(n x tangent). For n = z that is y and -x, so what is said of the
/// tangent happens along y. NaN at n = epsilon and n = -epsilon, around which the frame turns.
inline TangentFrame frame_from_epsilon(const Float3& n) {
  const Float3 tangent = normalize(cross(n, {1, 0, 0}));
  return {tangent, normalize(cross(n, tangent))};
}

}  // namespace gonio::brdf::listings
