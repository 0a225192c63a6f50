// extremes: what double and float are worth where the models' formulas go wrong. The program behind
// bench/extremes and scripts/extremes.
//
// Exit status: 0 every figure reached, or bound by its model's condition, and the page true; 1 not;
// 2 wrong usage; 3 an unreadable page.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "bench/extremes_page.h"
#include "bench/extremes_report.h"
#include "bench/extremes_study.h"
#include "bench/finite_study.h"
#include "bench/study_main.h"

namespace gonio::bench {
namespace {

struct Settings {
  SweepSettings sweep;
  std::uint64_t evaluations = 0;
  bool markdown = false;
  std::string page;
};

int print_finite(const Settings& settings) {
  const std::vector<ModelFiniteness> models =
      count_unsound({settings.evaluations, settings.sweep.seed, settings.sweep.threads});
  fmt::print("unsound: NaN, infinity or negative\n{}", finite_table(models));
  return all_sound(models) ? 0 : 1;
}

int print_sweep(const std::vector<ModelErrors>& models, const SweepSettings& settings) {
  fmt::print("{} samples of each model in each region; those above {:g} of the peak count\n{}\n",
             settings.samples, lit_share, region_legend());
  for (const ModelErrors& model : models) fmt::print("{}\n", error_table(model));
  fmt::print("{}", figure_table(models));
  return all_figures_hold(models) ? 0 : 1;
}

int check(const std::string& page, const std::vector<ModelErrors>& models) {
  const std::vector<std::string> faults = faults_of_page(page, models);
  for (const std::string& fault : faults) fmt::print(stderr, "extremes: {}\n", fault);
  if (!faults.empty()) {
    fmt::print(stderr, "extremes: bench/extremes --update writes the page anew\n");
  } else {
    fmt::print("{}: {} models as stated\n", page, models.size());
  }
  return faults.empty() && all_figures_hold(models) ? 0 : 1;
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app{
      "Sweeps every model through the regions where its formula goes wrong and compares double "
      "and\n"
      "float, and the textbook's formula beside them, with 50 digits."};
  app.name("extremes");
  app.add_option("--samples", settings.sweep.samples, "Samples of each model in each region")
      ->check(CLI::Range(std::size_t(1), std::size_t(1'000'000)))
      ->capture_default_str();
  app.add_option("--seed", settings.sweep.seed, "Of the random draws")->capture_default_str();
  app.add_option("--threads", settings.sweep.threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  auto* finite =
      app.add_option("--finite", settings.evaluations,
                     "Count NaN, infinities and negative values in this many evaluations of each "
                     "model in double and in float instead")
          ->check(CLI::Range(std::uint64_t(1), std::uint64_t(1'000'000'000'000)));
  auto* markdown = app.add_flag("--markdown", settings.markdown, "Print docs/extremes.md instead");
  app.add_option("--check", settings.page, "Compare this page with what is measured instead")
      ->excludes(finite)
      ->excludes(markdown);
  finite->excludes(markdown);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "extremes: {} (--help says what there is)\n", error.what());
    return 2;
  }
  if (settings.evaluations > 0) return print_finite(settings);
  const std::vector<ModelErrors> models = sweep_extremes(settings.sweep);
  if (!settings.page.empty()) return check(settings.page, models);
  if (!settings.markdown) return print_sweep(models, settings.sweep);
  fmt::print("{}", page_text(models, stated_bounds(models)));
  return all_figures_hold(models) ? 0 : 1;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("extremes", gonio::bench::run, argc, argv);
}
