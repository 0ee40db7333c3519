#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <sys/types.h>

#include "base/system/forked_process.hpp"

namespace mpm {

/// A function that runs in its own process, so that a crash, a call that never returns and everything that
/// the function leaves in memory end with this process.
///
/// The process is a copy of the calling one, with its own session; its output goes nowhere, and it writes no
/// core. What it sends is not trusted: it may write anything into its socket. If there are other threads, a
/// ForkServer must make the service (fork_process()).
class ForkedService {
 public:
  /// Takes numbers and returns numbers; its exceptions become those of ask().
  using Serve = std::function<std::vector<double>(const std::vector<double>&)>;

  static constexpr std::size_t kMostNumbers = std::size_t{1} << 17;  ///< of an answer (default)

  /// An answer that takes longer than `time_limit` seconds, or that has more numbers than `most`, counts as
  /// none. Errors: std::system_error when no process can be made.
  ForkedService(const Serve& serve, double time_limit, std::size_t most = kMostNumbers);
  ForkedService(const ForkedService&) = delete;
  ForkedService& operator=(const ForkedService&) = delete;
  ~ForkedService();

  /// Returns the answer. Errors: ForeignFailure with what the function threw, how its process ended, or that
  /// the time was up; after the last two the process is gone, with all of its group. The process is
  /// also ended at once if the other end of `user`, the socket for which the answer is meant, is gone.
  /// SurroundingsFailure if somebody has killed the process, or if the function threw a failure of the
  /// surroundings.
  std::vector<double> ask(const std::vector<double>& request, int user = -1);

 private:
  void end();
  [[noreturn]] void fail_by_end();

  double time_limit_;
  std::size_t most_;
  pid_t pid_ = -1;
  int socket_ = -1;
};

}  // namespace mpm
