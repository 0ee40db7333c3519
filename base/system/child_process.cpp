#include "base/system/child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/foreign_text.hpp"
#include "base/system/program_trust.hpp"

namespace mpm {
namespace {

constexpr std::size_t kIn = 0, kOut = 1, kError = 2;  // file descriptors in the program
constexpr std::size_t kPieceBytes = std::size_t{1} << 16;
constexpr std::size_t kKeptErrors = 400;  // bytes of stderr in a message

/// The two ends of a pipe. The destructor closes those that were not taken.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw std::system_error(errno, std::generic_category(), "no pipe for a program");
  }
  ~Pipe() {
    for (const int end : ends_)
      if (end >= 0)
        ::close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  /// Takes the end that stays in this process and makes it non-blocking.
  int take(std::size_t end) {
    ::fcntl(ends_[end], F_SETFL, O_NONBLOCK);
    return std::exchange(ends_[end], -1);
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// A program that is gone must not end this process by SIGPIPE. The signal goes to the thread that writes:
/// there it is blocked during a write, and discarded if it came.
class NoBrokenPipeSignal {
 public:
  NoBrokenPipeSignal() {
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoBrokenPipeSignal() {
    const timespec at_once{};
    while (::sigtimedwait(&pipe_, nullptr, &at_once) < 0 && errno == EINTR) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoBrokenPipeSignal(const NoBrokenPipeSignal&) = delete;
  NoBrokenPipeSignal& operator=(const NoBrokenPipeSignal&) = delete;

 private:
  sigset_t pipe_{}, before_{};
};

/// Attributes for posix_spawn: a process group of its own, and the signals that a program expects at its
/// start.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t none, usual;
    ::sigemptyset(&none);
    ::sigemptyset(&usual);
    for (const int signal : {SIGPIPE, SIGINT, SIGTERM})
      ::sigaddset(&usual, signal);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &usual);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(&attributes_,
                               POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

class SpawnFiles {
 public:
  SpawnFiles(int in, int out, int error) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, in, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, out, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, error, STDERR_FILENO);
  }
  ~SpawnFiles() { ::posix_spawn_file_actions_destroy(&actions_); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Tells whether the error is a lack of resources that the start of any program needs.
bool is_shortage(int error) {
  return error == EAGAIN || error == ENOMEM || error == EMFILE || error == ENFILE;
}

int milliseconds_until(ChildProcess::Deadline deadline) {
  constexpr std::int64_t kLongest = 3600 * 1000;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, kLongest));
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> command)
    : name_(fmt::format("{}", fmt::join(command, " "))), owner_(::getpid()), ends_{-1, -1, -1} {
  if (command.empty())
    throw ChildFailure("a program without a name");
  require_trusted_program(command);
  Pipe in, out, error;
  std::vector<char*> arguments;
  for (std::string& word : command)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const SpawnFiles files(in.read_end(), out.write_end(), error.write_end());
  const SpawnAttributes attributes;
  const int failure =
      ::posix_spawnp(&pid_, arguments.front(), files.get(), attributes.get(), arguments.data(), environ);
  if (failure != 0) {
    pid_ = -1;
    const std::string what = fmt::format("program `{}` cannot be started", name_);
    if (is_shortage(failure))
      throw std::system_error(failure, std::generic_category(), what);
    throw ChildFailure(fmt::format("{}: {}", what, std::strerror(failure)));
  }
  ends_ = {in.take(1), out.take(0), error.take(0)};
}

ChildProcess::~ChildProcess() {
  if (is_ours())
    kill_and_reap();
  for (const int end : ends_)
    if (end >= 0)
      ::close(end);
}

bool ChildProcess::is_ours() const {
  return owner_ == ::getpid();
}

void ChildProcess::kill_and_reap() {
  if (pid_ < 0)
    return;
  ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

void ChildProcess::read_errors() {
  std::array<char, kPieceBytes> piece{};
  for (;;) {
    const ssize_t count = ends_[kError] < 0 ? 0 : ::read(ends_[kError], piece.data(), piece.size());
    if (count < 0 && errno == EINTR)
      continue;
    if (count < 0 && errno == EAGAIN)
      return;
    if (count <= 0) {
      if (ends_[kError] >= 0)
        ::close(std::exchange(ends_[kError], -1));
      return;
    }
    last_errors_.append(piece.data(), static_cast<std::size_t>(count));
    if (last_errors_.size() > kKeptErrors)
      last_errors_.erase(0, last_errors_.size() - kKeptErrors);
    if (pid_ >= 0)
      return;  // the program may never stop writing
  }
}

/// A program that closes its stdout usually ends at once; its exit code then says more than a kill by us
/// would.
void ChildProcess::fail_by_end() {
  constexpr std::chrono::milliseconds kGrace(2000), kLook(2);
  const auto until = std::chrono::steady_clock::now() + kGrace;
  int status = 0;
  pid_t ended = 0;
  while (pid_ >= 0 && (ended = ::waitpid(pid_, &status, WNOHANG)) == 0 &&
         std::chrono::steady_clock::now() < until) {
    read_errors();
    std::this_thread::sleep_for(kLook);
  }
  if (ended != pid_ || pid_ < 0)
    fail({"closed its stdin or stdout", false});
  ::kill(-pid_, SIGKILL);  // the processes that it has started
  pid_ = -1;
  fail(process_end(status));
}

void ChildProcess::fail(const ProcessEnd& what) {
  kill_and_reap();
  read_errors();
  std::string text = fmt::format("program `{}` {}", name_, what.text);
  if (const std::string errors = foreign_text(last_errors_, kKeptErrors); !errors.empty())
    text += fmt::format("; at the end of its stderr: {}", errors);
  if (what.from_outside)
    throw SurroundingsFailure(text);
  throw ChildFailure(text);
}

/// Waits until something can be written or read, and does it.
void ChildProcess::pump(Deadline deadline) {
  if (pid_ < 0)
    fail({"has ended before", false});
  std::array<pollfd, 3> watched{};
  watched[kIn] = {unsent_.empty() ? -1 : ends_[kIn], POLLOUT, 0};
  watched[kOut] = {ends_[kOut], POLLIN, 0};
  watched[kError] = {ends_[kError], POLLIN, 0};
  const int wait = milliseconds_until(deadline);
  const int ready = ::poll(watched.data(), watched.size(), wait);
  if (ready < 0 && errno != EINTR)
    fail({fmt::format("cannot be waited for: {}", std::strerror(errno)), true});
  if (wait == 0)
    fail({"did not answer in time", false});
  if (ready <= 0)
    return;
  if (watched[kError].revents != 0)
    read_errors();
  if (watched[kOut].revents != 0) {
    std::array<char, kPieceBytes> piece{};
    const ssize_t count = ::read(ends_[kOut], piece.data(), piece.size());
    if (count > 0)
      unread_.append(piece.data(), static_cast<std::size_t>(count));
    else if (count == 0)
      output_is_closed_ = true;
    if (unread_.size() > kLongestLine)
      fail({fmt::format("wrote more than {} bytes that nobody asked for", kLongestLine), false});
  }
  if (watched[kIn].revents != 0) {
    const NoBrokenPipeSignal guard;
    const ssize_t count = ::write(ends_[kIn], unsent_.data(), unsent_.size());
    if (count > 0)
      unsent_.erase(0, static_cast<std::size_t>(count));
    else if (errno == EPIPE)
      fail_by_end();
  }
}

void ChildProcess::send(std::string_view line, Deadline deadline) {
  unsent_ = fmt::format("{}\n\n", line);
  while (!unsent_.empty()) {
    pump(deadline);
    if (output_is_closed_)
      fail_by_end();
  }
}

std::string ChildProcess::receive(Deadline deadline) {
  for (;;) {
    const std::size_t end = unread_.find('\n', searched_);
    if (end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      searched_ = 0;
      if (!line.empty() && line.back() == '\r')
        line.pop_back();
      if (!line.empty())
        return line;
      continue;
    }
    searched_ = unread_.size();
    if (output_is_closed_)
      fail_by_end();
    pump(deadline);
  }
}

double ChildProcess::processor_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (pid_ < 0 || ::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &used) != 0)
    return 0.0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

ChildProcess::Deadline ChildProcess::in_seconds(double seconds) {
  constexpr double kCentury = 3.2e9;
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<Deadline::duration>(
                                                std::chrono::duration<double>(std::min(seconds, kCentury)));
}

}  // namespace mpm
