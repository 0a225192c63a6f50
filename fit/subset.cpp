#include "fit/subset.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "table/parallel.h"

namespace gonio::fit {
namespace {

/// Runs end where a block of rows does, so that blocks do not depend on each other.
constexpr std::size_t rows_per_block = 32768;

struct Chosen {
  std::size_t sample;
  double weight;
};

double brightness(const table::SampleTable& table, std::size_t i) {
  double sum = 0;
  for (const std::vector<double>& channel : table.values) {
    if (!std::isnan(channel[i])) sum += std::abs(channel[i]);
  }
  return sum * table.wi.z[i];
}

/// Chooses from runs of `length` used samples.
class RunChooser {
 public:
  RunChooser(const table::SampleTable& table, std::size_t length, std::size_t first_run)
      : table_(table), length_(length), run_number_(first_run) {}

  void add(std::size_t sample) {
    const double bright = brightness(table_, sample);
    if (run_.empty() || bright > brightest_) {
      brightest_ = bright;
      brightest_place_ = run_.size();
    }
    run_.push_back(sample);
    if (run_.size() == length_) end_run();
  }

  std::vector<Chosen> chosen() {
    if (!run_.empty()) end_run();
    return std::move(chosen_);
  }

 private:
  void end_run() {
    ++run_number_;
    chosen_.push_back({run_[brightest_place_], 1});
    if (run_.size() > 1) {
      // The golden ratio's multiples spread over the runs evenly and without a period.
      const double spread = std::fmod(double(run_number_) * 0.6180339887498949, 1.0);
      const std::size_t others = run_.size() - 1;
      std::size_t place = std::size_t(spread * double(others));
      if (place >= brightest_place_) ++place;
      chosen_.push_back({run_[place], double(others)});
    }
    run_.clear();
  }

  const table::SampleTable& table_;
  std::size_t length_;
  std::size_t run_number_;
  std::vector<std::size_t> run_;
  double brightest_ = 0;
  std::size_t brightest_place_ = 0;
  std::vector<Chosen> chosen_;
};

}  // namespace

table::SampleTable representative_subset(const table::SampleTable& table,
                                         const table::SampleFilter& filter,
                                         std::size_t used_samples, std::size_t count, int threads) {
  // A run gives two samples.
  const std::size_t length =
      used_samples <= count ? 1 : (2 * used_samples + count - 1) / std::max<std::size_t>(count, 1);
  std::vector<std::vector<Chosen>> blocks((table.size() + rows_per_block - 1) / rows_per_block);
  table::parallel_for(blocks.size(), threads, [&](std::size_t b) {
    const std::size_t first = b * rows_per_block;
    RunChooser chooser(table, length, first / length);
    for (std::size_t i = first; i < std::min(first + rows_per_block, table.size()); ++i) {
      if (filter(i)) chooser.add(i);
    }
    blocks[b] = chooser.chosen();
  });

  table::SampleTable subset;
  subset.channels = table.channels;
  subset.provenance = table.provenance;
  subset.values.resize(table.values.size());
  subset.sigma.resize(table.sigma.size());
  for (const std::vector<Chosen>& block : blocks) {
    for (const auto& [i, weight] : block) {
      subset.wi.push_back(table.wi[i]);
      subset.wo.push_back(table.wo[i]);
      for (std::size_t c = 0; c < table.values.size(); ++c) {
        subset.values[c].push_back(table.values[c][i]);
      }
      for (std::size_t c = 0; c < table.sigma.size(); ++c) {
        subset.sigma[c].push_back(table.sigma[c][i]);
      }
      subset.mask.push_back(table::MaskReason::none);
      subset.weight.push_back(weight * (table.has_weight() ? table.weight[i] : 1));
    }
  }
  return subset;
}

}  // namespace gonio::fit
