#include "fit/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>
#include <string>

#include "brdf/pack.h"
#include "fit/median.h"
#include "table/file_error.h"
#include "table/parallel.h"

namespace gonio::fit {
namespace {

constexpr std::size_t rows_per_task = 8192;

Survey survey_of_rows(const table::SampleTable& table, const table::SampleFilter& filter,
                      std::size_t first, std::size_t last) {
  Survey survey;
  std::vector<std::uint8_t> used(last - first);
  for (std::size_t i = first; i < last; ++i) {
    used[i - first] = filter(i);
    survey.used_samples += used[i - first];
    if (used[i - first] != 0 && table.wi[i].z < survey.most_grazing_wi.z) {
      survey.most_grazing_wi = table.wi[i];
    }
  }
  for (const std::vector<double>& channel : table.values) {
    std::size_t measured = 0;
    double largest = 0;
    for (std::size_t i = first; i < last; ++i) {
      const bool counts = used[i - first] != 0 && !std::isnan(channel[i]);
      measured += counts;
      const double magnitude = counts ? std::abs(channel[i]) : 0;
      largest = magnitude > largest ? magnitude : largest;
    }
    survey.used_values += measured;
    survey.channel_values.push_back(measured);
    survey.holes += survey.used_samples - measured;
    survey.largest = std::max(survey.largest, largest);
  }
  if (table.has_weight()) {
    for (std::size_t i = first; i < last; ++i) {
      if (used[i - first] != 0)
        survey.largest_weight = std::max(survey.largest_weight, table.weight[i]);
    }
  }
  return survey;
}

[[noreturn]] void refuse_empty(const table::SampleTable& table) {
  std::array<std::size_t, table::mask_reason_count> masked{};
  for (const table::MaskReason reason : table.mask) ++masked[std::size_t(reason)];
  std::string reasons;
  for (std::size_t r = 1; r < masked.size(); ++r) {
    if (masked[r] == 0) continue;
    reasons += fmt::format(", {} masked as {}", masked[r], name(table::MaskReason(r)));
  }
  throw table::FileError(fmt::format(
      "{}: no sample left to fit: of {} samples{}, {} lie beyond the largest polar angle or have "
      "the weight 0; check the table with 'gonio info', or raise --max-theta",
      table.provenance.path, table.size(), reasons, masked[0]));
}

}  // namespace

Survey survey_of(const table::SampleTable& table, const table::SampleFilter& filter, int threads) {
  const std::size_t tasks = (table.size() + rows_per_task - 1) / rows_per_task;
  std::vector<Survey> parts(tasks);
  table::parallel_for(tasks, threads, [&](std::size_t task) {
    const std::size_t first = task * rows_per_task;
    parts[task] =
        survey_of_rows(table, filter, first, std::min(first + rows_per_task, table.size()));
  });
  Survey survey;
  survey.channel_values.resize(table.values.size());
  if (!table.has_weight()) survey.largest_weight = 1;
  for (const Survey& part : parts) {
    survey.used_samples += part.used_samples;
    survey.used_values += part.used_values;
    survey.holes += part.holes;
    for (std::size_t c = 0; c < survey.channel_values.size(); ++c) {
      survey.channel_values[c] += part.channel_values[c];
    }
    survey.largest = std::max(survey.largest, part.largest);
    survey.largest_weight = std::max(survey.largest_weight, part.largest_weight);
    if (part.most_grazing_wi.z < survey.most_grazing_wi.z) {
      survey.most_grazing_wi = part.most_grazing_wi;
    }
  }
  if (survey.used_samples == 0) refuse_empty(table);
  if (survey.largest != 0 && (survey.largest < 1e-100 || survey.largest > 1e100)) {
    throw table::FileError(
        fmt::format("{}: the largest magnitude of f_r is {:.3g} 1/sr, which no material has; "
                    "values between 1e-100 and 1e100 can be fitted: check the table's unit and "
                    "quantity",
                    table.provenance.path, survey.largest));
  }
  return survey;
}

namespace {

/// The size of the sample that brackets the median: a share of the table, within limits.
std::size_t bracket_sample(std::size_t values) {
  return std::clamp<std::size_t>(values / 64, 1024, 16384);
}

/// A floor matters to the few values below it only.
constexpr double floor_tolerance = 1e-4;

MedianSearch search_near_sample(const std::vector<double>& channel,
                                const table::SampleFilter& filter) {
  const std::size_t step =
      std::max<std::size_t>(channel.size() / bracket_sample(channel.size()), 1);
  std::vector<double> sample;
  for (std::size_t i = step / 2; i < channel.size(); i += step) {
    if (std::abs(channel[i]) > 0 && filter(i)) sample.push_back(std::abs(channel[i]));
  }
  if (sample.empty()) return {0, 0, floor_tolerance};
  const auto quantile = [&](double share) {
    const auto place = sample.begin() + std::ptrdiff_t(share * double(sample.size() - 1));
    std::nth_element(sample.begin(), place, sample.end());
    return *place;
  };
  // 5 standard deviations of the sample's median: but for one table in millions the median lies
  // there, and then it takes more rounds to find.
  const double half = std::min(2.5 / std::sqrt(double(sample.size())), 0.5);
  return {quantile(0.5 - half), quantile(0.5 + half), floor_tolerance};
}

/// The magnitude of each value that is used and measured, else 0.
GONIO_FOR_EACH_CPU void write_magnitudes(const double* values, const std::uint8_t* used,
                                         std::size_t count, double* magnitudes) {
  for (std::size_t r = 0; r < count; ++r) {
    const double magnitude = std::abs(values[r]);
    // False for a hole.
    magnitudes[r] = used[r] != 0 && magnitude > 0 ? magnitude : 0;
  }
}

/// One round of the searches, over a task's rows.
void count_rows(const table::SampleTable& table, const table::SampleFilter& filter,
                std::size_t first, std::size_t last, std::span<const MedianSearch> searches,
                std::span<MedianSearch::Counts> counts) {
  constexpr std::size_t block = 512;
  std::array<std::uint8_t, block> used;
  std::array<double, block> magnitudes;
  for (std::size_t start = first; start < last; start += block) {
    const std::size_t size = std::min(block, last - start);
    for (std::size_t r = 0; r < size; ++r) used[r] = filter(start + r);
    for (std::size_t c = 0; c < searches.size(); ++c) {
      if (searches[c].done()) continue;
      write_magnitudes(table.values[c].data() + start, used.data(), size, magnitudes.data());
      counts[c].add(std::span(magnitudes).first(size), false);
    }
  }
}

}  // namespace

std::vector<double> relative_floors(const table::SampleTable& table,
                                    const table::SampleFilter& filter, int threads) {
  std::vector<MedianSearch> searches(table.channels.size(), {0, 0, floor_tolerance});
  table::parallel_for(searches.size(), threads, [&](std::size_t c) {
    searches[c] = search_near_sample(table.values[c], filter);
  });
  const std::size_t tasks = (table.size() + rows_per_task - 1) / rows_per_task;
  std::mutex mutex;
  const auto is_done = [](const MedianSearch& search) { return search.done(); };
  while (!std::all_of(searches.begin(), searches.end(), is_done)) {
    table::parallel_for(tasks, threads, [&](std::size_t task) {
      std::vector<MedianSearch::Counts> counts;
      for (const MedianSearch& search : searches) counts.push_back(search.counts());
      count_rows(table, filter, task * rows_per_task,
                 std::min((task + 1) * rows_per_task, table.size()), searches, counts);
      const std::lock_guard lock(mutex);
      for (std::size_t c = 0; c < searches.size(); ++c) searches[c].add(counts[c]);
    });
    for (MedianSearch& search : searches) {
      if (!search.done()) search.end_round();
    }
  }
  std::vector<double> floors;
  for (const MedianSearch& search : searches) {
    floors.push_back(search.value() > 0 ? 0.01 * search.value() : 1e300);
  }
  return floors;
}

}  // namespace gonio::fit
