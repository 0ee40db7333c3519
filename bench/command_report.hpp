#pragma once

#include "bench/commands.hpp"
#include "bench/options.hpp"

namespace mpm {

/// `mpmbench report`: the page, the figures as files, or both, of an archive.
ExitCode report(const ReportCommand& command);

}  // namespace mpm
