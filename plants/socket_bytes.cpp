#include "plants/socket_bytes.hpp"

#include <cerrno>

#include <poll.h>
#include <sys/socket.h>

namespace mpm {

bool send_bytes(int socket, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR)
      continue;
    if (sent <= 0)
      return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

Received receive_bytes(int socket, void* data, std::size_t size, const SocketDeadline* deadline) {
  char* next = static_cast<char*>(data);
  while (size > 0) {
    if (deadline != nullptr) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(*deadline - SocketDeadline::clock::now()).count();
      pollfd readable{socket, POLLIN, 0};
      const int ready = left > 0 ? ::poll(&readable, 1, static_cast<int>(left)) : 0;
      if (ready == 0)
        return Received::late;
      if (ready < 0)
        continue;  // a signal
    }
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
