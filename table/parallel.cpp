#include "table/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

namespace gonio::table {

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
  if (threads == 1 || count < 2) {
    for (std::size_t i = 0; i < count; ++i) task(i);
    return;
  }
  // TBB grants more threads than the machine has only to whom asks beforehand.
  std::optional<tbb::global_control> more_threads;
  if (threads > tbb::info::default_concurrency()) {
    more_threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  }
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { task(i); }); });
}

}  // namespace gonio::table
