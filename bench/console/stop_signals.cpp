#include "bench/console/stop_signals.hpp"

#include <atomic>
#include <cerrno>

#include <sys/time.h>
#include <unistd.h>

#include "bench/console/exit_code.hpp"

namespace mpm {
namespace {

/// The signal that has come, 0 before. A handler gets nothing but the number of its signal, so that this
/// cannot be a member.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);  // else not allowed in a handler
/// Whose signals these are: a process that is forked leaves its end to its parent.
pid_t owner = 0;

constexpr itimerval kPatience{{0, 0}, {1, 700'000}};  // 1.7 s
constexpr itimerval kNoTimer{};

void note(int signal) {
  const int error = errno;
  received_signal = signal;
  if (::getpid() == owner)
    ::setitimer(ITIMER_REAL, &kPatience, nullptr);
  errno = error;
}

void give_up(int /*signal*/) {
  constexpr char kWords[] =
      "\nmpmbench: stopped; work under way did not end in time and is lost, everything kept before is still "
      "there\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kWords, sizeof kWords - 1);
  ::_exit(static_cast<int>(ExitCode::not_finished));
}

/// Returns what was in force before.
struct sigaction install(int signal, void (*handler)(int)) {
  struct sigaction action {};
  struct sigaction before {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  ::sigaction(signal, &action, &before);
  return before;
}

}  // namespace

StopSignals::StopSignals() {
  received_signal = 0;
  owner = ::getpid();
  alarm_ = install(SIGALRM, give_up);
  interrupt_ = install(SIGINT, note);
  terminate_ = install(SIGTERM, note);
}

StopSignals::~StopSignals() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
  ::setitimer(ITIMER_REAL, &kNoTimer, nullptr);
  ::sigaction(SIGALRM, &alarm_, nullptr);
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
