#include "bench/console/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/console/output.hpp"

namespace mpm {
namespace {

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  return whole < 60     ? fmt::format("{} s", whole)
         : whole < 3600 ? fmt::format("{}:{:02} min", whole / 60, whole % 60)
                        : fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(bool quiet, std::string_view what)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), what_(what) {}

Progress::~Progress() {
  end_line();
}

void Progress::plan(std::int64_t later) {
  later_ = later;
  in_pieces_ = true;
}

void Progress::begin(std::int64_t total, std::int64_t done) {
  end_line();
  if (in_pieces_)
    finished_ += done_ - earlier_;
  total_ = total;
  earlier_ = done_ = done;
  failed_ = 0;
  shown_ = Clock::now();
  if (!in_pieces_ || finished_ == 0)
    start_ = shown_;
  if (done > 0)
    note(fmt::format("{} of {} {} are done already", done, total, what_));
}

void Progress::advance(bool failed) {
  ++done_;
  if (failed)
    ++failed_;
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10);
  if (!quiet_ && (Clock::now() - shown_ >= pause || done_ >= total_))
    show();
}

void Progress::note(const std::string& text) {
  if (quiet_)
    return;
  end_line();
  print_note(fmt::format("{}\n", text));
}

void Progress::warn(const std::string& text) {
  end_line();
  print_note(fmt::format("mpmbench: warning: {}\n", text));
}

std::string Progress::explain(const Interrupted& error) const {
  return signals_.received() ? fmt::format("{}: {}", signals_.name(), error.what()) : error.what();
}

void Progress::end_when_requested() const {
  if (stop_requested() && done_ < total_)
    throw std::runtime_error(explain(Interrupted(done_, total_, what_)));
}

void Progress::show() {
  shown_ = Clock::now();
  const double seconds = std::chrono::duration<double>(shown_ - start_).count();
  const double rate = static_cast<double>(finished_ + done_ - earlier_) / std::max(seconds, 1e-9);
  const std::string text =
      fmt::format("{}/{} {}, {:.3g}/s, {} left{}{}", done_, total_, what_, rate,
                  duration(static_cast<double>(total_ - done_ + later_) / rate), later_ > 0 ? " in all" : "",
                  failed_ > 0 ? fmt::format(", {} failed", failed_) : "");
  if (terminal_) {
    constexpr int kWidth = 30;
    const auto filled = static_cast<int>(kWidth * done_ / std::max<std::int64_t>(total_, 1));
    const std::string line =
        fmt::format("\r[{:<{}}] {}\033[K", std::string(static_cast<std::size_t>(filled), '#'), kWidth, text);
    std::fputs(line.c_str(), stderr);  // not print_note(), which removes the control characters
    std::fflush(stderr);
    in_line_ = true;
    if (done_ >= total_)
      end_line();
  } else {
    print_note(fmt::format("{}\n", text));
  }
}

void Progress::end_line() {
  if (in_line_)
    print_note("\n");
  in_line_ = false;
}

CampaignHooks hooks_of(Progress& progress) {
  return {.stop = [&progress] { return progress.stop_requested(); },
          .on_start = [&progress](std::int64_t done, std::int64_t count) { progress.begin(count, done); },
          .on_done = [&progress](bool failed) { progress.advance(failed); },
          .on_warning = [&progress](const std::string& text) { progress.warn(text); }};
}

}  // namespace mpm
