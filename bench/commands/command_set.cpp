#include "bench/commands/command_set.hpp"

#include <algorithm>
#include <cassert>

#include <CLI/CLI.hpp>

namespace mpm {

CommandSet::CommandSet(CLI::App& program, std::string command_line)
    : program_(program), command_line_(std::move(command_line)) {}

CLI::App& CommandSet::add(const std::string& name, const std::string& description, Work work) {
  CLI::App* const app = program_.add_subcommand(name, description);
  app->group(task_);
  commands_.emplace_back(app, std::move(work));
  return *app;
}

std::vector<std::string> CommandSet::names() const {
  std::vector<std::string> names;
  for (const auto& command : commands_)
    names.push_back(command.first->get_name());
  return names;
}

bool CommandSet::has_work() const {
  return !program_.get_subcommands().empty();
}

ExitCode CommandSet::work() const {
  const auto named = std::find_if(commands_.begin(), commands_.end(),
                                  [](const auto& command) { return command.first->parsed(); });
  assert(named != commands_.end());
  return named->second();
}

}  // namespace mpm
