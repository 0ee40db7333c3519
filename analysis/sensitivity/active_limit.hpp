#pragma once

namespace mpm {

// Whether a signal of the controller is at one of its limits. Targets and moves are exact to the tolerance of
// the solver; a limit counts as met well above that, within 1e-5 of max(1, |limit|), in the unit of the
// signal. An infinite limit is never met.

/// |value - limit| is within the tolerance.
bool at_limit(double value, double limit);
/// The value is at the lower limit or below it.
bool at_or_below(double value, double lower);
/// The value is at the upper limit or above it.
bool at_or_above(double value, double upper);

}  // namespace mpm
