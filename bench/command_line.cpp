#include "bench/command_line.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/commands/commands.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "plants/system/program_trust.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {
namespace {

/// A word as a shell reads it back.
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

/// What is said of a first word that is neither a command nor an option; empty when it is one.
std::string unknown_command(const std::string& word, const CommandSet& commands) {
  const std::vector<std::string> names = commands.names();
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end())
    return "";
  return fmt::format("mpmbench: command: found {}; allowed: {}\n", with_nearest(word, names),
                     fmt::join(names, ", "));
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
    std::ostringstream text;
    const bool wrong_usage = program.exit(error, text, text) != 0;
    return {wrong_usage ? ExitCode::bad_input : ExitCode::done, text.str()};
  }
  if (!commands.has_work())
    return {ExitCode::bad_input, program.help()};
  return work(commands);
}

}  // namespace mpm
