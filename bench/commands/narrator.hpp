#pragma once

#include <chrono>
#include <string>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/console/progress.hpp"
#include "bench/execution/run_options.hpp"

namespace mpm {

/// Tells on stderr what a run reads, decides and does, if the user asks for it with --verbose.
class Narrator {
 public:
  Narrator(bool verbose, Progress& progress) : verbose_(verbose), progress_(progress) {}

  /// Tells which study is run, which was found under `found_as`, what in it differs from the defaults, how it
  /// is run, and where `output` goes.
  void say_what_is_run(const std::string& found_as, const Study& study, const RunOptions& options,
                       const std::string& output) const;

  /// Returns the same hooks, which also tell the time of each stage. This object must outlive them.
  CampaignHooks with_stages(CampaignHooks hooks);

 private:
  using Clock = std::chrono::steady_clock;

  void say(const std::string& text) const;
  void end_stage(const std::string& stage);

  const bool verbose_;
  Progress& progress_;
  Clock::time_point start_ = Clock::now();  ///< of the stage
};

}  // namespace mpm
