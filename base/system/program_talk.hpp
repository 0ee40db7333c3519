#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/system/child_process.hpp"

namespace mpm {

/// A program that answers each message, a JSON object, with another JSON object that repeats the number of
/// the message ("number"). A second answer to a message is ignored.
///
/// Like a ChildProcess, an object belongs to one thread, and to the process that made it.
class ProgramTalk {
 public:
  /// Starts the program. `place` is its name in messages; `time_limit`: seconds that an answer may take.
  /// Throws ChildFailure, and failures of the surroundings (is_of_surroundings()).
  ProgramTalk(std::string place, const std::vector<std::string>& command, double time_limit);

  /// Returns the answer to a message, without its number. The processor time that the program uses meanwhile
  /// is added to that of the thread (thread_clock.hpp). Throws ChildFailure, SurroundingsFailure, and
  /// InputError for a line that is no answer. After any of them the talk is out of step and cannot be
  /// continued.
  nlohmann::ordered_json ask(nlohmann::ordered_json message);

  /// Tells whether the talk belongs to this process. A process that was forked off cannot continue it.
  bool is_ours() const { return child_.is_ours(); }

 private:
  std::optional<nlohmann::ordered_json> answer_in(const std::string& line) const;

  std::string place_;
  double time_limit_;
  ChildProcess child_;
  std::int64_t number_ = 0;
};

}  // namespace mpm
