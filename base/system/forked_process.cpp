#include "base/system/forked_process.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/foreign_text.hpp"

namespace mpm {
namespace {

/// Header of a message: how many bytes follow, and whether they are the text of a failure.
struct MessageHeader {
  std::int64_t failed;
  std::int64_t size;
};

constexpr std::size_t kLongestFailure = 1000;  // bytes

bool send_message(int socket, const void* data, std::size_t size, bool failed,
                  const SocketPatience* patience) {
  const MessageHeader header{failed ? 1 : 0, static_cast<std::int64_t>(size)};
  return send_bytes(socket, &header, sizeof header, patience) && send_bytes(socket, data, size, patience);
}

/// Kills those that are there now.
void kill_children() {
  std::ifstream list("/proc/thread-self/children");
  for (pid_t child = 0; list >> child;)
    ::kill(child, SIGKILL);
}

}  // namespace

int leave_parent(int socket) {
  constexpr int kSocket = 3;  // after the standard streams
  for (int signal = 1; signal < NSIG; ++signal)
    ::signal(signal, SIG_DFL);
  ::signal(SIGINT, SIG_IGN);  // of the terminal: its parent decides
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const int own = ::fcntl(socket, F_DUPFD, kSocket + 1);  // out of the way of those that follow
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int stream = 0; stream < kSocket; ++stream)
    ::dup2(nowhere, stream);
  ::dup2(own, kSocket);
  ::close_range(kSocket + 1, ~0U, 0);
  return kSocket;
}

std::array<int, 2> socket_pair(int type, const char* what) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), what);
  return ends;
}

ForkedProcess fork_process(int socket_type, const std::function<void(int)>& work) {
  const std::array<int, 2> ends = socket_pair(socket_type, "no socket for simulations");
  const pid_t pid = ::fork();
  if (pid == 0) {
    work(leave_parent(ends[1]));
    ::_exit(0);  // not exit(): destructors and buffers belong to the parent
  }
  const int error = errno;
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    throw std::system_error(error, std::generic_category(), "no process for simulations");
  }
  return {pid, ends[0]};
}

void end_children() {
  constexpr int kLooks = 2000;  // of a millisecond: what makes processes faster than that is not waited for
  for (int look = 0; look < kLooks; ++look) {
    kill_children();
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (ended < 0 && errno == ECHILD)
      return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

bool send_numbers(int socket, const std::vector<double>& numbers, const SocketPatience* patience) {
  return send_message(socket, numbers.data(), numbers.size() * sizeof(double), false, patience);
}

bool send_failure(int socket, const std::string& text) {
  const std::string shown = foreign_text(text, kLongestFailure);
  return send_message(socket, shown.data(), shown.size(), true, nullptr);
}

Received receive_numbers(int socket, std::vector<double>& numbers, std::string& failure, std::size_t most,
                         const SocketPatience* patience) {
  numbers.clear();
  failure.clear();
  MessageHeader header{};
  if (const Received got = receive_bytes(socket, &header, sizeof header, patience); got != Received::all)
    return got;
  const bool failed = header.failed != 0;
  const std::size_t longest = failed ? 2 * kLongestFailure : most * sizeof(double);
  if (header.size < 0 || static_cast<std::size_t>(header.size) > longest ||
      (!failed && static_cast<std::size_t>(header.size) % sizeof(double) != 0)) {
    failure = fmt::format("a message of {} bytes; allowed: 0 to {}", header.size, longest);
    return Received::all;
  }
  const auto size = static_cast<std::size_t>(header.size);
  if (!failed) {
    numbers.resize(size / sizeof(double));
    return receive_bytes(socket, numbers.data(), numbers.size() * sizeof(double), patience);
  }
  failure.resize(size);
  const Received got = receive_bytes(socket, failure.data(), size, patience);
  failure = foreign_text(failure, 2 * kLongestFailure);
  if (failure.empty())
    failure = "it failed without a reason";
  return got;
}

}  // namespace mpm
