#pragma once

#include <string>

namespace CLI {
class App;
}

namespace mpm {

/// The manual page of a program, section 1, in roff (man(7)): every command with its options, as the command
/// line declares them, exit codes and environment.
std::string manual_page(const CLI::App& program, const std::string& version);

/// A bash script that completes the commands of a program, their options, the names of the shipped studies,
/// and files everywhere else.
std::string bash_completion(const CLI::App& program);

}  // namespace mpm
