// Compiled twice, with GONIO_KERNELS naming the function that it defines: see CMakeLists.txt. Of
// these loops GCC 12 vectorises the two of Oren-Nayar that call no function of the library.
#include "bench/listing_kernels.h"

#include <array>
#include <cmath>

#include "brdf/listings.h"

namespace gonio::bench {
namespace {

namespace listings = brdf::listings;
using listings::dot;
using listings::Float3;
using listings::Geometry;

constexpr float sigma = 0.5F;
constexpr listings::PhongMaterial shiny{.c = 0.5F, .exponent = 25, .gloss = 1};
constexpr listings::PhongLight light{.ambient = 0.1F, .diffuse = 1, .specular = 1};
constexpr listings::WardMaterial satin{.c = 0.5F, .specular = 0.3F, .roughness = 0.3F};

Float3 component(const Vectors& vectors, std::size_t i) {
  return {vectors.x[i], vectors.y[i], vectors.z[i]};
}

/// `function` of every pixel, with everything that it calls in the loop.
template <auto function>
[[gnu::flatten]] void each(const Pixels& pixels, std::span<float> values) {
  const std::size_t count = pixels.size();
  float* const out = values.data();
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = function({component(pixels.n, i), component(pixels.l, i), component(pixels.v, i)});
  }
}

/// A + B max(0, cos dphi) sin(a) tan(b) as Oren and Nayar print it: a the larger polar angle, b the
/// smaller.
float oren_nayar_by_angles(const Geometry& at) {
  const auto [a, b] = listings::oren_nayar_factors(sigma * sigma);
  const float n_dot_l = dot(at.n, at.l);
  const float n_dot_v = dot(at.n, at.v);
  const float theta_i = std::acos(n_dot_l);
  const float theta_o = std::acos(n_dot_v);
  const Float3 light_plane = listings::normalize(at.l - n_dot_l * at.n);
  const Float3 view_plane = listings::normalize(at.v - n_dot_v * at.n);
  const float cos_phi = listings::maximum(0, dot(light_plane, view_plane));
  const float larger = listings::maximum(theta_i, theta_o);
  const float smaller = listings::minimum(theta_i, theta_o);
  return n_dot_l * (a + b * cos_phi * std::sin(larger) * std::tan(smaller));
}

float oren_nayar_rewrite(const Geometry& at) { return listings::oren_nayar(at, sigma); }

/// Neither normalised nor rooted: the product of the projected vectors has both sines in it.
float oren_nayar_by_product(const Geometry& at) {
  const auto [a, b] = listings::oren_nayar_factors(sigma * sigma);
  const float n_dot_l = dot(at.n, at.l);
  const float n_dot_v = dot(at.n, at.v);
  const float product = dot(at.l - n_dot_l * at.n, at.v - n_dot_v * at.n);
  return n_dot_l * (a + b * listings::maximum(0, product) / listings::maximum(n_dot_l, n_dot_v));
}

float phong(const Geometry& at) { return listings::phong(at, shiny, light); }
float blinn_phong(const Geometry& at) { return listings::blinn_phong(at, shiny, light); }
float blinn_phong_by_lit(const Geometry& at) {
  return listings::blinn_phong_by_lit(at, shiny, light);
}

float ward_by_angle(const Geometry& at) { return listings::ward_isotropic(at, satin); }

const std::array<float, 512> texels = listings::ward_exponent_texels();

float ward_by_texture(const Geometry& at) {
  return listings::ward_isotropic_by_texture(at, satin, texels);
}

float ward_by_cosine(const Geometry& at) {
  const float n_dot_h = dot(at.n, listings::half_vector(at));
  return listings::ward_isotropic_with(at, satin, 1 - 1 / (n_dot_h * n_dot_h));
}

/// tan^2 = |n x h|^2 / (n.h)^2 of the unnormalised half vector.
float ward_by_components(const Geometry& at) {
  const Float3 h = at.l + at.v;
  const Float3 across = listings::cross(at.n, h);
  const float along = dot(at.n, h);
  return listings::ward_isotropic_with(at, satin, -dot(across, across) / (along * along));
}

constexpr std::array<Kernel, 3> oren_nayar_kernels{{
    {"sin and tan of the angles", each<oren_nayar_by_angles>},
    {"van Ouwerkerk's rewrite", each<oren_nayar_rewrite>},
    {"no normalise, no root", each<oren_nayar_by_product>},
}};
constexpr std::array<Kernel, 3> phong_kernels{{
    {"Phong", each<phong>},
    {"Blinn-Phong", each<blinn_phong>},
    {"Blinn-Phong by lit()", each<blinn_phong_by_lit>},
}};
constexpr std::array<Kernel, 4> ward_kernels{{
    {"tan(acos(n.h))", each<ward_by_angle>},
    {"512-texel table", each<ward_by_texture>},
    {"1/(n.h)^2 - 1", each<ward_by_cosine>},
    {"components of l + v", each<ward_by_components>},
}};
constexpr std::array<KernelGroup, 3> groups{{
    {"Oren-Nayar", oren_nayar_kernels},
    {"Phong", phong_kernels},
    {"Ward isotropic", ward_kernels},
}};

}  // namespace

std::span<const KernelGroup> GONIO_KERNELS() { return groups; }

}  // namespace gonio::bench
