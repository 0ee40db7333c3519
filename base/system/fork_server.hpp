#pragma once

#include <functional>
#include <vector>

#include <sys/types.h>

#include "base/system/forked_service.hpp"

namespace mpm {

/// A process that makes processes for threads. A fork copies the memory of a process as it is, with the locks
/// that other threads hold at that moment; nobody releases these in the copy. This process is forked once,
/// while no other thread is at work, has one thread itself, and forks whenever it is asked to.
///
/// Each service has two processes, both of its making: one that does the work, and one that waits for it,
/// ends it when it takes too long or its user is gone, and says how it ended (ForkedService). Whatever the
/// first one has started, in whatever session, ends with its service: the second one reaps it or, if the
/// second one was killed, the server does.
class ForkServer {
 public:
  /// What a service that is made with this setting does; called in its process.
  using MakeService = std::function<ForkedService::Serve(const std::vector<double>& setting)>;

  /// Forks; call it before any thread runs. Errors: std::system_error if no process can be made.
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

/// A service of a ForkServer, which may be used by any thread, and in any process that was forked after the
/// server: one at a time.
class ServedProcess {
 public:
  /// An answer that takes longer than `time_limit` seconds counts as none. Errors: std::system_error when
  /// there is no socket, SurroundingsFailure when the server is gone.
  ServedProcess(const ForkServer& server, const std::vector<double>& setting, double time_limit);
  ServedProcess(const ServedProcess&) = delete;
  ServedProcess& operator=(const ServedProcess&) = delete;
  ~ServedProcess();

  /// The answer. Errors: as ForkedService::ask(); SurroundingsFailure also when the process that waits for
  /// the service has ended, because no code of others runs in it.
  std::vector<double> ask(const std::vector<double>& request);

 private:
  double time_limit_;
  int socket_ = -1;
};

}  // namespace mpm
