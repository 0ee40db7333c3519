#pragma once

#include <string>
#include <string_view>

#include "bench/outcome/experiment_outcome.hpp"

namespace mpm {

/// An outcome as bytes, for the way between a process and its workers.
std::string to_bytes(const ExperimentOutcome& outcome);

/// The outcome again. Throws std::runtime_error when the bytes are too short or too long.
ExperimentOutcome outcome_from_bytes(std::string_view bytes);

}  // namespace mpm
