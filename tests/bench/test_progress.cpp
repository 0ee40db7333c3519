#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <pty.h>
#include <unistd.h>

#include "bench/console/progress.hpp"

namespace {

using namespace mpm;
using Catch::Contains;
using Catch::EndsWith;

enum class Screen { pipe, terminal };

/// What is written to stderr while `work` runs; less than a pipe holds.
template <class Work>
std::string shown(Screen screen, const Work& work) {
  int ends[2];  // to read from, to write to
  REQUIRE((screen == Screen::pipe ? ::pipe(ends)
                                  : ::openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr)) == 0);
  const int before = ::dup(STDERR_FILENO);
  ::dup2(ends[1], STDERR_FILENO);
  work();
  ::dup2(before, STDERR_FILENO);
  ::close(before);
  std::string text;
  REQUIRE(::write(ends[1], "|", 1) == 1);
  while (text.empty() || text.back() != '|') {
    char part[4096];
    const ssize_t size = ::read(ends[0], part, sizeof part);
    REQUIRE(size > 0);
    text.append(part, static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  ::close(ends[1]);
  text.pop_back();
  return text;
}

TEST_CASE("progress: the last experiment is shown, with those that failed, and ends the line") {
  const auto work = [] {
    Progress progress(false);
    progress.note("study 1");
    progress.begin(3, 1);
    progress.advance(true);
    progress.advance();
    progress.note("study 2");
  };
  const std::string in_file = shown(Screen::pipe, work);
  CHECK_THAT(in_file, Contains("study 1\n1 of 3 experiments are done already\n3/3 experiments, "));
  CHECK_THAT(in_file, EndsWith(" left, 1 failed\nstudy 2\n"));
  const std::string on_terminal = shown(Screen::terminal, work);
  CHECK_THAT(on_terminal, Contains("\r[##############################] 3/3 experiments"));
  CHECK_THAT(on_terminal, EndsWith(", 1 failed\033[K\r\nstudy 2\r\n"));
}

TEST_CASE("progress: of work in pieces, the time left is that of all of them") {
  const std::string text = shown(Screen::pipe, [] {
    Progress progress(false);
    progress.plan(1000008);
    progress.begin(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    progress.advance();
    progress.advance();  // at most 100 a second: 10000 seconds or more are left
    progress.plan(8);
    progress.begin(1000000, 999999);
    progress.advance();
  });
  CHECK_THAT(text, Contains("2/2 experiments, ") && Contains(" h left in all\n"));
  CHECK_THAT(text, Contains("1000000/1000000 experiments, ") && Contains(" s left in all\n"));
}

TEST_CASE("progress: an exception ends the line on a terminal") {
  const std::string text = shown(Screen::terminal, [] {
    try {
      Progress progress(false);
      progress.begin(3);
      std::this_thread::sleep_for(std::chrono::milliseconds(250));  // longer than between two shows
      progress.advance();
      throw std::runtime_error("disk full");
    } catch (const std::runtime_error&) {
    }
  });
  CHECK_THAT(text, Contains("] 1/3 experiments") && EndsWith("\033[K\r\n"));
}

TEST_CASE("progress: quiet, it shows warnings only") {
  const std::string text = shown(Screen::pipe, [] {
    Progress progress(true);
    progress.note("study 1");
    progress.begin(2, 1);
    progress.warn("damaged");
    progress.advance();
  });
  CHECK(text == "mpmbench: warning: damaged\n");
}

TEST_CASE("progress: a signal is a request to stop, which names it and how far the work has come") {
  Progress progress(true);
  progress.begin(3);
  progress.advance();
  CHECK_NOTHROW(progress.end_when_requested());
  const CampaignHooks hooks = hooks_of(progress);
  CHECK_FALSE(hooks.stop());
  ::raise(SIGTERM);
  CHECK(hooks.stop());
  CHECK_THROWS_WITH(progress.end_when_requested(), "SIGTERM: stopped when 1 of 3 experiments were done");
  progress.advance();
  progress.advance();
  CHECK_NOTHROW(progress.end_when_requested());  // nothing is left to stop
}

}  // namespace
