#include "apps/gonio/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

namespace gonio::app {
namespace {

constexpr auto quiet_time = std::chrono::seconds(1);
constexpr auto redraw_time = std::chrono::milliseconds(100);
constexpr std::string_view clear_line = "\r\x1b[K";

std::string bar(double share) {
  constexpr int width = 30;
  const int filled = int(std::clamp(share, 0.0, 1.0) * width);
  return fmt::format("[{:=<{}}{:<{}}]", "", filled, "", width - filled);
}

}  // namespace

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)) {
  if (::isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { draw_until_stopped(); });
}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stop_.notify_all();
  thread_.join();
}

void ProgressLine::set(std::string what, double share) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
  share_ = share;
}

void ProgressLine::draw_until_stopped() {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  if (stop_.wait_for(lock, quiet_time, [this] { return stopped_; })) return;
  while (!stopped_) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const std::string line = fmt::format("{}{} {} {:.0f} s", clear_line, what_,
                                         share_ < 0 ? "..." : bar(share_), elapsed.count());
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
    stop_.wait_for(lock, redraw_time, [this] { return stopped_; });
  }
  std::fwrite(clear_line.data(), 1, clear_line.size(), stderr);
}

}  // namespace gonio::app
