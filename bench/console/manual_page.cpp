#include "bench/console/manual_page.hpp"

#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mpm {
namespace {

using Commands = std::vector<const CLI::App*>;
using Options = std::vector<const CLI::Option*>;

constexpr std::string_view kEnding = R"(.SH EXIT STATUS
.TP
0
Done.
.TP
1
A replay differs from its archive, or a gate is not kept.
.TP
2
Wrong usage or wrong input; the message names the file, the key, what was found and what is allowed.
.TP
3
Not finished: the command was interrupted, something failed, or output on stdout was lost. Finished work is kept, and \-\-resume continues.
.SH ENVIRONMENT
.TP
MPMBENCH_CACHE
Folder in which loops are kept for the next suite, sweep or comparison, or off (default: mpmbench in XDG_CACHE_HOME or ~/.cache).
.TP
MPMBENCH_CACHE_MB
Its largest size in megabytes (default: 2000).
.TP
MPMBENCH_STUDIES
Folder of the shipped studies (default: the one beside the program).
)";

Commands commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// What a user may type: an option without a group is hidden from the help, and so from here.
Options options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

/// Text that roff shows as it is: a hyphen that can be copied, no escapes, no request at the start of a line.
std::string as_roff(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    if (c == '-')
      shown += "\\-";
    else if (c == '\\')
      shown += "\\e";
    else
      shown += c;
  }
  return shown.starts_with('.') || shown.starts_with('\'') ? fmt::format("\\&{}", shown) : shown;
}

/// "\fB\-o\fR, \fB\-\-output\fR \fIVALUE\fR"
std::string synopsis_of(const CLI::Option& option) {
  if (!option.nonpositional())
    return fmt::format("\\fI{}\\fR", as_roff(option.get_name(true)));
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames())
    names.push_back(fmt::format("\\fB\\-{}\\fR", as_roff(name)));
  for (const std::string& name : option.get_lnames())
    names.push_back(fmt::format("\\fB\\-\\-{}\\fR", as_roff(name)));
  const bool takes_a_value = option.get_expected_max() > 0 && option.get_type_size_max() > 0;
  return fmt::format("{}{}", fmt::join(names, ", "), takes_a_value ? " \\fIVALUE\\fR" : "");
}

std::string roff_of(const CLI::Option& option) {
  std::string text = fmt::format(".TP\n{}\n{}", synopsis_of(option), as_roff(option.get_description()));
  if (!option.get_default_str().empty())
    text += as_roff(fmt::format(" (default: {})", option.get_default_str()));
  return text + ".\n";
}

std::string roff_of(const CLI::App& command) {
  std::string text =
      fmt::format(".SS {}\n{}.\n", as_roff(command.get_name()), as_roff(command.get_description()));
  for (const CLI::Option* const option : options_of(command))
    text += roff_of(*option);
  return text;
}

/// The options of a command as one types them.
std::vector<std::string> typed_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : options_of(command))
    for (const std::string& name : option->get_lnames())
      names.push_back(fmt::format("--{}", name));
  return names;
}

}  // namespace

std::string manual_page(const CLI::App& program, const std::string& version) {
  std::string text = fmt::format(
      ".TH MPMBENCH 1 \"\" \"mpmbench {}\" \"User Commands\"\n.SH NAME\nmpmbench \\- a Monte Carlo "
      "robustness "
      "testbench for the assessment of MPC models\n.SH SYNOPSIS\n.B mpmbench\n\\fICOMMAND\\fR "
      "[\\fIOPTION\\fR]...\n.SH COMMANDS\n",
      as_roff(version));
  for (const CLI::App* const command : commands_of(program))
    text += roff_of(*command);
  return text.append(kEnding);
}

std::string bash_completion(const CLI::App& program) {
  std::vector<std::string> names;
  std::string cases;
  for (const CLI::App* const command : commands_of(program)) {
    names.push_back(command->get_name());
    cases += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(),
                         fmt::join(typed_options(*command), " "));
  }
  return fmt::format(R"(# Completion of mpmbench in bash, made by `mpmbench completion`.
_mpmbench() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options=
  case ${{COMP_WORDS[1]}} in
{}  esac
  if ((COMP_CWORD == 1)); then
    options="{} {}"
  elif [[ $word != -* ]]; then
    # Files, where no study begins like the word (-o default below).
    options=$(mpmbench list 2>/dev/null | cut -d' ' -f1)
  fi
  mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
}}
complete -o bashdefault -o default -F _mpmbench mpmbench
)",
                     cases, fmt::join(names, " "), fmt::join(typed_options(program), " "));
}

}  // namespace mpm
