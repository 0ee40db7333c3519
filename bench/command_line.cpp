#include "bench/command_line.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/system/program_trust.hpp"
#include "base/system/surroundings.hpp"
#include "bench/commands/commands.hpp"
#include "bench/console/stop_signals.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/version.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

/// A word, quoted so that a shell reads it back.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./,:=+@%-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos)
    return word;
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string joined(int argc, const char* const* argv) {
  std::string line = "mpmbench";
  for (int i = 1; i < argc; ++i)
    line.append(" ").append(quoted(argv[i]));
  return line;
}

CommandResult complaint(ExitCode code, const std::exception& error) {
  return {code, fmt::format("mpmbench: {}\n", what_happened(error))};
}

CommandResult work(const CommandSet& commands) {
  try {
    stop_with_served_process();
    return {commands.work(), ""};
  } catch (const InputError& error) {
    return complaint(ExitCode::bad_input, error);
  } catch (const BadArchive& error) {
    return complaint(ExitCode::bad_input, error);
  } catch (const UntrustedProgram& error) {
    return complaint(ExitCode::bad_input, error);
  } catch (const std::exception& error) {
    return complaint(ExitCode::not_finished, error);
  }
}

/// The message about a first word that is neither a command nor an option; empty if it is one of them.
std::string unknown_command(const std::string& word, const CommandSet& commands) {
  const std::vector<std::string> names = commands.names();
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end())
    return "";
  return fmt::format("mpmbench: command: found {}; allowed: {}\n", with_nearest(word, names),
                     fmt::join(names, ", "));
}

/// The first word that no option or argument of the command takes, an option before other words; empty if
/// there is none.
std::string unknown_word(const CLI::App& command) {
  const std::vector<std::string> words = command.remaining();
  const auto option =
      std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.starts_with('-'); });
  return option != words.end() ? option->substr(0, option->find('=')) : words.empty() ? "" : words.front();
}

/// The names of the options of a command and of its groups, such as "--methods" and "-o".
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* const group : command.get_subcommands({}))
    if (group->get_name().empty())
      for (std::string& name : option_names(*group))
        names.push_back(std::move(name));
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
    for (const std::string& name : option->get_snames())
      names.push_back("-" + name);
  }
  return names;
}

/// The message about what is wrong with the words after the command.
std::string wrong_usage(const CLI::App& command, const CLI::ParseError& error) {
  const std::string help =
      fmt::format("mpmbench{} --help", command.get_parent() == nullptr ? "" : " " + command.get_name());
  if (const std::string word = unknown_word(command); !word.empty())
    return fmt::format("mpmbench: {}: found {}; allowed: those of `{}`\n",
                       word.starts_with('-') ? "option" : "argument",
                       with_nearest(word, option_names(command)), help);
  std::string text = error.what();
  for (const char* behind_name :
       {" is required", ": 1 required"})  // what CLI11 says if an option or its value is missing
    if (const std::size_t end = text.find(behind_name); end != std::string::npos)
      if (const CLI::Option* const option = command.get_option_no_throw(text.substr(0, end)))
        text = fmt::format("{}: found nothing; allowed: {}", text.substr(0, end), option->get_description());
  return fmt::format("mpmbench: {}\n{} lists the options\n", text, help);
}

}  // namespace

CommandResult execute(int argc, const char* const* argv) {
  CLI::App program("mpmbench: a Monte Carlo robustness testbench for the assessment of MPC models",
                   "mpmbench");
  program.set_version_flag("--version", fmt::format("mpmbench {} ({})\n{}", mpmbench_version(),
                                                    source_revision(), library_versions()));
  program.require_subcommand(0, 1);
  program.get_formatter()->label("SUBCOMMAND", "COMMAND");
  program.footer(
      "mpmbench COMMAND --help lists the options of a command.\n"
      "Exit codes: 0 done, 1 a replay differs or a gate fails, 2 wrong input, 3 not finished, or output "
      "lost");
  CommandSet commands(program, joined(argc, argv));
  for (const Task& task : tasks()) {
    commands.begin_task(task.name);
    for (AddCommand* const add : task.commands)
      add(commands);
  }
  if (argc > 1)
    if (std::string trouble = unknown_command(argv[1], commands); !trouble.empty())
      return {ExitCode::bad_input, std::move(trouble)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::vector<CLI::App*> named = program.get_subcommands();
    if (error.get_exit_code() != 0)
      return {ExitCode::bad_input, wrong_usage(named.empty() ? program : *named.front(), error)};
    std::ostringstream text;
    program.exit(error, text, text);
    return {ExitCode::done, text.str()};
  }
  if (!commands.has_work())
    return {ExitCode::bad_input, program.help()};
  return work(commands);
}

}  // namespace mpm
