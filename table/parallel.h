// Running numbered tasks on a given number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace gonio::table {

/// Calls task(i) for i in [0, count) on up to `threads` threads (0: as many as the machine has) and
/// waits for all; an exception of a task is passed on. For results that do not depend on the number
/// of threads, each task writes to its own place.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace gonio::table
