#pragma once

#include <chrono>
#include <cstddef>

// Bytes between a process and one that it has forked, over a stream socket: all of them, or none counts.

namespace mpm {

using SocketDeadline = std::chrono::steady_clock::time_point;

/// How long one waits for the other end.
struct SocketPatience {
  SocketDeadline deadline;
  int user = -1;  ///< a further socket: when its other end is gone, nobody waits any longer; -1: none
};

/// Sends `size` bytes; false when the other end is gone, which raises no SIGPIPE, or does not take them in
/// time.
bool send_bytes(int socket, const void* data, std::size_t size, const SocketPatience* patience = nullptr);

enum class Received {
  all,
  closed,    ///< the other end is gone
  late,      ///< not all of them were there in time
  abandoned  ///< the user is gone
};

/// Waits for `size` bytes, for ever or as long as `patience` says.
Received receive_bytes(int socket, void* data, std::size_t size, const SocketPatience* patience = nullptr);

}  // namespace mpm
