// A progress line on stderr for whatever lasts over a second; nothing unless stderr is a terminal.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace gonio::app {

class ProgressLine {
 public:
  /// Starts to count the time for `what`, e.g. "reading brass.csv".
  explicit ProgressLine(std::string what);
  /// Clears the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// From any thread: what is done now, and the share of it that is done (0..1; negative: unknown).
  void set(std::string what, double share);

 private:
  void draw_until_stopped();

  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopped_ = false;
  std::string what_;
  double share_ = -1;
  std::thread thread_;
};

}  // namespace gonio::app
