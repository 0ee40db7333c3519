#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <stdexcept>
#include <vector>

#include <sys/types.h>

#include "base/system/socket_bytes.hpp"

// What all processes that were forked off have in common: how they begin, and how they exchange messages.

namespace mpm {

/// A foreign simulation was asked and gave no answer. The text tells people what happened. If the simulation
/// could not be asked, that is a SurroundingsFailure.
class ForeignFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Detaches this copy of a process from its parent, except for the memory: signals have their defaults,
/// SIGINT is left to the parent, no core is written, standard streams lead nowhere, and `socket` is the only
/// open file. Returns the number that the socket has from now on.
int leave_parent(int socket);

/// Returns two connected sockets of a type such as SOCK_STREAM; a new program inherits neither. Throws
/// std::system_error with the text `what`.
std::array<int, 2> socket_pair(int type, const char* what);

/// A process that was forked off, and the socket to it.
struct ForkedProcess {
  pid_t pid = -1;
  int socket = -1;
};

/// Forks off a process, which detaches itself from its parent (leave_parent()), calls `work` with the socket
/// to the parent, and ends when `work` returns. The calling process must have no other threads: a process
/// that another thread forks meanwhile would hold an end of this socket, so that nobody would see it close.
/// Throws std::system_error.
ForkedProcess fork_process(int socket_type, const std::function<void(int)>& work);

/// Kills the children of this process and their children, whatever session or group they are in. This process
/// must be their reaper (PR_SET_CHILD_SUBREAPER), so that what a child leaves behind becomes a child of this
/// process, and it must have no other children.
void end_children();

/// Sends a message of numbers, or a failure instead of them. Returns false if the other end is gone or does
/// not take the message in time.
bool send_numbers(int socket, const std::vector<double>& numbers, const SocketPatience* patience = nullptr);
bool send_failure(int socket, const std::exception& failure);

/// Receives the next message: at most `most` numbers, or a failure and no numbers. The failure is a
/// ForeignFailure, or a SurroundingsFailure if it was sent as one (is_of_surroundings()). An invalid message
/// counts as a ForeignFailure, because foreign code may run at the other end.
Received receive_numbers(int socket, std::vector<double>& numbers, std::exception_ptr& failure,
                         std::size_t most, const SocketPatience* patience = nullptr);

}  // namespace mpm
