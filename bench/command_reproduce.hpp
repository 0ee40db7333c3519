#pragma once

#include "bench/commands.hpp"
#include "bench/options.hpp"

namespace mpm {

/// Runs the studies behind the tables of the thesis, prints them beside ours and writes the page when one is
/// asked for. Done even when verdicts differ: they are results.
ExitCode reproduce_tables(const ReproduceCommand& command);

}  // namespace mpm
