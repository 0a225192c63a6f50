// What a term is: one summand of a model, linear in its amplitudes and not in its shape.
//
// A term is a type with only static members, so that one templated evaluation serves double,
// float, automatic derivatives and multi-precision:
//
//   static constexpr TermDescription description;
//   static constexpr std::array<Parameter, K> amplitudes;   // one value per channel each
//   static constexpr std::array<Parameter, P> shape;        // shared by all channels
//   template <class S, class D>
//   static std::array<S, K> basis(const std::array<S, P>& shape,
//                                 const Direction<D>& wi, const Direction<D>& wo);
//
// S is the scalar of the shape (and of the result), D that of the directions; f_r of the term is
// the sum of amplitude[k] * basis[k], in 1/sr.
#pragma once

#include <array>
#include <concepts>
#include <string_view>

#include "brdf/direction.h"
#include "brdf/parameter.h"

namespace gonio::brdf {

enum class TermKind { diffuse, specular };

struct TermDescription {
  std::string_view name;
  TermKind kind;
  /// The diffuse term that the term's author pairs it with; empty for a diffuse term.
  std::string_view companion;
  std::string_view summary;
  std::string_view source;
  /// True if turning the material about its normal changes the value: the term has a tangent,
  /// which may be given a free angle (free_frame.h).
  bool anisotropic = false;
};

template <class T>
concept Term = requires(const std::array<double, T::shape.size()>& shape,
                        const Direction<double>& direction) {
  { T::description } -> std::convertible_to<TermDescription>;
  {
    T::template basis<double, double>(shape, direction, direction)
    } -> std::same_as<std::array<double, T::amplitudes.size()>>;
};

}  // namespace gonio::brdf
