// ngan_ranking: does Ngan, Durand and Matusik's ranking of models hold on other materials than
// theirs, such as 22 paints?
//
// Exit status: 0 answered, whatever the answer; 2 wrong usage; 3 an unusable table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/measured_data.h"
#include "bench/ngan_study.h"
#include "bench/study_main.h"
#include "table/read.h"

namespace gonio::bench {
namespace {

/// The first two are Ngan's own metric, on the samples as they are and with its solid angles.
constexpr std::array<View, 4> views{
    {{"cosine-l2", fit::Metric::cosine_l2, false},
     {"cosine-l2, samples weighted by solid angle", fit::Metric::cosine_l2, true},
     {"cube-root", fit::Metric::cube_root, false},
     {"log", fit::Metric::log, false}}};

struct Settings {
  std::vector<std::string> paths;
  double max_theta_deg = 80;
  int threads = 0;
};

/// The files that a path stands for: itself, or those of a folder with the ending .astm.
std::vector<std::string> files_of(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() == ".astm") files.push_back(entry.path().string());
  }
  if (files.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: a folder without .astm files: name tables, or another folder", path));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<table::SampleTable> read_tables(const Settings& settings) {
  std::vector<table::SampleTable> tables;
  for (const std::string& path : settings.paths) {
    for (const std::string& file : files_of(path)) {
      tables.push_back(table::read(file, {.threads = settings.threads}));
      tables.back().name = std::filesystem::path(file).stem().string();
    }
  }
  return tables;
}

std::string letters(const std::vector<std::size_t>& order, std::string_view between) {
  std::vector<char> names;
  for (const std::size_t c : order) names.push_back(contenders[c].letter);
  return fmt::format("{}", fmt::join(names, between));
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.6f}", *value) : "-";
}

void print_materials(const std::vector<Ranked>& materials) {
  fmt::print("{:<22} {:>6}", "material", "used");
  for (const Contender& contender : contenders) fmt::print(" {:>9}", contender.letter);
  fmt::print("  order\n");
  for (const Ranked& material : materials) {
    fmt::print("{:<22} {:>6}", material.material, material.used);
    for (const auto& error : material.errors) fmt::print(" {:>9}", number(error));
    fmt::print("  {}{}\n", letters(order_of(material.errors), " "),
               material.all_converged ? "" : "  (a fit did not converge)");
  }
  const auto pooled = pooled_errors(materials);
  fmt::print("{:<29}", "relative to the least");
  for (const auto& error : pooled)
    fmt::print(" {:>9}", error ? fmt::format("{:.4f}", *error) : "-");
  fmt::print("  {}\n", letters(order_of(pooled), " "));
}

/// "holds on 22 of 22".
std::string share(std::size_t count, std::size_t all) {
  return fmt::format("holds on {} of {}", count, all);
}

void print_tallies(const std::vector<Ranked>& materials) {
  const std::size_t all = materials.size();
  const RankingTally any = tally_ranking(materials, 1);
  fmt::print("D < W {}, W < B {}\n", share(any.ward_duer_before_ward, all),
             share(any.ward_before_blinn_phong, all));
  const auto pooled = pooled_errors(materials);
  for (std::size_t form = 0; form < ashikhmin_shirley_forms; ++form) {
    if (!pooled[form]) continue;
    const char letter = contenders[form].letter;
    const RankingTally tally = tally_ranking(materials, form);
    const bool holds = *pooled[form] < *pooled[ward_duer] && *pooled[ward_duer] < *pooled[ward] &&
                       *pooled[ward] < *pooled[blinn_phong];
    fmt::print("{} < D {}, {} < D < W < B {}, and {} for the mean of all\n", letter,
               share(tally.before_ward_duer, all), letter, share(tally.all, all),
               holds ? "holds" : "does not hold");
  }
}

/// What a run under Ngan's own metric answers.
std::string verdict(const std::vector<Ranked>& materials) {
  const RankingTally tally = tally_ranking(materials, ngan_form);
  const std::size_t all = materials.size();
  const auto order = order_of(pooled_errors(materials));
  std::vector<std::size_t> ranking;
  std::copy_if(order.begin(), order.end(), std::back_inserter(ranking),
               [](std::size_t c) { return c == ngan_form || c >= ward_duer; });
  return fmt::format(
      "Ashikhmin-Shirley in Ngan's form < Ward-Duer < Ward < Blinn-Phong: material by material on "
      "{} of {}; in the mean the order is {}: the ranking {}",
      tally.all, all, letters(ranking, " < "),
      letters(ranking, "") == "NDWB" ? "holds" : "does not hold");
}

void run_views(const std::vector<table::SampleTable>& tables, const Settings& settings) {
  for (const Contender& contender : contenders) {
    fmt::print("{}  {}\n", contender.letter, contender.name);
  }
  fmt::print(
      "Each material's fits under each metric, to angles up to {} deg; N only under "
      "cosine-l2\n\n",
      settings.max_theta_deg);
  std::vector<std::string> verdicts;
  for (const View& view : views) {
    std::vector<Ranked> materials;
    for (const table::SampleTable& table : tables) {
      materials.push_back(rank(table, view, settings.max_theta_deg, settings.threads));
    }
    fmt::print("{}\n", view.name);
    print_materials(materials);
    print_tallies(materials);
    fmt::print("\n");
    if (view.metric == fit::Metric::cosine_l2) {
      verdicts.push_back(fmt::format("{}: {}", view.name, verdict(materials)));
    }
  }
  fmt::print("{}\n", fmt::join(verdicts, "\n"));
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app{
      "Fits the models of Ngan, Durand & Matusik 2005 to each table and compares their errors "
      "with\n"
      "the ranking that they found."};
  app.name("ngan_ranking");
  app.add_option("TABLE", settings.paths,
                 "Tables, or folders of .astm files; without: the paints in the data folder");
  app.add_option("--max-theta", settings.max_theta_deg,
                 "Samples with a larger polar angle are left out")
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
    fmt::print(stderr, "ngan_ranking: {} (--help says what there is)\n", error.what());
    return 2;
  }
  if (settings.paths.empty()) settings.paths.push_back((data_folder() / "paints").string());
  run_views(read_tables(settings), settings);
  return 0;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("ngan_ranking", gonio::bench::run, argc, argv);
}
