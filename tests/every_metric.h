// Every metric and every loss, and what a test of a pair of them is called.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <tuple>

#include "fit/options.h"

namespace gonio::tests {

inline constexpr std::array all_metrics{fit::Metric::l2,       fit::Metric::cosine_l2,
                                        fit::Metric::log,      fit::Metric::cube_root,
                                        fit::Metric::relative, fit::Metric::chi2};
inline constexpr std::array all_losses{fit::Loss::none, fit::Loss::huber, fit::Loss::cauchy,
                                       fit::Loss::tukey};

/// "cube_root_tukey", of a metric and a loss in either order.
template <class A, class B>
std::string name_of(const testing::TestParamInfo<std::tuple<A, B>>& instance) {
  std::string name(fit::name(std::get<0>(instance.param)));
  name += "_" + std::string(fit::name(std::get<1>(instance.param)));
  for (char& c : name) {
    if (c == '-') c = '_';
  }
  return name;
}

}  // namespace gonio::tests
