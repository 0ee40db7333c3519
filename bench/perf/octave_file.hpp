#pragma once

#include <filesystem>

#include "bench/perf/qp_sequence.hpp"

namespace mpm {

/// Writes a sequence and the active-set answers to it as a text file that GNU Octave's `load` reads.
///
/// | variable                 | shape | meaning                                           |
/// |--------------------------|-------|---------------------------------------------------|
/// | hessian, rows            |       | as in QpStructure                                 |
/// | slack_of_row             | m x 1 | 1 for the first slack, 0 for a row without one    |
/// | slack_quadratic, slack_linear | q x 1 | as in QpStructure                            |
/// | gradient, lower, ...     | . x N | one column a program, as in QpData                |
/// | x                        | n x N | the answers                                       |
///
/// Throws InputError when the file cannot be written or the back end has no answer to a program.
void write_octave_file(const std::filesystem::path& path, const QpSequence& sequence);

}  // namespace mpm
