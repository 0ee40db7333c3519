#include "plants/forked_service.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plants/socket_bytes.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

/// Header of a message: how many bytes follow, and whether they are the text of a failure.
struct ServiceHeader {
  std::int64_t failed;
  std::int64_t size;
};

/// The numbers of a message, or its text.
bool send_answer(int socket, const void* data, std::size_t size, bool failed) {
  const ServiceHeader header{failed ? 1 : 0, static_cast<std::int64_t>(size)};
  return send_bytes(socket, &header, sizeof header) && send_bytes(socket, data, size);
}

Received receive(int socket, std::vector<double>& numbers, std::string& failure,
                 const Clock::time_point* deadline) {
  ServiceHeader header{};
  if (const Received got = receive_bytes(socket, &header, sizeof header, deadline); got != Received::all)
    return got;
  const auto size = static_cast<std::size_t>(header.size);
  failure.resize(header.failed != 0 ? size : 0);
  numbers.resize(header.failed != 0 ? 0 : size / sizeof(double));
  return header.failed != 0 ? receive_bytes(socket, failure.data(), size, deadline)
                            : receive_bytes(socket, numbers.data(), size, deadline);
}

constexpr int kSocket = 3;  // in the child, after the standard streams

/// Makes the copy of this process one that has nothing of it but its memory.
void take_leave(int socket) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
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
}

[[noreturn]] void serve_until_closed(const ForkedService::Serve& serve) {
  std::vector<double> numbers;
  std::string failure;
  bool open = true;
  while (open && receive(kSocket, numbers, failure, nullptr) == Received::all) {
    try {
      const std::vector<double> answer = serve(numbers);
      open = send_answer(kSocket, answer.data(), answer.size() * sizeof(double), false);
    } catch (const std::exception& error) {
      open = send_answer(kSocket, error.what(), std::strlen(error.what()), true);
    }
  }
  // Not exit(): destructors and buffers belong to the parent.
  ::_exit(0);
}

/// One process is made at a time: another one that was copied in between would hold an end of this one's
/// socket, and its end would not show.
std::mutex& fork_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

ForkedService::ForkedService(const Serve& serve, double time_limit) : time_limit_(time_limit) {
  const std::lock_guard lock(fork_mutex());
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "no socket for a simulation");
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) {
    take_leave(ends[1]);
    if (::getppid() != parent)
      ::_exit(0);  // the parent died before the line above
    serve_until_closed(serve);
  }
  const int error = errno;
  ::close(ends[1]);
  socket_ = ends[0];
  if (pid_ < 0) {
    ::close(socket_);
    throw std::system_error(error, std::generic_category(), "no process for a simulation");
  }
}

ForkedService::~ForkedService() {
  end();
  ::close(socket_);
}

std::vector<double> ForkedService::ask(const std::vector<double>& request) {
  if (pid_ < 0)
    throw ForeignFailure("its process has ended");
  send_answer(socket_, request.data(), request.size() * sizeof(double), false);  // a failure shows below
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit_));
  std::vector<double> numbers;
  std::string failure;
  switch (receive(socket_, numbers, failure, &deadline)) {
    case Received::all:
      break;
    case Received::closed:
      throw how_it_ended();
    case Received::late:
      end();
      throw ForeignFailure(fmt::format("no answer within {} s", time_limit_));
  }
  if (!failure.empty())
    throw ForeignFailure(failure);
  return numbers;
}

void ForkedService::end() {
  if (pid_ <= 0)
    return;
  ::kill(pid_, SIGKILL);  // there is nothing that it could still finish
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

ForeignFailure ForkedService::how_it_ended() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return ForeignFailure(WIFSIGNALED(status)
                            ? fmt::format("its process ended by signal {} ({})", WTERMSIG(status),
                                          ::strsignal(WTERMSIG(status)))
                            : fmt::format("its process ended with code {}", WEXITSTATUS(status)));
}

}  // namespace mpm
