// A tangent of the material's own, at the azimuth psi from x towards y.
//
// A half vector along the turned bitangent leaves a tangent component that is the difference of two
// products, and a small roughness along the tangent makes much of its rounding. So it is formed
// from numbers of 12 bits, whose products a float holds exactly, and a small rest.
#ifndef GONIO_TURNED
#define GONIO_TURNED

// The first 12 bits of x.
float gonio_high_part(float x) {
  return asfloat(asuint(x) & 0xfffff000u);
}

// c x + s y for c and s as a multiple of 1/4096 (.x) and the rest (.y). `precise` keeps a compiler
// from putting the parts together again.
float gonio_sum_of_products(float2 c, float x, float2 s, float y) {
  float high_x = gonio_high_part(x);
  float high_y = gonio_high_part(y);
  precise float rest = c.x * (x - high_x) + s.x * (y - high_y) + (c.y * x + s.y * y);
  precise float sum = (c.x * high_x + s.x * high_y) + rest;
  return sum;
}

// The half vector's components along the turned tangent and bitangent; cos_psi and sin_psi as
// above. The sum of the directions is turned, not the directions: where they are opposite each other
// and graze the surface, the rounding of the turned ones would be as large as their sum. What
// rounding the sum itself loses (Knuth, The Art of Computer Programming 2, 4.2.2) is turned besides.
float3 gonio_turned(float3 wi, float3 wo, float2 cos_psi, float2 sin_psi) {
  precise float3 h = wi + wo;
  precise float3 from_wo = h - wi;
  precise float3 lost = (wi - (h - from_wo)) + (wo - from_wo);
  float x = gonio_sum_of_products(cos_psi, h.x, sin_psi, h.y);
  float y = gonio_sum_of_products(cos_psi, h.y, -sin_psi, h.x);
  return float3(x + (cos_psi.x * lost.x + sin_psi.x * lost.y),
                y + (cos_psi.x * lost.y - sin_psi.x * lost.x), h.z);
}

#endif
