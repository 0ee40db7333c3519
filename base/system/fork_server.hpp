#pragma once

#include <functional>
#include <vector>

#include <sys/types.h>

#include "base/system/forked_service.hpp"

namespace mpm {

/// A process that makes processes for threads. A fork copies the memory of a process as it is, with the locks
/// that other threads hold at that moment; nobody releases these in the copy. The server is therefore forked
/// once, while no other thread is at work. It has a single thread and forks whenever it is asked to.
///
/// For each service the server makes two processes. The first does the work. The second waits for it, ends it
/// if it takes too long or if its user is gone, and says how it ended (ForkedService). Whatever the first one
/// has started, in whatever session, ends with its service: the second one reaps it or, if the second one was
/// killed, the server does.
class ForkServer {
 public:
  /// Returns the function that a service with this setting runs; called in a process of the service.
  using MakeService = std::function<ForkedService::Serve(const std::vector<double>& setting)>;

  /// Forks the server; call it before any thread runs. Errors: std::system_error if no process can be made.
  explicit ForkServer(const MakeService& make);
  ForkServer(const ForkServer&) = delete;
  ForkServer& operator=(const ForkServer&) = delete;
  /// Ends its services, and whatever they have started.
  ~ForkServer();

 private:
  friend class ServedProcess;

  pid_t owner_, pid_ = -1;
  int socket_ = -1;
};

/// A service of a ForkServer. Any thread may use it, also in a process that was forked after the server, but
/// only one at a time.
class ServedProcess {
 public:
  /// An answer that takes longer than `time_limit` seconds counts as none. Errors: std::system_error when
  /// there is no socket, SurroundingsFailure when the server is gone.
  ServedProcess(const ForkServer& server, const std::vector<double>& setting, double time_limit);
  ServedProcess(const ServedProcess&) = delete;
  ServedProcess& operator=(const ServedProcess&) = delete;
  ~ServedProcess();

  /// Returns the answer. Errors: as ForkedService::ask(); SurroundingsFailure also if the process that waits
  /// for the service has ended, because no foreign code runs in it.
  std::vector<double> ask(const std::vector<double>& request);

 private:
  double time_limit_;
  int socket_ = -1;
};

}  // namespace mpm
