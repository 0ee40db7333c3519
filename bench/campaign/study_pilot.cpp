#include "bench/campaign/study_pilot.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "bench/campaign/campaign_loops.hpp"
#include "bench/campaign/campaign_runner.hpp"

namespace mpm {

StudyPilot run_pilot(Study study, RunOptions options, std::int64_t loops, CampaignHooks hooks) {
  using PilotClock = std::chrono::steady_clock;
  const std::int64_t all = options.experiments.value_or(study.experiment_count());
  const std::int64_t calibration = calibration_loops(study);
  study.calibration.reset();  // the pilot needs none
  options.experiments = std::min(loops, all);
  options.store = StorePolicy::none;
  options.audit_share = 0.0;
  options.allow_unhealthy_basis = true;
  PilotClock::time_point start;
  hooks.on_start = [&, begin = hooks.on_start](std::int64_t done, std::int64_t count) {
    start = PilotClock::now();
    if (begin)
      begin(done, count);
  };
  StudyPilot pilot;
  pilot.campaign = run_campaign(std::move(study), options, hooks);
  const double seconds = std::chrono::duration<double>(PilotClock::now() - start).count();
  pilot.forecast = forecast(pilot.campaign.study, pilot.campaign.records);
  const auto count = static_cast<double>(*options.experiments);
  const double at_once = std::min(count, static_cast<double>(options.jobs));
  pilot.basis_seconds = pilot.campaign.info.seconds - seconds;
  pilot.milliseconds_of_a_loop = 1e3 * seconds * at_once / count;
  pilot.seconds = pilot.basis_seconds + seconds / count * static_cast<double>(all + calibration);
  return pilot;
}

}  // namespace mpm
