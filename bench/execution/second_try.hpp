#pragma once

#include <exception>

#include "base/system/surroundings.hpp"

namespace mpm {

/// What `work` returns. When its surroundings fail it (is_of_surroundings()), it is done once more, after
/// `prepare` has been told why; what happens then is thrown.
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
