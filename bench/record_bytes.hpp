#pragma once

#include <string>
#include <string_view>

#include "analysis/experiment/experiment.hpp"

namespace mpm {

/// An experiment record as bytes, for the way from a worker process to its parent: both are the same program
/// on the same machine, so every number keeps its bits.
std::string to_bytes(const ExperimentRecord& record);

/// The record again. Throws std::runtime_error when the bytes are too short or too long.
ExperimentRecord record_from_bytes(std::string_view bytes);

}  // namespace mpm
