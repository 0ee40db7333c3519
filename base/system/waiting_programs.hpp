#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/system/program_talk.hpp"

namespace mpm {

/// A program that runs.
struct RunningProgram {
  RunningProgram(const std::string& place, const std::vector<std::string>& command, double time_limit)
      : talk(place, command, time_limit) {}

  ProgramTalk talk;
  bool is_new = true;        ///< it has not been asked yet
  std::string context = {};  ///< context that it was told last; empty: none
};

/// The processes of one program that wait to be asked. Starting one may take as long as a hundred answers, so
/// a process outlives the caller that asks it and waits for the next caller in this process. All calls may
/// come from any thread.
class WaitingPrograms {
 public:
  /// Takes the arguments of a ProgramTalk; starts nothing.
  WaitingPrograms(std::string place, std::vector<std::string> command, double time_limit);

  const std::vector<std::string>& command() const { return command_; }
  double time_limit() const { return time_limit_; }

  /// Returns a process that waits, if possible one that was told this context last; if none waits, a new one.
  /// Processes that belong to the process from which this one was forked do not count. Errors: as
  /// ProgramTalk.
  std::unique_ptr<RunningProgram> take(const std::string& context);
  std::unique_ptr<RunningProgram> take_new() const;
  /// Takes back a process that is in step: nothing has gone wrong with it.
  void give_back(std::unique_ptr<RunningProgram> program);
  /// Ends the processes that wait: their surroundings have failed.
  void end_all();

 private:
  const std::string place_;
  const std::vector<std::string> command_;
  const double time_limit_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<RunningProgram>> waiting_;
};

}  // namespace mpm
