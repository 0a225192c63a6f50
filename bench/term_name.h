// What a study calls a term.
#pragma once

#include <string>

#include "brdf/term.h"

namespace gonio::bench {

/// The name; with a plus sign before it where a model of the same name is more than this summand.
template <class T>
std::string study_name() {
  const bool is_summand_of_namesake = T::description.kind == brdf::TermKind::specular &&
                                      T::description.coefficients == brdf::Coefficients::affine;
  return (is_summand_of_namesake ? "+" : "") + std::string(T::description.name);
}

}  // namespace gonio::bench
