#include "base/system/thread_clock.hpp"

#include <ctime>

namespace mpm {
namespace {

double& seconds_of_others() {
  thread_local double seconds = 0.0;
  return seconds;
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) + seconds_of_others();
}

void count_for_thread(double seconds) {
  seconds_of_others() += seconds;
}

}  // namespace mpm
