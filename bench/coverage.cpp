// gonio_coverage: are the error bars honest? The program behind bench/coverage.
//
// Exit status: 0 every figure reached; 1 one is missed; 2 wrong usage; 3 an unusable recipe.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/coverage_report.h"
#include "bench/cramer_rao.h"
#include "bench/study_main.h"
#include "table/json_file.h"

namespace gonio::bench {
namespace {

constexpr std::array estimators{known_sigma, noise_not_told};

struct Settings {
  std::vector<std::string> recipes;
  std::size_t seeds = fits_of_the_figures;
  int threads = 0;
  bool json = false;
};

/// The materials under each estimator, [estimator][material].
using Study = std::array<std::vector<MaterialCoverage>, estimators.size()>;

Study study(const Settings& settings) {
  Study materials;
  for (const std::string& path : settings.recipes) {
    const instrument::Recipe recipe = instrument::read_recipe(path);
    const std::vector<double> bounds = cramer_rao_bounds(recipe);
    fmt::print(stderr, "coverage: {}\n", recipe.name);
    for (std::size_t e = 0; e < estimators.size(); ++e) {
      materials[e].push_back(
          study_coverage(recipe, bounds, estimators[e], settings.seeds, settings.threads));
    }
  }
  return materials;
}

void print_text(const Study& materials) {
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    fmt::print("{}\n", parameter_table(estimators[e], materials[e]));
  }
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    fmt::print("{}", figure_lines(estimators[e], materials[e]));
  }
}

void print_json(const Study& materials) {
  nlohmann::ordered_json json;
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    json["studies"].push_back(to_json(estimators[e], materials[e]));
  }
  fmt::print("{}", table::json_text(json));
}

bool all_reached(const Study& materials) {
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    const std::vector<FigureCheck> checks = check_figures(estimators[e], sum_up(materials[e]));
    if (!std::all_of(checks.begin(), checks.end(), [](const auto& c) { return c.reached; })) {
      return false;
    }
  }
  return true;
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app{
      "Measures each recipe's material many times with fresh noise, fits it each time, and\n"
      "compares the errors with their Cramer-Rao bounds and the 95 % intervals with the truth."};
  app.name("gonio_coverage");
  app.add_option("RECIPE", settings.recipes, "Materials and instruments (JSON), with noise")
      ->required();
  app.add_option("--seeds", settings.seeds,
                 "Fits of each material; with fewer than 2,000 the figures scatter more")
      ->check(CLI::Range(std::size_t(1), std::size_t(1'000'000)))
      ->capture_default_str();
  app.add_option("--threads", settings.threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_flag("--json", settings.json, "The result as JSON on stdout");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "gonio_coverage: {} (--help says what there is)\n", error.what());
    return 2;
  }
  const Study materials = study(settings);
  settings.json ? print_json(materials) : print_text(materials);
  return all_reached(materials) ? 0 : 1;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("gonio_coverage", gonio::bench::run, argc, argv);
}
