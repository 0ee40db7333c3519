#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/console/stop_signals.hpp"
#include "bench/execution/stop_request.hpp"

namespace mpm {

/// Shows the progress of long work; a command makes one. Writes on stderr how far the work has come (on a
/// terminal in a line that it rewrites, otherwise in a plain line every now and then), and takes Ctrl-C and
/// SIGTERM as a request to stop. When it is destroyed, also by an exception, it ends the line. At most one at
/// a time.
class Progress {
 public:
  /// `quiet`: shows nothing but warnings. `what` names the items of the work and must outlive this object.
  explicit Progress(bool quiet, std::string_view what = "experiments");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says that the work is done in several pieces, and that `later` experiments follow in the pieces after
  /// the next one. The time left is then that of all pieces.
  void plan(std::int64_t later);
  /// Work of `total` experiments begins; `done` of them were done before and do not count in the rate.
  void begin(std::int64_t total, std::int64_t done = 0);
  /// One more experiment is done; `failed`: it failed, which is worth mentioning. One call at a time.
  void advance(bool failed = false);

  /// Prints a line, unless quiet.
  void note(const std::string& text);
  /// The same, quiet or not.
  void warn(const std::string& text);

  /// Whether the work is to stop. May be called from any thread.
  bool stop_requested() const { return signals_.received(); }
  /// The reason why the work stopped, and where: "SIGINT: stopped when ...".
  std::string explain(const Interrupted& error) const;
  /// Throws std::runtime_error with that text when a stop was requested and something is left to do.
  void end_when_requested() const;

 private:
  using Clock = std::chrono::steady_clock;

  void show();
  void end_line();

  const StopSignals signals_;
  const bool quiet_, terminal_;
  const std::string_view what_;
  std::int64_t total_ = 0, earlier_ = 0, done_ = 0, failed_ = 0;
  std::int64_t later_ = 0;     ///< experiments of pieces that follow
  std::int64_t finished_ = 0;  ///< experiments of pieces that have ended
  bool in_pieces_ = false;
  Clock::time_point start_, shown_;
  bool in_line_ = false;  ///< the line on the terminal is not ended
};

/// The hooks that show the progress of a run and stop it.
CampaignHooks hooks_of(Progress& progress);

}  // namespace mpm
