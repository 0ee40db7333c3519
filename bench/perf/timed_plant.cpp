#include "bench/perf/timed_plant.hpp"

#include "base/system/thread_clock.hpp"

namespace mpm {

PlantStatus TimedPlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  const double begin = thread_seconds();
  const PlantStatus status = plant_.advance(input);
  seconds_ += thread_seconds() - begin;
  return status;
}

}  // namespace mpm
