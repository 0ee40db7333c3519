#include "base/system/fork_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <exception>
#include <optional>
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

constexpr std::size_t kLongestSetting = 64;  // numbers, including the time limit

/// A datagram with numbers and the right to use a socket. A thread or process that asks the server sends it
/// one end of a socket pair and needs no answer, so that several can ask at the same time.
class ServiceOrder {
 public:
  ServiceOrder() {
    content_ = {numbers_.data(), sizeof numbers_};
    message_.msg_iov = &content_;
    message_.msg_iovlen = 1;
    message_.msg_control = control_.data();
    message_.msg_controllen = control_.size();
  }
  ServiceOrder(const ServiceOrder&) = delete;
  ServiceOrder& operator=(const ServiceOrder&) = delete;

  bool send(int server, const std::vector<double>& numbers, int socket) {
    std::copy(numbers.begin(), numbers.end(), numbers_.begin());
    content_.iov_len = numbers.size() * sizeof(double);
    cmsghdr* const header = CMSG_FIRSTHDR(&message_);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof socket);
    std::memcpy(CMSG_DATA(header), &socket, sizeof socket);
    ssize_t sent = 0;
    while ((sent = ::sendmsg(server, &message_, MSG_NOSIGNAL)) < 0 && errno == EINTR) {
    }
    return sent >= 0;
  }

  /// Returns the socket that came and fills `numbers`. Returns none if nobody is left who could ask.
  std::optional<int> receive(int server, std::vector<double>& numbers) {
    ssize_t received = 0;
    while ((received = ::recvmsg(server, &message_, 0)) < 0 && errno == EINTR) {
    }
    const cmsghdr* const header = received > 0 ? CMSG_FIRSTHDR(&message_) : nullptr;
    if (header == nullptr)
      return std::nullopt;
    int socket = -1;
    std::memcpy(&socket, CMSG_DATA(header), sizeof socket);
    numbers.assign(numbers_.begin(), numbers_.begin() + static_cast<std::size_t>(received) / sizeof(double));
    return socket;
  }

 private:
  std::array<double, kLongestSetting> numbers_{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control_{};
  iovec content_{};
  msghdr message_{};
};

/// Passes messages between the user of a service and the process of the service.
void mediate(int socket, const ForkedService::Serve& serve, double time_limit) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  std::vector<double> numbers;
  std::exception_ptr failure;
  std::optional<ForkedService> service;
  bool open = true;
  while (open && receive_numbers(socket, numbers, failure, ForkedService::kMostNumbers) == Received::all) {
    try {
      if (!service)
        service.emplace(serve, time_limit);
      open = send_numbers(socket, service->ask(numbers, socket));
    } catch (const std::exception& error) {
      open = send_failure(socket, error);
    }
  }
  service.reset();
  end_children();
}

void make_services(int socket, const ForkServer::MakeService& make) {
  ::signal(SIGCHLD, SIG_IGN);          // nobody asks how a mediator ended
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // reap what a killed mediator leaves behind
  std::vector<double> setting;
  for (;;) {
    ServiceOrder order;
    const std::optional<int> user = order.receive(socket, setting);
    if (!user)
      return end_children();
    if (::fork() == 0) {
      const int own = leave_parent(*user);
      const double time_limit = setting.back();
      setting.pop_back();
      mediate(own, make(setting), time_limit);
      ::_exit(0);
    }
    ::close(*user);
  }
}

}  // namespace

ForkServer::ForkServer(const MakeService& make) : owner_(::getpid()) {
  const ForkedProcess made = fork_process(SOCK_SEQPACKET, [&](int socket) { make_services(socket, make); });
  pid_ = made.pid;
  socket_ = made.socket;
}

ForkServer::~ForkServer() {
  if (owner_ != ::getpid()) {
    ::close(socket_);
    return;
  }
  ::shutdown(socket_, SHUT_RDWR);  // ends the server and all that it made, even if others hold this socket
  ::close(socket_);
  constexpr int kLooks = 3000;  // one per millisecond
  for (int look = 0; ::waitpid(pid_, nullptr, WNOHANG) == 0; ++look) {
    if (look == kLooks)
      ::kill(pid_, SIGKILL);  // somebody has suspended it
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

ServedProcess::ServedProcess(const ForkServer& server, const std::vector<double>& setting, double time_limit)
    : time_limit_(time_limit) {
  const std::array<int, 2> ends = socket_pair(SOCK_STREAM, "no socket for a simulation");
  std::vector<double> numbers = setting;
  numbers.push_back(time_limit);
  const bool is_ordered = ServiceOrder().send(server.socket_, numbers, ends[1]);
  ::close(ends[1]);
  socket_ = ends[0];
  if (!is_ordered) {
    ::close(socket_);
    throw SurroundingsFailure("the process that makes its processes has ended");
  }
}

ServedProcess::~ServedProcess() {
  ::close(socket_);
}

/// The mediator has its own time limit; the one here is for a mediator that somebody has suspended.
std::vector<double> ServedProcess::ask(const std::vector<double>& request) {
  constexpr double kGrace = 5.0;  // s
  constexpr double kCentury = 3.2e9;
  const SocketPatience patience{SocketDeadline::clock::now() +
                                std::chrono::duration_cast<SocketDeadline::duration>(
                                    std::chrono::duration<double>(std::min(time_limit_, kCentury) + kGrace))};
  send_numbers(socket_, request, &patience);  // a failure shows below
  std::vector<double> numbers;
  std::exception_ptr failure;
  const Received got = receive_numbers(socket_, numbers, failure, ForkedService::kMostNumbers, &patience);
  if (got != Received::all) {
    ::shutdown(socket_, SHUT_RDWR);  // a late answer would pass for the answer to the next request
    if (got == Received::late)
      throw ForeignFailure(fmt::format("no answer within {} s", time_limit_));
    throw SurroundingsFailure("the process that waits for it has ended");
  }
  if (failure)
    std::rethrow_exception(failure);
  return numbers;
}

}  // namespace mpm
