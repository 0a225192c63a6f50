#include "bench/shader_cost_listings.h"

#include <array>

namespace gonio::bench {
namespace {

constexpr std::string_view uniforms = R"(
cbuffer Material : register(b0) {
  float3 c;
  float roughness;
  float3 Ps;
  float exponent;
  float2 roughnesses;
  float2 exponents;
  float3 light_ambient;
  float gloss;
  float3 light_diffuse;
  float sigma2;
  float3 light_specular;
  float smoothness;
  float metalness;
  float transparency;
  float Rs;
};
)";

/// What several listings compute.
constexpr std::string_view before = R"(
static const float pi = 3.14159;

[[vk::binding(2, 0)]] Texture2D<float> exponent_table;
[[vk::binding(3, 0)]] SamplerState clamped;

float3 ward_from(float exponent_of_lobe, float n_dot_l, float n_dot_v) {
  float r2 = roughness * roughness + 1e-5;
  float3 specular = Ps * exp(exponent_of_lobe / r2) / (4 * pi * r2 * sqrt(n_dot_l * n_dot_v));
  return n_dot_l * (c + specular);
}

float2 oren_nayar_factors() {
  return float2(1, 0) + float2(-0.5, 0.45) * sigma2 / (sigma2 + float2(0.33, 0.09));
}

float3 classic(float n_dot_l, float lobe) {
  return light_ambient * c + light_diffuse * n_dot_l * c + light_specular * min(lobe, gloss);
}

// lit() of Direct3D. glslang's has a product in place of the power.
float4 lit_factors(float n_dot_l, float n_dot_h, float m) {
  float specular = n_dot_l < 0 || n_dot_h < 0 ? 0 : pow(n_dot_h, m);
  return float4(1, max(0, n_dot_l), specular, 1);
}

float strauss_fresnel(float x) {
  static const float kf = 1.12;
  static const float at_0 = 1 / (kf * kf);
  static const float at_1 = 1 / ((1 - kf) * (1 - kf));
  return (1 / ((x - kf) * (x - kf)) - at_0) / (at_1 - at_0);
}

float strauss_shadowing(float x) {
  static const float ks = 1.01;
  static const float at_0 = 1 / (ks * ks);
  static const float at_1 = 1 / ((1 - ks) * (1 - ks));
  return (at_1 - 1 / ((x - ks) * (x - ks))) / (at_1 - at_0);
}

float3 shade(float3 n, float3 l, float3 v) {
)";

constexpr std::string_view entry = R"(
float4 main([[vk::location(0)]] float3 normal : NORMAL,
            [[vk::location(1)]] float3 to_light : LIGHT,
            [[vk::location(2)]] float3 to_viewer : VIEWER) : SV_Target {
  return float4(shade(normalize(normal), normalize(to_light), normalize(to_viewer)), 1);
}
)";

constexpr std::string_view nothing = "  return c * dot(n, l) * dot(n, v);\n";

constexpr std::string_view ward_by_angle = R"(
  float tangent = tan(acos(dot(n, normalize(l + v))));
  return ward_from(-(tangent * tangent), dot(n, l), dot(n, v));
)";

constexpr std::string_view ward_by_texture = R"(
  float u = (dot(n, normalize(l + v)) + 1) / 2;
  return ward_from(exponent_table.Sample(clamped, float2(u, 0.5)), dot(n, l), dot(n, v));
)";

constexpr std::string_view ward_by_cosine = R"(
  float n_dot_h = dot(n, normalize(l + v));
  return ward_from(1 - 1 / (n_dot_h * n_dot_h), dot(n, l), dot(n, v));
)";

constexpr std::string_view ward_by_components = R"(
  float3 h = l + v;
  float3 across = cross(n, h);
  float along = dot(n, h);
  return ward_from(-dot(across, across) / (along * along), dot(n, l), dot(n, v));
)";

constexpr std::string_view ward_anisotropic = R"(
  float2 a = roughnesses + 1e-5;
  float3 tangent = normalize(cross(n, float3(1, 0, 0)));
  float3 bitangent = normalize(cross(n, tangent));
  float3 h = normalize(l + v);
  float2 along = float2(dot(h, tangent), dot(h, bitangent)) / a;
  float beta = -2 * dot(along, along) / (1 + dot(n, h));
  float3 specular = Ps * exp(beta) / (4 * pi * a.x * a.y * sqrt(dot(n, l) * dot(n, v)));
  return dot(n, l) * (c + specular);
)";

constexpr std::string_view ashikhmin_shirley = R"(
  float3 tangent = normalize(cross(n, float3(1, 0, 0)));
  float3 bitangent = normalize(cross(n, tangent));
  float3 h = normalize(l + v);
  float n_dot_l = dot(n, l);
  float n_dot_v = dot(n, v);
  float n_dot_h = dot(n, h);
  float h_dot_l = dot(h, l);
  float3 diffuse = 28 * c / (23 * pi) * (1 - Rs) * (1 - pow(1 - n_dot_l / 2, 5)) *
                   (1 - pow(1 - n_dot_v / 2, 5));
  float h_t = dot(h, tangent);
  float h_b = dot(h, bitangent);
  float power = (exponents.x * h_t * h_t + exponents.y * h_b * h_b) / (1 - n_dot_h * n_dot_h);
  float numerator = sqrt((exponents.x + 1) * (exponents.y + 1)) * pow(n_dot_h, power);
  float denominator = 8 * pi * h_dot_l * max(n_dot_l, n_dot_v);
  float fresnel = Rs + (1 - Rs) * pow(1 - h_dot_l, 5);
  return diffuse + Rs * (numerator / denominator) * fresnel;
)";

constexpr std::string_view strauss = R"(
  float s = smoothness;
  float n_dot_l = dot(n, l);
  float n_dot_v = dot(n, v);
  float3 h = reflect(l, n);
  float d = 1 - metalness * s;
  float rd = (1 - s * s * s) * (1 - transparency);
  float3 diffuse = n_dot_l * d * rd * c;
  float r = (1 - transparency) - rd;
  float fresnel = strauss_fresnel(n_dot_l);
  float j = fresnel * strauss_shadowing(n_dot_l) * strauss_shadowing(n_dot_v);
  float reflectivity = min(1, r + j * (r + 0.1));
  float3 tint = 1 + metalness * (1 - fresnel) * (c - 1);
  float3 specular = reflectivity * tint * pow(-dot(h, v), 3 / (1 - s));
  return max(0, diffuse) + max(0, specular);
)";

constexpr std::string_view oren_nayar_by_angles = R"(
  float2 factors = oren_nayar_factors();
  float n_dot_l = dot(n, l);
  float n_dot_v = dot(n, v);
  float theta_i = acos(n_dot_l);
  float theta_o = acos(n_dot_v);
  float cos_phi = max(0, dot(normalize(l - n_dot_l * n), normalize(v - n_dot_v * n)));
  float larger = max(theta_i, theta_o);
  float smaller = min(theta_i, theta_o);
  return c * n_dot_l * (factors.x + factors.y * cos_phi * sin(larger) * tan(smaller));
)";

constexpr std::string_view oren_nayar_rewrite = R"(
  float2 factors = oren_nayar_factors();
  float ci = saturate(dot(n, l));
  float co = saturate(dot(n, v));
  float sines = sqrt((1 - ci * ci) * (1 - co * co));
  float3 light_plane = normalize(l - ci * n);
  float3 view_plane = normalize(v - co * n);
  float cos_phi = saturate(dot(light_plane, view_plane));
  return c * ci * (factors.x + factors.y * cos_phi * sines / max(ci, co));
)";

constexpr std::string_view oren_nayar_by_product = R"(
  float2 factors = oren_nayar_factors();
  float n_dot_l = dot(n, l);
  float n_dot_v = dot(n, v);
  float product = dot(l - n_dot_l * n, v - n_dot_v * n);
  return c * n_dot_l * (factors.x + factors.y * max(0, product) / max(n_dot_l, n_dot_v));
)";

constexpr std::string_view phong = R"(
  float n_dot_l = dot(n, l);
  if (n_dot_l <= 0) return light_ambient * c;
  float3 r = normalize(2 * n_dot_l * n - l);
  return classic(n_dot_l, pow(saturate(dot(r, v)), exponent));
)";

constexpr std::string_view blinn_phong = R"(
  float n_dot_l = dot(n, l);
  if (n_dot_l <= 0) return light_ambient * c;
  return classic(n_dot_l, pow(saturate(dot(n, normalize(l + v))), exponent));
)";

constexpr std::string_view blinn_phong_by_lit = R"(
  float4 factors = lit_factors(dot(n, l), dot(n, normalize(l + v)), exponent);
  return classic(factors.y, factors.z);
)";

constexpr std::array<ListingShader, 14> all{{
    {"interface", "n, l and v alone", nothing},
    {"Ward isotropic", "tan(acos(n.h))", ward_by_angle, 44},
    {"Ward isotropic", "512-texel table", ward_by_texture, 33},
    {"Ward isotropic", "1/(n.h)^2 - 1", ward_by_cosine},
    {"Ward isotropic", "components of l + v", ward_by_components},
    {"Ward anisotropic", "as published", ward_anisotropic, 48},
    {"Ashikhmin-Shirley", "as published", ashikhmin_shirley, 71},
    {"Strauss", "as published", strauss, 46},
    {"Oren-Nayar", "sin and tan of the angles", oren_nayar_by_angles},
    {"Oren-Nayar", "van Ouwerkerk's rewrite", oren_nayar_rewrite},
    {"Oren-Nayar", "no normalise, no root", oren_nayar_by_product},
    {"Phong", "Phong", phong},
    {"Phong", "Blinn-Phong", blinn_phong},
    {"Phong", "Blinn-Phong by lit()", blinn_phong_by_lit},
}};

}  // namespace

std::span<const ListingShader> listing_shaders() { return all; }

std::string shade_function(const ListingShader& listing) {
  return std::string(before).append(listing.body).append("}\n");
}

std::string pixel_shader(const ListingShader& listing) {
  return std::string(uniforms).append(shade_function(listing)).append(entry);
}

}  // namespace gonio::bench
