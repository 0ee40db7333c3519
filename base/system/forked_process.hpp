#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <stdexcept>
#include <vector>

#include <sys/types.h>

#include "base/system/socket_bytes.hpp"

// What processes that were forked off have in common: how they begin, and how they talk.

namespace mpm {

/// A simulation of somebody else that gave no answer: what happened, for people. It was asked; otherwise it
/// is a SurroundingsFailure.
class ForeignFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Leaves this copy of a process nothing of its parent but the memory: signals have their defaults, SIGINT is
/// left to the parent, no core is written, standard streams lead nowhere, and `socket` is the only open file.
/// Returns the number that the socket has from now on.
int leave_parent(int socket);

/// Two sockets that are connected, of a type such as SOCK_STREAM; a new program inherits neither. Throws
/// std::system_error with the text `what`.
std::array<int, 2> socket_pair(int type, const char* what);

/// A process that was forked off, and the socket to it.
struct ForkedProcess {
  pid_t pid = -1;
  int socket = -1;
};

/// Forks a process off, which has left its parent when `work` begins with the socket to the parent, and ends
/// with it. For a process without other threads: a process that another thread forks meanwhile would hold an
/// end of this socket, so that nobody would see it close. Throws std::system_error.
ForkedProcess fork_process(int socket_type, const std::function<void(int)>& work);

/// Kills the children of this process and theirs, whatever session or group they are in: what a child leaves
/// behind becomes a child of this process, which has to be their reaper (PR_SET_CHILD_SUBREAPER). For a
/// process that has no other children.
void end_children();

/// A message of numbers, or a failure instead of them. False when the other end is gone or does not take it
/// in time.
bool send_numbers(int socket, const std::vector<double>& numbers, const SocketPatience* patience = nullptr);
bool send_failure(int socket, const std::exception& failure);

/// The next message: at most so many numbers, or a failure and no numbers; the failure is a ForeignFailure,
/// or a SurroundingsFailure where it was sent as one (is_of_surroundings()). What is neither counts as a
/// ForeignFailure: the other end may be somebody else's.
Received receive_numbers(int socket, std::vector<double>& numbers, std::exception_ptr& failure,
                         std::size_t most, const SocketPatience* patience = nullptr);

}  // namespace mpm
