#include "plants/forked_service.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
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

void serve_until_closed(int socket, const ForkedService::Serve& serve) {
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
}

}  // namespace

ForkedService::ForkedService(const Serve& serve, double time_limit) : time_limit_(time_limit) {
  const pid_t parent = ::getpid();
  const ForkedProcess made = fork_process(SOCK_STREAM, [&](int socket) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() == parent)  // else it died before the line above
      serve_until_closed(socket, serve);
  });
  pid_ = made.pid;
  socket_ = made.socket;
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
