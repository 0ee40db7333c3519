#pragma once

#include <string>

#include "bench/commands.hpp"

namespace mpm {

/// `mpmbench run`: runs a study, writes its archive and prints its summary. Finished experiments wait in
/// shards beside the archive (docs/resume.md), which are removed when it is written.
///
/// Throws InputError and the errors of run_campaign() and write_archive(); when shards are left, with the
/// command that resumes in the text.
ExitCode run(const RunCommand& command, const std::string& command_line);

}  // namespace mpm
