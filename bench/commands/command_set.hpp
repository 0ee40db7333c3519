#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/console/exit_code.hpp"

namespace CLI {
class App;
}

namespace mpm {

/// The commands of the program, and what each of them does.
class CommandSet {
 public:
  /// Runs the command with the options that were read: results on stdout, progress on stderr. Its exceptions
  /// become messages and exit codes in execute().
  using Work = std::function<ExitCode()>;

  /// `program` must outlive it. `command_line` is what the user has typed.
  CommandSet(CLI::App& program, std::string command_line);

  /// The task under which the help lists the commands that are added from here on.
  void begin_task(std::string task) { task_ = std::move(task); }

  /// Adds a command; declare its options in the returned object.
  CLI::App& add(const std::string& name, const std::string& description, Work work);

  /// All commands and options that the command line declares.
  const CLI::App& program() const { return program_; }

  /// What the user has typed, quoted so that a shell reads it back. Archives contain it.
  const std::string& command_line() const { return command_line_; }

  /// The names of all commands.
  std::vector<std::string> names() const;

  /// Whether the user has named a command.
  bool has_work() const;

  /// Runs the command that the user has named; there must be one.
  ExitCode work() const;

 private:
  CLI::App& program_;
  std::string command_line_, task_;
  std::vector<std::pair<const CLI::App*, Work>> commands_;
};

}  // namespace mpm
