#pragma once

#include <cstdint>

#include "analysis/validation/study_forecast.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/execution/run_options.hpp"

namespace mpm {

/// The first experiments of a study, run and timed instead of all of them.
struct StudyPilot {
  Campaign campaign;
  StudyForecast forecast;
  double basis_seconds = 0.0;  ///< wall clock
  double seconds = 0.0;        ///< forecast for the study and its calibration loops, with as many jobs
  double milliseconds_of_a_loop = 0.0;  ///< on one core, with all methods
};

/// Runs the first `loops` experiments, or all if there are fewer, with these options but without an audit,
/// and stores nothing. The basis case may be unhealthy. `hooks` are called as by run_campaign(). Errors: as
/// run_campaign().
StudyPilot run_pilot(Study study, RunOptions options, std::int64_t loops, CampaignHooks hooks);

}  // namespace mpm
