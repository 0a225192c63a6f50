// What a term is: one summand of a model. It is a sum of basis functions, which depend on the
// shape, times coefficients, which depend on the amplitudes of a channel.
//
// A term is a type with only static members, so that one templated evaluation serves double,
// float, automatic derivatives and multi-precision:
//
//   static constexpr TermDescription description;
//   static constexpr std::array<Parameter, K> amplitudes;   // one value per channel each
//   static constexpr std::array<Parameter, P> shape;        // shared by all channels
//   template <class S, class D>
//   static std::array<S, B> basis(const std::array<S, P>& shape,
//                                 const Direction<D>& wi, const Direction<D>& wo);
//
// and, unless the coefficients are the amplitudes themselves (then B = K),
//
//   template <class S>
//   static std::array<S, B> coefficients(const std::array<S, K>& amplitudes);
//
// A term whose shape and amplitudes two materials may share f_r with says which the other one is:
//
//   static std::array<double, P> twin(const std::array<double, P>& shape,
//                                     const std::array<double, K>& amplitudes);
//
// S is the scalar of the shape (and of the result), D that of the directions; f_r of the term is
// the sum of coefficient[b] * basis[b], in 1/sr. Basis functions are finite and at least 0, and
// exactly 0 below the horizon.
#pragma once

#include <array>
#include <concepts>
#include <string_view>
#include <type_traits>

#include "brdf/direction.h"
#include "brdf/parameter.h"

namespace gonio::brdf {

/// `whole`: a model of its own, which no other term may be added to.
enum class TermKind { diffuse, specular, whole };

/// How the coefficients depend on the amplitudes.
enum class Coefficients { linear, affine, nonlinear };

struct TermDescription {
  std::string_view name;
  TermKind kind;
  /// The diffuse term that the term's author pairs it with; empty for one that is not specular.
  std::string_view companion;
  std::string_view summary;
  std::string_view source;
  /// What the summary is written with, where that is more than common.
  std::string_view symbols = {};
  /// True if turning the material about its normal changes the value: the term has a tangent,
  /// which may be given a free angle (free_frame.h). Its first two shape parameters are then those
  /// along x and along y.
  bool anisotropic = false;
  Coefficients coefficients = Coefficients::linear;
  /// False if exchanging wi and wo changes the value.
  bool reciprocal = true;
};

namespace term_detail {

template <class T>
concept HasCoefficients = requires(const std::array<double, T::amplitudes.size()>& amplitudes) {
  T::template coefficients<double>(amplitudes);
};

template <class T>
concept HasTwin = requires(const std::array<double, T::shape.size()>& shape,
                           const std::array<double, T::amplitudes.size()>& amplitudes) {
  T::twin(shape, amplitudes);
};

}  // namespace term_detail

/// The coefficients of the term's basis functions for the amplitudes of a channel.
template <class T, class S>
auto coefficients_of(const std::array<S, T::amplitudes.size()>& amplitudes) {
  if constexpr (term_detail::HasCoefficients<T>) {
    return T::template coefficients<S>(amplitudes);
  } else {
    return amplitudes;
  }
}

/// How many basis functions the term T has.
template <class T>
inline constexpr std::size_t basis_size = std::tuple_size_v<decltype(coefficients_of<T, double>(
    std::array<double, T::amplitudes.size()>{}))>;

template <class T>
concept Term = requires(const std::array<double, T::shape.size()>& shape,
                        const Direction<double>& direction) {
  { T::description } -> std::convertible_to<TermDescription>;
  {
    T::template basis<double, double>(shape, direction, direction)
    } -> std::same_as<std::array<double, basis_size<T>>>;
};

}  // namespace gonio::brdf
