#pragma once

#include <cmath>
#include <functional>
#include <iterator>
#include <string>

#include "base/error.hpp"
#include "base/non_finite.hpp"

// Choices among candidates by a number that may be NaN. The analysis makes every such choice here, so that no
// choice points past the end of its candidates.

namespace mpm {

/// Returns an iterator to the candidate with the largest `value`, the first of them if several are equal.
/// Candidates whose value is NaN or -infinity do not count; if no other is left, returns the end. To find the
/// smallest value, negate it.
template <class Candidates, class Value = std::identity>
auto best_candidate(const Candidates& candidates, Value value = {}) {
  const auto end = std::end(candidates);
  auto best = end;
  double largest = -kInfinity;
  for (auto each = std::begin(candidates); each != end; ++each)
    if (const auto found = static_cast<double>(std::invoke(value, *each)); found > largest) {
      largest = found;
      best = each;
    }
  return best;
}

/// best_candidate() where a candidate is required. Throws InputError, with the name of the values, if no
/// candidate is left.
template <class Candidates, class Value = std::identity>
auto required_best_candidate(const std::string& values, const Candidates& candidates, Value value = {}) {
  const auto best = best_candidate(candidates, value);
  if (best == std::end(candidates))
    throw InputError(values, "no number", "one or more");
  return best;
}

/// The larger of the two; NaN if one of them is NaN.
inline double larger_or_nan(double a, double b) {
  return a >= b || std::isnan(a) ? a : b;
}

}  // namespace mpm
