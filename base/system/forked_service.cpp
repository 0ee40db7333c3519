#include "base/system/forked_service.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <exception>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/forked_process.hpp"
#include "base/system/surroundings.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

void serve_until_closed(int socket, const ForkedService::Serve& serve, std::size_t most) {
  std::vector<double> numbers;
  std::exception_ptr failure;
  bool open = true;
  while (open && receive_numbers(socket, numbers, failure, most) == Received::all) {
    try {
      open = send_numbers(socket, serve(numbers));
    } catch (const std::exception& error) {
      open = send_failure(socket, error);
    }
  }
}

}  // namespace

ForkedService::ForkedService(const Serve& serve, double time_limit, std::size_t most)
    : time_limit_(time_limit), most_(most) {
  const pid_t parent = ::getpid();
  const ForkedProcess made = fork_process(SOCK_STREAM, [&](int socket) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::setsid();
    if (::getppid() == parent)  // else the parent died before prctl()
      serve_until_closed(socket, serve, most);
  });
  pid_ = made.pid;
  socket_ = made.socket;
}

ForkedService::~ForkedService() {
  end();
  ::close(socket_);
}

std::vector<double> ForkedService::ask(const std::vector<double>& request, int user) {
  if (pid_ < 0)
    throw ForeignFailure("its process has ended");
  const SocketPatience patience{
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit_)),
      user};
  send_numbers(socket_, request, &patience);  // a failure shows below
  std::vector<double> numbers;
  std::exception_ptr failure;
  switch (receive_numbers(socket_, numbers, failure, most_, &patience)) {
    case Received::all:
      break;
    case Received::closed:
      fail_by_end();
    case Received::late:
      end();
      throw ForeignFailure(fmt::format("no answer within {} s", time_limit_));
    case Received::abandoned:
      end();
      throw ForeignFailure("nobody waits for its answer");
  }
  if (failure)
    std::rethrow_exception(failure);
  return numbers;
}

void ForkedService::end() {
  if (pid_ <= 0)
    return;
  ::kill(-pid_, SIGKILL);  // it has nothing left to finish
  ::kill(pid_, SIGKILL);   // it may not have made its session yet
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

/// Its socket is closed, usually because the process has ended. A process that only closed it gets a moment
/// to end.
void ForkedService::fail_by_end() {
  constexpr std::chrono::milliseconds kGrace(2000), kLook(1);
  const Clock::time_point until = Clock::now() + kGrace;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(pid_, &status, WNOHANG)) == 0 && Clock::now() < until)
    std::this_thread::sleep_for(kLook);
  if (ended != pid_) {
    end();
    throw ForeignFailure("its process closed the connection to this one");
  }
  ::kill(-pid_, SIGKILL);  // the processes that it has started
  pid_ = -1;
  const ProcessEnd end = process_end(status);
  const std::string text = fmt::format("its process {}", end.text);
  if (end.from_outside)
    throw SurroundingsFailure(text);
  throw ForeignFailure(text);
}

}  // namespace mpm
