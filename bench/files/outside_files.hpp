#pragma once

#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

// What decides a result but is not in the study file: programs and FMUs of somebody else, by the content of
// their files.

namespace mpm {

/// "python3 -B mine.py (mine.py 0123456789abcdef)": a command, and a digest of each of its words that is a
/// file in the current folder or a path from there. The program itself counts if it is a path; a program that
/// is looked for in PATH is known by its name only.
std::string command_identity(const std::vector<std::string>& command);

/// The same for what the study takes from outside: "plant.fmu tank.fmu 0123456789abcdef", "plant.program
/// COMMAND", "controller.program COMMAND", with "; " between them. Empty when it takes nothing.
std::string outside_files(const Study& study);

}  // namespace mpm
