#include "bench/real_materials_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace gonio::bench {
namespace {

/// The sources in the order of the results.
std::vector<std::string> sources_of(const std::vector<RealResult>& results) {
  std::vector<std::string> sources;
  for (const RealResult& result : results) {
    if (std::find(sources.begin(), sources.end(), result.source) == sources.end()) {
      sources.push_back(result.source);
    }
  }
  return sources;
}

std::size_t count_of(const std::vector<RealResult>& results, const std::string& source) {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(),
                    [&](const RealResult& result) { return result.source == source; }));
}

void add_tally(std::string& text, const std::vector<ModelTally>& tallies) {
  text +=
      "| model | materials | best on | error over the best, mean | worst "
      "|\n|---|---|---|---|---|\n";
  for (const ModelTally& tally : tallies) {
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {:.3f} | {:.2f} |\n", tally.model,
                   tally.materials, tally.best, tally.mean_ratio, tally.worst_ratio);
  }
}

const RealFit* fit_of(const RealResult& result, const std::string& model) {
  const auto found = std::find_if(result.fits.begin(), result.fits.end(),
                                  [&](const RealFit& fit) { return fit.model == model; });
  return found == result.fits.end() ? nullptr : &*found;
}

/// A row per model, a column per material would be too wide: materials are rows.
void add_errors(std::string& text, const std::vector<RealResult>& results,
                const std::string& source, const std::vector<ModelTally>& tallies,
                const std::string& metric) {
  text += "\n| material |";
  for (const ModelTally& tally : tallies) text += fmt::format(" {} |", tally.model);
  text += "\n|---|";
  for (std::size_t i = 0; i < tallies.size(); ++i) text += "---|";
  text += '\n';
  for (const RealResult& result : results) {
    if (result.source != source) continue;
    text += fmt::format("| {} |", result.name);
    if (result.fits.empty()) {
      text += " no sample within the polar angles |\n";
      continue;
    }
    for (const ModelTally& tally : tallies) {
      const RealFit* fit = fit_of(result, tally.model);
      if (fit == nullptr) {
        text += " |";
        continue;
      }
      const bool is_best = fit == &result.fits.front();
      const std::string error = fmt::format("{:.3g}", error_under(*fit, metric));
      text += fmt::format(" {}{} |", is_best ? fmt::format("**{}**", error) : error,
                          fit->converged ? "" : " (not converged)");
    }
    text += '\n';
  }
}

}  // namespace

std::string real_materials_csv(const std::vector<RealResult>& results) {
  std::string text = "source,material,samples,used,model,rank,converged,metric,error\n";
  for (const RealResult& result : results) {
    for (std::size_t rank = 0; rank < result.fits.size(); ++rank) {
      const RealFit& fit = result.fits[rank];
      for (const auto& [metric, error] : fit.errors) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", result.source,
                       result.name, result.samples, result.used, fit.model, rank + 1, fit.converged,
                       metric, error);
      }
    }
  }
  return text;
}

std::string real_materials_markdown(const std::vector<RealResult>& results,
                                    const std::string& metric) {
  std::string text;
  for (const std::string& source : sources_of(results)) {
    const std::vector<ModelTally> tallies = tally(results, source, metric);
    const std::size_t count = count_of(results, source);
    fmt::format_to(std::back_inserter(text), "{}## {}: {} material{}\n\n", text.empty() ? "" : "\n",
                   source, count, count == 1 ? "" : "s");
    add_tally(text, tallies);
    add_errors(text, results, source, tallies, metric);
  }
  return text;
}

}  // namespace gonio::bench
