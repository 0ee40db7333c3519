#pragma once

#include <chrono>
#include <cstdint>

namespace mpm {

/// Shows on stderr how far long work has come: a line that is rewritten on a terminal, a plain line every now
/// and then otherwise.
class Progress {
 public:
  enum class Mode { automatic, quiet };

  Progress(std::int64_t total, Mode mode);

  /// `done` tasks were done before; they do not count in the rate. Before the first advance().
  void start_from(std::int64_t done);
  /// One more task is done; `failed` counts tasks worth mentioning.
  void advance(bool failed);
  /// Ends the line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void show();

  std::int64_t total_, earlier_ = 0, done_ = 0, failed_ = 0;
  bool quiet_, terminal_;
  Clock::time_point start_, shown_;
};

}  // namespace mpm
