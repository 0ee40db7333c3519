#include "bench/console/stop_signals.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>

#include <poll.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include "bench/console/exit_code.hpp"

namespace mpm {
namespace {

/// The signal that has come, 0 before. A handler gets nothing but the number of its signal, so this cannot be
/// a member.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);  // else not allowed in a handler
/// The process that ends itself after a signal: processes that it forks leave their end to it.
pid_t flag_owner = 0;

constexpr int kServedProcessEnded = -1;  // a value of received_signal
constexpr std::chrono::milliseconds kPatience(1700);
constexpr itimerval kTimer{{0, 0}, {kPatience.count() / 1000, 1000 * (kPatience.count() % 1000)}};
constexpr itimerval kNoTimer{};

void note(int signal) {
  const int error = errno;
  received_signal = signal;
  if (::getpid() == flag_owner)
    ::setitimer(ITIMER_REAL, &kTimer, nullptr);
  errno = error;
}

void give_up(int /*signal*/) {
  constexpr char kWords[] =
      "\nmpmbench: stopped; work under way did not end in time and is lost, everything kept before is still "
      "there\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kWords, sizeof kWords - 1);
  ::_exit(static_cast<int>(ExitCode::not_finished));
}

/// Waits for the end of the process with this pidfd (-1: it has ended), requests a stop, and gives up after
/// kPatience.
void watch(int process) {
  pollfd watched{process, POLLIN, 0};
  while (process >= 0 && ::poll(&watched, 1, -1) < 0 && errno == EINTR) {
  }
  received_signal = kServedProcessEnded;
  std::this_thread::sleep_for(kPatience);
  give_up(0);
}

/// Installs a handler for the next such signal. Returns the action that was in force before.
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
  flag_owner = ::getpid();
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
    case kServedProcessEnded:
      return "the process that started this command has ended";
    default:
      return "";
  }
}

void stop_with_served_process() {
  const char* const served = std::getenv("MPMBENCH_SERVES");
  std::istringstream words(served != nullptr ? served : "");
  pid_t process = 0;
  std::string space;
  std::error_code unknown;
  if (!(words >> process >> space) || std::filesystem::read_symlink("/proc/self/ns/pid", unknown) != space)
    return;
  const auto handle = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
  if (handle >= 0 || errno == ESRCH)
    std::thread(watch, handle).detach();
}

}  // namespace mpm
