#pragma once

#include <chrono>
#include <cstddef>

// Bytes between a process and another that it has forked, over a stream socket. They count only if all
// arrive.

namespace mpm {

using SocketDeadline = std::chrono::steady_clock::time_point;

/// How long to wait for the other end.
struct SocketPatience {
  SocketDeadline deadline;
  int user = -1;  ///< another socket: if its other end is gone, waiting ends; -1: none
};

/// Sends `size` bytes. Returns false if the other end is gone, which raises no SIGPIPE, or does not take all
/// of them in time.
bool send_bytes(int socket, const void* data, std::size_t size, const SocketPatience* patience = nullptr);

enum class Received {
  all,
  closed,    ///< the other end is gone
  late,      ///< not all bytes arrived in time
  abandoned  ///< the user is gone
};

/// Waits for `size` bytes, for ever or as long as `patience` says.
Received receive_bytes(int socket, void* data, std::size_t size, const SocketPatience* patience = nullptr);

}  // namespace mpm
