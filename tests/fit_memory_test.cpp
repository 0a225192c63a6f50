// The memory of a fit is the table plus a constant.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

/// A field of /proc/self/status in MiB, or -1 where the system has none.
double status_mib(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(field + ":")) return std::stod(line.substr(field.size() + 1)) / 1024;
  }
  return -1;
}

/// Lets the peak of the resident memory begin anew; false where the system cannot.
bool reset_peak() {
  std::ofstream references("/proc/self/clear_refs");
  references << "5";
  references.flush();
  return bool(references);
}

TEST(TheMemoryOfAFit, DoesNotGrowWithTheTable) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer's own memory would be measured";
#endif
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.channels = {"R", "G", "B"};
  recipe.parameters["rho_d"] = {0.1, 0.2, 0.3};
  recipe.parameters["rho_s"] = {0.33, 0.2, 0.1};
  recipe.hemisphere = {.theta_step_deg = 1, .phi_step_deg = 1.5};
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 3};
  const table::SampleTable table = instrument::synthesize(recipe);
  ASSERT_GT(table.size(), 300'000U);  // 22 MB of directions and values
  if (!reset_peak()) GTEST_SKIP() << "this system cannot reset the peak of resident memory";
  const double before = status_mib("VmRSS");
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {.threads = 2});
  const double growth = status_mib("VmHWM") - before;
  EXPECT_TRUE(result.converged);
  // A copy of the directions alone would take 14 MB; a Jacobian of all residuals 60 MB.
  EXPECT_LE(growth, 10);
  std::printf("a fit of %zu samples x 3 channels took %.1f MiB beside its table\n", table.size(),
              growth);
}

}  // namespace
}  // namespace gonio::tests
