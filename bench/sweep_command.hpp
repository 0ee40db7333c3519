#pragma once

#include <string>

#include "bench/options.hpp"

namespace mpm {

/// Runs every study of a sweep and writes its archive, one after the other, and at the end the table of all
/// of them (`sweep.md`, and on stdout). A study whose basis case fails its self-check is run all the same and
/// marked in the table: how much a choice matters is the question here.
///
/// Throws InputError for a sweep that is none, ArchiveError when an archive cannot be written.
void run_sweep(const SweepCommand& command, const std::string& command_line);

}  // namespace mpm
