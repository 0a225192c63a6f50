// What a project that uses gonio as a library looks like; tests/outside_project/run builds it.
#include <cstdio>

#include "fit/fit.h"
#include "table/read.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const gonio::table::SampleTable table = gonio::table::read(argv[1]);
  const auto result = gonio::fit::fit(gonio::brdf::Model("ward-aniso"), table, {});
  std::printf("%s: alpha_x %.3f, alpha_y %.3f\n", table.name.c_str(), result.values.shape[0],
              result.values.shape[1]);
}
