// curet: Oren and Nayar's models beside Lambert's on CUReT's 61 rough materials.
//
// Exit status: 0 oren-nayar is at least as good as lambert, which it contains, on every material;
// 1 it is not; 2 wrong usage; 3 no such data.
#include "table/formats/curet.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/curet_study.h"
#include "bench/measured_data.h"
#include "bench/study_main.h"

namespace gonio::bench {
namespace {

/// Indices into rough_models.
constexpr std::size_t lambert = 0;
constexpr std::size_t simplified = 1;
constexpr std::size_t full = 2;

constexpr std::array metrics{fit::Metric::l2, fit::Metric::cosine_l2};

struct Settings {
  std::string folder;
  double max_theta_deg = 90;
  int threads = 0;
};

std::string degrees(const std::optional<double>& angle) {
  return angle ? fmt::format("{:.2f}", *angle * 180 / std::numbers::pi) : "-";
}

void print_materials(const std::vector<RoughMaterial>& materials) {
  fmt::print("{:<10} {:>4} {:>9} {:>10} {:>15} {:>7} {:>7} {:>7} {:>7} {:>7}\n", "material", "used",
             rough_models[lambert], rough_models[simplified], rough_models[full], "on/la", "sigma",
             "+-", "sigma_f", "+-");
  for (const RoughMaterial& material : materials) {
    const auto& fits = material.fits;
    fmt::print("{:<10} {:>4} {:>9.5f} {:>10.5f} {:>15.5f} {:>7.4f} {:>7} {:>7} {:>7} {:>7}\n",
               material.name, material.used, fits[lambert].error, fits[simplified].error,
               fits[full].error, fits[simplified].error / fits[lambert].error,
               degrees(fits[simplified].sigma), degrees(fits[simplified].sigma_stddev),
               degrees(fits[full].sigma), degrees(fits[full].sigma_stddev));
  }
}

void print_comparison(const std::vector<RoughMaterial>& materials, std::size_t model,
                      std::size_t reference) {
  const Tally count = tally(materials, model, reference);
  fmt::print(
      "{} beside {}: better on {}, as good on {}, worse on {}; its error is {:.3f} times as "
      "large (geometric mean)\n",
      rough_models[model], rough_models[reference], count.better, count.equal, count.worse,
      geometric_mean_ratio(materials, model, reference));
}

/// True if oren-nayar is never worse than lambert.
bool report(const std::vector<table::SampleTable>& tables, fit::Metric metric,
            const Settings& settings) {
  const std::vector<RoughMaterial> materials =
      study_roughness(tables, metric, settings.max_theta_deg, settings.threads);
  fmt::print(
      "metric {}, angles up to {} deg: root mean square errors in 1/sr; sigma in deg with "
      "its standard deviation, of oren-nayar and (sigma_f) of oren-nayar-full\n",
      name(metric), settings.max_theta_deg);
  print_materials(materials);
  print_comparison(materials, full, simplified);
  print_comparison(materials, full, lambert);
  print_comparison(materials, simplified, lambert);
  const std::size_t worse = tally(materials, simplified, lambert).worse;
  fmt::print("{}: oren-nayar, which contains lambert, is at least as good on {} of {}\n\n",
             worse == 0 ? "reached" : "NOT REACHED", materials.size() - worse, materials.size());
  return worse == 0;
}

int run(int argc, char** argv) {
  Settings settings;
  settings.folder = (data_folder() / "curet").string();
  CLI::App app{"Fits lambert, oren-nayar and oren-nayar-full to CUReT's materials."};
  app.name("curet");
  app.add_option("FOLDER", settings.folder, "The folder of abrdf.dat and table.txt")
      ->capture_default_str();
  app.add_option(
         "--max-theta", settings.max_theta_deg,
         "Samples with a larger polar angle are left out; the data end at 83.9 deg, measured")
      ->check(CLI::Range(0, 90))
      ->capture_default_str();
  app.add_option("--threads", settings.threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "curet: {} (--help says what there is)\n", error.what());
    return 2;
  }
  const std::filesystem::path folder(settings.folder);
  const std::vector<table::SampleTable> tables =
      table::read_curet({.measurements = folder / "abrdf.dat", .directions = folder / "table.txt"});
  bool is_reached = true;
  for (const fit::Metric metric : metrics) {
    is_reached = report(tables, metric, settings) && is_reached;
  }
  return is_reached ? 0 : 1;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("curet", gonio::bench::run, argc, argv);
}
