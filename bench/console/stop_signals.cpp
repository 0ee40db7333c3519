#include "bench/console/stop_signals.hpp"

#include <atomic>

namespace mpm {
namespace {

/// The signal that has come, 0 before. A handler gets nothing but the number of its signal, so that this
/// cannot be a member.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);  // else not allowed in a handler

void note(int signal) {
  received_signal = signal;
}

/// Returns what was in force before.
struct sigaction install(int signal) {
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  ::sigaction(signal, &action, &before);
  return before;
}

}  // namespace

StopSignals::StopSignals() {
  received_signal = 0;
  interrupt_ = install(SIGINT);
  terminate_ = install(SIGTERM);
}

StopSignals::~StopSignals() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
}

bool StopSignals::received() const {
  return received_signal != 0;
}

std::string_view StopSignals::name() const {
  switch (received_signal) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "";
  }
}

}  // namespace mpm
