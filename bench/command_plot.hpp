#pragma once

#include "bench/commands.hpp"
#include "bench/options.hpp"

namespace mpm {

/// `mpmbench plot`: the closed loop of one experiment of an archive as a figure. A loop that the archive does
/// not keep is simulated again from study, seed and index.
ExitCode plot(const PlotCommand& command);

}  // namespace mpm
