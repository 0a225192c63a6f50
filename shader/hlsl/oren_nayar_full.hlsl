// Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994, the full form: direct
// illumination, which the albedo multiplies (.x), and interreflection, which its square multiplies
// (.y).
//
// a and b are the larger and the smaller polar angle, dphi the azimuth between wi and wo. No
// difference that cancels is left: 1/cos(b) would make much of its rounding at grazing angles.
#ifndef GONIO_OREN_NAYAR_FULL
#define GONIO_OREN_NAYAR_FULL

#include "oren_nayar_shared.hlsl"
#include "per_pi.hlsl"
#include "polar_sine.hlsl"
#include "quarter_turns.hlsl"
#include "quotient.hlsl"
#include "smallest.hlsl"

// cos(dphi); 0 where a direction is at the pole.
float gonio_azimuth_cosine(float3 wi, float3 wo, float sine_i, float sine_o) {
  float scale_i = max(sine_i, gonio_smallest);
  float scale_o = max(sine_o, gonio_smallest);
  float cosine = (wi.x / scale_i) * (wo.x / scale_o) + (wi.y / scale_i) * (wo.y / scale_o);
  return clamp(cosine, -1.0, 1.0);
}

// 1 - |cos(dphi)| = sin^2 / (1 + |cos|), the sine from the cross product of u and v -+ u, which is
// that of u and v. u is the direction nearer to the pole; `sines` the product of both polar sines.
float gonio_off_plane(float3 u, float3 v, float sines, float cosine) {
  float side = cosine < 0.0 ? 1.0 : -1.0;
  float cross_product = u.x * (v.y + side * u.y) - u.y * (v.x + side * u.x);
  float sine = clamp(cross_product / max(sines, gonio_smallest), -1.0, 1.0);
  return sine * sine / (1.0 + abs(cosine));
}

// tan(b) (sin(a) - B^3) for B = 2b/pi and y = 1 - B, as tan(b) (y (1 + B + B^2) - (1 - sin(a))).
float gonio_opposite_side(float sin_a, float cos_a, float sin_b, float cos_b, float b_turns,
                          float y) {
  float scale_b = max(cos_b, gonio_smallest);
  return sin_b * ((y / scale_b) * (1.0 + b_turns + b_turns * b_turns) -
                  cos_a * (cos_a / scale_b) / (1.0 + sin_a));
}

float2 gonio_oren_nayar_full(float sigma, float3 wi, float3 wo) {
  float sine_i = gonio_polar_sine(wi);
  float sine_o = gonio_polar_sine(wo);
  bool i_is_lower = wi.z < wo.z;
  float sin_a = i_is_lower ? sine_i : sine_o;
  float cos_a = i_is_lower ? wi.z : wo.z;
  float sin_b = i_is_lower ? sine_o : sine_i;
  float cos_b = i_is_lower ? wo.z : wi.z;
  float b_turns = gonio_quarter_turns(sin_b, cos_b);
  float y = gonio_quarter_turns(cos_b, sin_b);
  float turns = gonio_quarter_turns(sin_a, cos_a) * b_turns;

  float cosine = gonio_azimuth_cosine(wi, wo, sine_i, sine_o);
  float sines = sine_i * sine_o;
  float off_plane = 0.0;
  if (sine_i < sine_o) {
    off_plane = gonio_off_plane(wi, wo, sines, cosine);
  } else {
    off_plane = gonio_off_plane(wo, wi, sines, cosine);
  }
  float from_same = cosine < 0.0 ? 1.0 - cosine : off_plane;  // 1 - cos(dphi)

  float along = cosine < 0.0
                    ? cosine * gonio_opposite_side(sin_a, cos_a, sin_b, cos_b, b_turns, y)
                    : gonio_oren_nayar_same_side(wi, wo);
  float across = gonio_quotient(off_plane * (turns * turns) * (sin_a + sin_b), cos_a + cos_b);
  float interreflection = y * (1.0 + b_turns) + from_same * (b_turns * b_turns);

  float c1 = 1.0 - 0.5 * gonio_oren_nayar_growth(sigma, 0.33);
  float rough = gonio_oren_nayar_growth(sigma, 0.09);
  // As published the direct illumination falls below 0 for rough surfaces at grazing angles.
  float direct = max(c1 + rough * (0.45 * along + 0.125 * across), 0.0);
  float indirect = 0.17 * gonio_oren_nayar_growth(sigma, 0.13) * interreflection;
  return float2(gonio_per_pi * direct, gonio_per_pi * indirect);
}

#endif
