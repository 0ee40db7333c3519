#pragma once

#include "bench/commands.hpp"

namespace mpm {

/// Assesses the loops of an archive by several methods, prints how often each is right, and writes the
/// archive with the comparison when an output is asked for. Loops that the archive has not kept are run again
/// from (study, seed, index). Throws InputError and BadArchive, before anything is written.
ExitCode compare(const CompareCommand& command, const std::string& command_line);

}  // namespace mpm
