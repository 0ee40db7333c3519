#pragma once

#include <string>
#include <vector>

#include "plants/socket_bytes.hpp"

// What processes that were forked off have in common: how they begin, and how they talk.

namespace mpm {

/// Makes this copy of a process one that has nothing of it but its memory: signals as a program finds them,
/// SIGINT left to the parent, no core, standard streams that lead nowhere, and of all files `socket` alone.
/// Returns the number that the socket has from now on.
int leave_parent(int socket);

/// A message of numbers, or the text of a failure in their place. False when the other end is gone.
bool send_numbers(int socket, const std::vector<double>& numbers);
bool send_failure(int socket, const std::string& text);

/// The next message: numbers, or the text of a failure and no numbers.
Received receive_numbers(int socket, std::vector<double>& numbers, std::string& failure,
                         const SocketDeadline* deadline = nullptr);

}  // namespace mpm
