#pragma once

namespace mpm {

// Tests whether a signal of the controller is at one of its limits. Targets and moves are exact to the
// tolerance of the solver. A limit counts as met within a tolerance well above that, 1e-5 max(1, |limit|) in
// the unit of the signal. An infinite limit is never met.

/// Returns whether |value - limit| is within the tolerance.
bool at_limit(double value, double limit);
/// Returns whether the value is at the lower limit or below it.
bool at_or_below(double value, double lower);
/// Returns whether the value is at the upper limit or above it.
bool at_or_above(double value, double upper);

}  // namespace mpm
