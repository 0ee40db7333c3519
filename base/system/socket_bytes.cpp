#include "base/system/socket_bytes.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <optional>

#include <poll.h>
#include <sys/socket.h>

namespace mpm {

namespace {

/// Waits until the socket is ready for `events`. Returns none if it is, otherwise the reason for giving up.
std::optional<Received> wait_for(int socket, short events, const SocketPatience& patience) {
  constexpr std::int64_t kLongest = 3600 * 1000;
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(patience.deadline - SocketDeadline::clock::now())
            .count();
    if (left <= 0)
      return Received::late;
    std::array<pollfd, 2> watched{{{socket, events, 0}, {patience.user, POLLRDHUP, 0}}};
    const int ready = ::poll(watched.data(), watched.size(), static_cast<int>(std::min(left, kLongest)));
    if (ready > 0 && watched[1].revents != 0)
      return Received::abandoned;
    if (ready > 0)
      return std::nullopt;
  }
}

}  // namespace

bool send_bytes(int socket, const void* data, std::size_t size, const SocketPatience* patience) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    if (patience != nullptr && wait_for(socket, POLLOUT, *patience))
      return false;
    const ssize_t sent = ::send(socket, next, size, MSG_NOSIGNAL | (patience != nullptr ? MSG_DONTWAIT : 0));
    if (sent < 0 && (errno == EINTR || (errno == EAGAIN && patience != nullptr)))
      continue;
    if (sent <= 0)
      return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

Received receive_bytes(int socket, void* data, std::size_t size, const SocketPatience* patience) {
  char* next = static_cast<char*>(data);
  while (size > 0) {
    if (patience != nullptr)
      if (const std::optional<Received> in_vain = wait_for(socket, POLLIN, *patience))
        return *in_vain;
    const ssize_t received = ::recv(socket, next, size, 0);
    if (received < 0 && errno == EINTR)
      continue;
    if (received <= 0)
      return Received::closed;
    next += received;
    size -= static_cast<std::size_t>(received);
  }
  return Received::all;
}

}  // namespace mpm
