#include "bench/campaign/calibration_runs.hpp"

namespace mpm {

RunOptions calibration_options(RunOptions options) {
  options.experiments.reset();
  options.audit_share = 0.0;
  options.store = StorePolicy::none;
  return options;
}

std::int64_t calibration_loops(const Study& study) {
  return study.calibration ? study.calibration->healthy + study.calibration->ud : 0;
}

}  // namespace mpm
