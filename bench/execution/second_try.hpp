#pragma once

#include <exception>

#include "base/system/surroundings.hpp"

namespace mpm {

/// Returns what `work` returns. If the surroundings of the work fail (is_of_surroundings()), tells `prepare`
/// why and does the work once more. Throws what goes wrong then.
template <class Work, class Prepare>
auto second_try(const Work& work, const Prepare& prepare) {
  try {
    return work();
  } catch (const std::exception& error) {
    if (!is_of_surroundings(error))
      throw;
    prepare(error);
  }
  return work();
}

}  // namespace mpm
