#include <csignal>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/console/exit_code.hpp"
#include "bench/console/stop_signals.hpp"

namespace {

using namespace mpm;

TEST_CASE("stop signals: the first one is noted and named") {
  const auto [signal, name] = GENERATE(table<int, const char*>({{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}));
  const StopSignals signals;
  CHECK_FALSE(signals.received());
  CHECK(signals.name().empty());
  ::raise(signal);
  CHECK(signals.received());
  CHECK(signals.name() == name);
}

TEST_CASE("stop signals: the second one of a kind ends the process") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const pid_t child = ::fork();
  if (child == 0) {
    // Catch's own handler would report a failed test.
    std::signal(signal, SIG_DFL);
    const StopSignals signals;
    ::raise(signal);
    ::raise(signal);
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == signal);
}

TEST_CASE("stop signals: work that goes on and on is given up") {
  const pid_t child = ::fork();
  if (child == 0) {
    const StopSignals signals;
    ::raise(SIGTERM);
    for (;;)
      ::pause();
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == static_cast<int>(ExitCode::not_finished));
}

TEST_CASE("stop signals: they are noted where they were ignored, and all is as before afterwards") {
  const auto before = std::signal(SIGINT, SIG_IGN);
  {
    const StopSignals signals;
    ::raise(SIGINT);
    CHECK(signals.received());
  }
  CHECK(std::signal(SIGINT, before) == SIG_IGN);
}

}  // namespace
