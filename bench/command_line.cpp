#include "bench/command_line.hpp"

#include <exception>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"

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
  return {code, fmt::format("mpmbench: {}\n", error.what())};
}

CommandResult work(const CommandSet& commands) {
  try {
    return {commands.work(), ""};
  } catch (const InputError& error) {
    return complaint(ExitCode::bad_input, error);
  } catch (const BadArchive& error) {
    return complaint(ExitCode::bad_input, error);
  } catch (const std::exception& error) {
    return complaint(ExitCode::not_finished, error);
  }
}

}  // namespace

CommandResult execute(int argc, const char* const* argv) {
  CLI::App program("mpmbench: a Monte Carlo robustness testbench for the assessment of MPC models",
                   "mpmbench");
  program.set_version_flag("--version", fmt::format("mpmbench {} ({})\n{}", mpmbench_version(),
                                                    source_revision(), library_versions()));
  program.require_subcommand(1);
  CommandSet commands(program, joined(argc, argv));
  for (AddCommand* const add : kCommands)
    add(commands);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const bool wrong_usage = program.exit(error, text, text) != 0;
    return {wrong_usage ? ExitCode::bad_input : ExitCode::done, text.str()};
  }
  return work(commands);
}

}  // namespace mpm
