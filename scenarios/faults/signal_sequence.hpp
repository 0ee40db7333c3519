#pragma once

#include <cstdint>

namespace mpm {

/// Which experiments of a study have the same random numbers in a signal.
enum class SignalSequence : std::int8_t {
  each = 0,    ///< none: every experiment draws its own
  shared = 1,  ///< all: one sequence, drawn once for the study (kSharedIndex)
};

}  // namespace mpm
