// The eight published pixel-shader listings that people have in their engines, in the arithmetic
// of shaders: float, clamped only where the listing clamps, faults included. They are here to be
// compared with the models; nothing in gonio evaluates a material by them.
//
//      listing                    compare with                as
//   1  ward_isotropic             lambert+ward                n.l (pi f_diffuse + f_specular)
//      ward_isotropic_by_texture
//   2  ward_anisotropic           lambert+ward-approx-aniso   the same
//   3  ashikhmin_shirley          ashikhmin-shirley-aniso     f_diffuse + Rs f_specular
//   4  strauss                    strauss-listing             pi n.l f_r
//   5  oren_nayar                 oren-nayar                  pi n.l f_r
//   6  phong                      lambert+phong               pi (n.l f_diffuse + f_specular)
//   7  blinn_phong                lambert+blinn-phong         the same
//   8  blinn_phong_by_lit         lambert+blinn-phong         the same
//
// Each function's comment says where it departs even from that, and by how much. A function
// computes one colour channel: shaders do the same to all three at once.
#pragma once

#include "brdf/listings/ashikhmin_shirley.h"
#include "brdf/listings/oren_nayar.h"
#include "brdf/listings/phong.h"
#include "brdf/listings/shader.h"
#include "brdf/listings/strauss.h"
#include "brdf/listings/ward.h"
