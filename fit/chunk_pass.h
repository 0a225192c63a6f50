// One pass over the samples, chunk by chunk, on several threads; the same bits for any number.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "fit/weighted_samples.h"
#include "table/parallel.h"

namespace gonio::fit {

struct PassOptions {
  int threads = 1;
  /// Called when a pass begins; what it returns is told the share of the pass that is done, by one
  /// thread at a time.
  std::function<std::function<void(double)>()> on_pass;
};

/// Folds every chunk into a state: make_state() begins a task, fold(chunk, state) adds a chunk that
/// is not empty, result_of(state) is what remains of it. A task is a number of consecutive
/// chunks that depends on the table alone, so that the order of all sums is fixed. Returns the
/// tasks' results in the table's order, at least one.
template <class MakeState, class Fold, class ResultOf>
auto chunk_pass(const WeightedSamples& samples, const PassOptions& options,
                const MakeState& make_state, const Fold& fold, const ResultOf& result_of) {
  using State = decltype(make_state());
  using Result = decltype(result_of(std::declval<State&>()));
  const std::size_t chunks = samples.chunk_count();
  // Few chunks make small tasks, so that all threads have some.
  const std::size_t chunks_per_task = std::clamp<std::size_t>(chunks / 8, 1, 8);
  const std::size_t tasks =
      std::max<std::size_t>((chunks + chunks_per_task - 1) / chunks_per_task, 1);
  const std::function<void(double)> on_share = options.on_pass ? options.on_pass() : nullptr;
  std::mutex share_mutex;
  std::size_t done = 0;
  std::vector<std::optional<Result>> optional_results(tasks);
  table::parallel_for(tasks, options.threads, [&](std::size_t task) {
    State state = make_state();
    SampleChunk chunk(samples.channel_count());
    const std::size_t last = std::min((task + 1) * chunks_per_task, chunks);
    for (std::size_t i = task * chunks_per_task; i < last; ++i) {
      samples.gather(i, chunk);
      if (chunk.directions.count > 0) fold(chunk, state);
    }
    optional_results[task].emplace(result_of(state));
    if (on_share) {
      const std::lock_guard lock(share_mutex);
      on_share(double(++done) / double(tasks));
    }
  });
  std::vector<Result> results;
  results.reserve(tasks);
  for (std::optional<Result>& result : optional_results) results.push_back(std::move(*result));
  return results;
}

}  // namespace gonio::fit
