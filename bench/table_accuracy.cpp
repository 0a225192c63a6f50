// table_accuracy: prints the two tables of docs/lut.md that say how far look-up tables are from
// what they hold, in Markdown.
//
// Exit status: 0; 2 wrong usage.
#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "bench/study_main.h"
#include "bench/table_accuracy_study.h"

namespace gonio::bench {
namespace {

int run(int argc, char** argv) {
  CLI::App app{"The errors of look-up tables, as docs/lut.md states them."};
  app.name("table_accuracy");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "table_accuracy: {} (--help says what there is)\n", error.what());
    return 2;
  }
  fmt::print(
      "Ward's numerator by 512 texels, each table for its alpha; the largest error, as a fraction "
      "of the peak:\n\n{}\n"
      "Tables of two axes; the largest error, the lobes' as a fraction of the peak:\n\n{}",
      markdown_of(accuracy_of_one_lobe()), markdown_of(accuracy_of_two_axes()));
  return 0;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("table_accuracy", gonio::bench::run, argc, argv);
}
