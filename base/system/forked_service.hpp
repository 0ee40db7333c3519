#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <sys/types.h>

#include "base/system/forked_process.hpp"

namespace mpm {

/// A function that runs in a process of its own, so that a crash, a call that never returns and everything
/// that it leaves in memory end with this process.
///
/// The process is a copy of this one, with a session of its own; what it prints goes nowhere, and it writes
/// no core. What it sends is not trusted: it may write into its socket whatever it likes. It is to be made
/// where there are no other threads (fork_process); where there are, a ForkServer makes it.
class ForkedService {
 public:
  /// Numbers in, numbers out; its exceptions become those of ask().
  using Serve = std::function<std::vector<double>(const std::vector<double>&)>;

  static constexpr std::size_t kMostNumbers = std::size_t{1} << 17;  ///< of an answer, unless it is said

  /// An answer that takes longer than `time_limit` seconds counts as none, as does one of more numbers than
  /// `most`. Errors: std::system_error when no process can be made.
  ForkedService(const Serve& serve, double time_limit, std::size_t most = kMostNumbers);
  ForkedService(const ForkedService&) = delete;
  ForkedService& operator=(const ForkedService&) = delete;
  ~ForkedService();

  /// The answer. Errors: ForeignFailure with what the function threw, how its process ended, or that the time
  /// was up; after the last two the process is gone, with all of its group. The same happens at once when the
  /// other end of the socket `user`, for which the answer is, is gone. SurroundingsFailure when somebody has
  /// killed the process, and when what the function threw was of the surroundings.
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
