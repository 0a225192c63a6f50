// f_r of every term in 50 decimal digits, from the formulas as published: what an evaluation is
// judged by. The formulas are those of the tests' references, here with amplitudes.
//
// Half-vector lobes are those of the rounded components as they are: at grazing angles the rounding
// of a component moves a half vector by more than the evaluation errs. Mirror lobes are those of
// the normalised directions: their exponents would show the rounding of the norms.
#pragma once

#include <array>
#include <concepts>

#include "brdf/terms.h"
#include "tests/ashikhmin_shirley_reference.h"
#include "tests/oren_nayar_reference.h"
#include "tests/phong_reference.h"
#include "tests/strauss_reference.h"
#include "tests/ward_reference.h"

namespace gonio::bench {

using tests::Digits;

/// f_r of the term T in 1/sr, for directions of any precision D; specialised for every term:
///
///   template <class D>
///   static Digits value(const std::array<Digits, K>& amplitudes,
///                       const std::array<Digits, P>& shape, const brdf::Direction<D>& wi,
///                       const brdf::Direction<D>& wo);
///
/// A term added to brdf/terms.h needs one here, and its naive form in bench/naive/.
template <class T>
struct Reference;

template <>
struct Reference<brdf::Lambert> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& rho, const std::array<Digits, 0>& /*shape*/,
                      const brdf::Direction<D>& /*wi*/, const brdf::Direction<D>& /*wo*/) {
    return rho[0] / tests::reference_pi();
  }
};

template <>
struct Reference<brdf::OrenNayar> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& rho, const std::array<Digits, 1>& sigma,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return rho[0] * tests::reference_oren_nayar(sigma[0], tests::reference_angles<Digits>(wi, wo));
  }
};

/// The direct illumination is 0 where the published formula falls below it.
template <>
struct Reference<brdf::OrenNayarFull> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& rho, const std::array<Digits, 1>& sigma,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    const auto full =
        tests::reference_full_oren_nayar(sigma[0], tests::reference_angles<Digits>(wi, wo));
    const Digits direct = full.direct > 0 ? full.direct : Digits(0);
    return rho[0] * direct + rho[0] * rho[0] * full.interreflection;
  }
};

template <class T>
requires std::same_as<T, brdf::Phong> || std::same_as<T, brdf::BlinnPhong>
struct Reference<T> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& ks, const std::array<Digits, 1>& exponent,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return ks[0] * tests::reference_power(tests::reference_cosine(T{}, wi, wo), exponent[0]);
  }
};

template <class Lobe>
struct Reference<brdf::IsotropicWard<Lobe>> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& rho, const std::array<Digits, 1>& alpha,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return rho[0] * tests::reference(Lobe{}, alpha[0], alpha[0], wi, wo).value;
  }
};

template <class Lobe>
struct Reference<brdf::AnisotropicWard<Lobe>> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& rho, const std::array<Digits, 2>& alpha,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return rho[0] * tests::reference(Lobe{}, alpha[0], alpha[1], wi, wo).value;
  }
};

template <class Exponents>
struct Reference<brdf::AshikhminShirley<Exponents>> {
  template <class D, std::size_t P>
  static Digits value(const std::array<Digits, 1>& rs, const std::array<Digits, P>& n,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return tests::ashikhmin_shirley_reference(n.front(), n.back(), wi, wo).value(Digits(0), rs[0]);
  }
};

template <class Exponents>
struct Reference<brdf::CoupledAshikhminShirley<Exponents>> {
  template <class D, std::size_t P>
  static Digits value(const std::array<Digits, 2>& shares, const std::array<Digits, P>& n,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    return tests::ashikhmin_shirley_reference(n.front(), n.back(), wi, wo)
        .value(shares[0], shares[1]);
  }
};

template <class ArgumentOf>
struct Reference<brdf::StraussTerm<ArgumentOf>> {
  template <class D>
  static Digits value(const std::array<Digits, 1>& c, const std::array<Digits, 3>& smt,
                      const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
    constexpr bool listing = std::is_same_v<ArgumentOf, brdf::StraussCosine>;
    auto angles = tests::strauss_angles<Digits>(listing, wi, wo);
    // The limit s = 1 asks whether the directions are each other's mirror image, which 50 digits of
    // a cosine cannot say.
    if (wo.x == -wi.x && wo.y == -wi.y && wo.z == wi.z) angles.mirror_cosine = 1;
    return tests::reference_strauss(c[0], {smt[0], smt[1], smt[2]}, angles);
  }
};

}  // namespace gonio::bench
