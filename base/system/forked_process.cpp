#include "base/system/forked_process.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/foreign_text.hpp"
#include "base/system/surroundings.hpp"

namespace mpm {
namespace {

enum class MessageKind : std::int64_t { numbers, failure, surroundings };

/// Header of a message: how many bytes follow, and whether they are numbers or the text of a failure.
struct MessageHeader {
  MessageKind kind;
  std::int64_t size;
};

constexpr std::size_t kLongestFailure = 1000;  // bytes

bool send_message(int socket, const void* data, std::size_t size, MessageKind kind,
                  const SocketPatience* patience) {
  const MessageHeader header{kind, static_cast<std::int64_t>(size)};
  return send_bytes(socket, &header, sizeof header, patience) && send_bytes(socket, data, size, patience);
}

std::exception_ptr failure_of(MessageKind kind, const std::string& text) {
  return kind == MessageKind::surroundings ? std::make_exception_ptr(SurroundingsFailure(text))
                                           : std::make_exception_ptr(ForeignFailure(text));
}

/// Kills the children that exist now.
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
  ::signal(SIGINT, SIG_IGN);  // Ctrl-C: the parent decides
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::dup2(socket, kSocket);
  ::close_range(kSocket + 1, ~0U, 0);  // before /dev/null is opened: else no number may be left
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int stream = 0; stream < kSocket; ++stream)
    ::dup2(nowhere, stream);
  if (nowhere > kSocket)
    ::close(nowhere);
  ::fcntl(kSocket, F_SETFD, 0);
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
  constexpr int kLooks = 2000;  // one per millisecond; children that multiply faster than that remain
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
  return send_message(socket, numbers.data(), numbers.size() * sizeof(double), MessageKind::numbers,
                      patience);
}

bool send_failure(int socket, const std::exception& failure) {
  const std::string shown = foreign_text(what_happened(failure), kLongestFailure);
  return send_message(socket, shown.data(), shown.size(),
                      is_of_surroundings(failure) ? MessageKind::surroundings : MessageKind::failure,
                      nullptr);
}

Received receive_numbers(int socket, std::vector<double>& numbers, std::exception_ptr& failure,
                         std::size_t most, const SocketPatience* patience) {
  numbers.clear();
  failure = nullptr;
  MessageHeader header{};
  if (const Received got = receive_bytes(socket, &header, sizeof header, patience); got != Received::all)
    return got;
  const bool failed = header.kind != MessageKind::numbers;
  const std::size_t longest = failed ? 2 * kLongestFailure : most * sizeof(double);
  if (header.size < 0 || static_cast<std::size_t>(header.size) > longest ||
      (!failed && static_cast<std::size_t>(header.size) % sizeof(double) != 0)) {
    failure = failure_of(MessageKind::failure,
                         fmt::format("a message of {} bytes; allowed: 0 to {}", header.size, longest));
    return Received::all;
  }
  const auto size = static_cast<std::size_t>(header.size);
  if (!failed) {
    numbers.resize(size / sizeof(double));
    return receive_bytes(socket, numbers.data(), numbers.size() * sizeof(double), patience);
  }
  std::string text(size, '\0');
  const Received got = receive_bytes(socket, text.data(), size, patience);
  text = foreign_text(text, 2 * kLongestFailure);
  failure = failure_of(header.kind, text.empty() ? "it failed without a reason" : text);
  return got;
}

}  // namespace mpm
