#include "bench/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace mpm {
namespace {

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  return whole < 60     ? fmt::format("{} s", whole)
         : whole < 3600 ? fmt::format("{}:{:02} min", whole / 60, whole % 60)
                        : fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(std::int64_t total, Mode mode)
    : total_(total),
      quiet_(mode == Mode::quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      shown_(start_) {}

void Progress::start_from(std::int64_t done) {
  earlier_ = done_ = done;
  start_ = Clock::now();
  if (!quiet_ && done > 0)
    fmt::print(stderr, "{} of {} experiments are done already\n", done, total_);
}

void Progress::advance(bool failed) {
  ++done_;
  if (failed)
    ++failed_;
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10);
  if (quiet_ || (Clock::now() - shown_ < pause && done_ < total_))
    return;
  show();
}

void Progress::show() {
  shown_ = Clock::now();
  const double seconds = std::chrono::duration<double>(shown_ - start_).count();
  const double rate = static_cast<double>(done_ - earlier_) / std::max(seconds, 1e-9);
  const std::string text = fmt::format("{}/{} experiments, {:.3g}/s, {} left{}", done_, total_, rate,
                                       duration(static_cast<double>(total_ - done_) / rate),
                                       failed_ > 0 ? fmt::format(", {} failed", failed_) : "");
  if (terminal_) {
    constexpr int kWidth = 30;
    const auto filled = static_cast<int>(kWidth * done_ / std::max<std::int64_t>(total_, 1));
    fmt::print(stderr, "\r[{:<{}}] {}\033[K", std::string(static_cast<std::size_t>(filled), '#'), kWidth,
               text);
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}\n", text);
  }
}

void Progress::finish() {
  if (!quiet_ && terminal_ && done_ > 0)
    fmt::print(stderr, "\n");
}

}  // namespace mpm
