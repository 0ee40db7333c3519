#include "plants/forked_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

namespace mpm {
namespace {

/// Header of a message: how many bytes follow, and whether they are the text of a failure.
struct MessageHeader {
  std::int64_t failed;
  std::int64_t size;
};

bool send_message(int socket, const void* data, std::size_t size, bool failed) {
  const MessageHeader header{failed ? 1 : 0, static_cast<std::int64_t>(size)};
  return send_bytes(socket, &header, sizeof header) && send_bytes(socket, data, size);
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

bool send_numbers(int socket, const std::vector<double>& numbers) {
  return send_message(socket, numbers.data(), numbers.size() * sizeof(double), false);
}

bool send_failure(int socket, const std::string& text) {
  return send_message(socket, text.data(), text.size(), true);
}

Received receive_numbers(int socket, std::vector<double>& numbers, std::string& failure,
                         const SocketDeadline* deadline) {
  MessageHeader header{};
  if (const Received got = receive_bytes(socket, &header, sizeof header, deadline); got != Received::all)
    return got;
  const auto size = static_cast<std::size_t>(header.size);
  failure.resize(header.failed != 0 ? size : 0);
  numbers.resize(header.failed != 0 ? 0 : size / sizeof(double));
  return header.failed != 0 ? receive_bytes(socket, failure.data(), size, deadline)
                            : receive_bytes(socket, numbers.data(), size, deadline);
}

}  // namespace mpm
