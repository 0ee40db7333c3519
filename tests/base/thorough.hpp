#pragma once

#include <cstdlib>

namespace mpm::testing {

/// `./test.sh --all`: tests of many random or damaged inputs take all of them, and not a sample.
inline bool is_thorough() {
  return std::getenv("MPMBENCH_TEST_ALL") != nullptr;
}

}  // namespace mpm::testing
