#pragma once

#include <chrono>
#include <cstddef>

// Bytes between a process and one that it has forked, over a stream socket: all of them or none that count.

namespace mpm {

using SocketDeadline = std::chrono::steady_clock::time_point;

/// Sends `size` bytes; false when the other end is gone, which raises no SIGPIPE.
bool send_bytes(int socket, const void* data, std::size_t size);

enum class Received {
  all,
  closed,  ///< the other end is gone
  late     ///< not all of them were there in time
};

/// Waits for `size` bytes, until `deadline` where there is one.
Received receive_bytes(int socket, void* data, std::size_t size, const SocketDeadline* deadline = nullptr);

}  // namespace mpm
