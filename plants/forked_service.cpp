#include "plants/forked_service.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plants/forked_process.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void serve_until_closed(int socket, const ForkedService::Serve& serve) {
  std::vector<double> numbers;
  std::string failure;
  bool open = true;
  while (open && receive_numbers(socket, numbers, failure) == Received::all) {
    try {
      open = send_numbers(socket, serve(numbers));
    } catch (const std::exception& error) {
      open = send_failure(socket, error.what());
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
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent)
      ::_exit(0);  // the parent died before the line above
    serve_until_closed(leave_parent(ends[1]), serve);
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
  send_numbers(socket_, request);  // a failure shows below
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit_));
  std::vector<double> numbers;
  std::string failure;
  switch (receive_numbers(socket_, numbers, failure, &deadline)) {
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
