// real_materials: every model fitted to every real material, as CSV and as Markdown.
//
// Exit status: 0 every fit converged, or with --check the page is right; 1 some did not, or it is
// not; 2 wrong usage; 3 a file that cannot be read; 77 no data.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measured_data.h"
#include "bench/real_materials_report.h"
#include "bench/real_materials_study.h"
#include "bench/study_main.h"
#include "table/input_file.h"
#include "table/output_file.h"

namespace gonio::bench {
namespace {

struct Settings {
  std::string folder = data_folder().string();
  std::string csv, markdown, check;
  std::string metric = "cosine-l2";
  std::vector<std::string> sources;
  std::size_t most = 0;  // materials of a source; 0: all
  double max_theta_deg = 80;
  int threads = 0;
};

std::vector<RealMaterial> chosen_materials(const Settings& settings) {
  std::vector<RealMaterial> chosen;
  std::string source;
  std::size_t count = 0;
  for (RealMaterial& material : real_materials(settings.folder)) {
    if (!settings.sources.empty() && std::find(settings.sources.begin(), settings.sources.end(),
                                               material.source) == settings.sources.end()) {
      continue;
    }
    count = material.source == source ? count + 1 : 1;
    source = material.source;
    if (settings.most == 0 || count <= settings.most) chosen.push_back(std::move(material));
  }
  return chosen;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// 0 if the page ends with the tables, behind the line that says so.
int check_page(const std::string& path, const std::string& tables) {
  constexpr std::string_view border = "<!-- real_materials -->\n\n";
  const table::InputFile file(path);
  const std::size_t at = file.bytes().find(border);
  if (at != std::string_view::npos && file.bytes().substr(at + border.size()) == tables) {
    fmt::print("{}: the tables are those of now\n", path);
    return 0;
  }
  fmt::print("{}: the tables differ from those of now, which follow\n\n{}", path, tables);
  return 1;
}

constexpr int no_data = 77;

int study(const Settings& settings) {
  const fit::Options options{.metric = fit::metric_from_name(settings.metric),
                             .max_theta_deg = settings.max_theta_deg,
                             .threads = settings.threads};
  std::vector<RealResult> results;
  bool all_converged = true;
  const std::vector<RealMaterial> materials = chosen_materials(settings);
  if (materials.empty()) {
    fmt::print(stderr,
               "real_materials: skipped: no measurement in {}: name the folder that holds paints, "
               "rgl, merl, curet, zemax with --data, or in GONIO_DATA\n",
               settings.folder);
    return no_data;
  }
  for (const RealMaterial& material : materials) {
    const auto start = std::chrono::steady_clock::now();
    results.push_back(fit_every_model(material, options));
    const RealResult& result = results.back();
    for (const RealFit& fit : result.fits) {
      if (fit.converged) continue;
      all_converged = false;
      fmt::print(stderr, "{} {}: {} did not converge\n", result.source, result.name, fit.model);
    }
    if (!result.problem.empty()) fmt::print(stderr, "{}\n", result.problem);
    fmt::print(stderr, "{} {}: {} samples, {} models, best {}, {:.1f} s\n", result.source,
               result.name, result.used, result.fits.size(),
               result.fits.empty() ? "-" : result.fits.front().model, seconds_since(start));
  }
  if (!settings.csv.empty()) table::write_file(settings.csv, real_materials_csv(results));
  const std::string markdown = real_materials_markdown(results, settings.metric);
  if (!settings.markdown.empty()) table::write_file(settings.markdown, markdown);
  if (!settings.check.empty()) return check_page(settings.check, markdown);
  fmt::print("{}", markdown);
  return all_converged ? 0 : 1;
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app{"Every model fitted to every real material: the error of each."};
  app.name("real_materials");
  app.add_option("--data", settings.folder, "The folder of measurements; else $GONIO_DATA")
      ->capture_default_str();
  app.add_option("--csv", settings.csv, "Write material, model, metric, error as CSV");
  app.add_option("--markdown", settings.markdown, "Write the tables that are printed to a file");
  app.add_option("--check", settings.check, "Compare a page's tables with those of this run");
  app.add_option("--metric", settings.metric, "What the fits minimise")->capture_default_str();
  app.add_option("--max-theta", settings.max_theta_deg, "Up to this polar angle, in degrees")
      ->capture_default_str();
  app.add_option("--source", settings.sources, "Only these folders, such as paints or rgl");
  app.add_option("--most", settings.most, "At most so many materials of a folder; 0: all")
      ->capture_default_str();
  app.add_option("--threads", settings.threads, "0: all")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "real_materials: {} (--help says what there is)\n", error.what());
    return 2;
  }
  return study(settings);
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("real_materials", gonio::bench::run, argc, argv);
}
