#pragma once

#include <cstddef>
#include <vector>

namespace mpm {

/// Rows of a recorded signal whose values cannot be measurements; NaN is no value.
///
/// The core of a signal are its values between the quantiles of 5 and 95 %, and all that follow on without a
/// large gap; `lower` and `upper`, its hard limits, belong to it where both are finite. Beyond it are
///
/// - fillers: values that programs write for a missing one (-9999 and other nines, -999.25, the ends of
///   integers of 16 and 32 bits, 1e20 and above), when the gap to the core is 10 times as wide as the core;
///   of a signal that is `measured`, and has no few levels, also round values (100 and above, of one or two
///   digits) that stand there twice or more;
/// - spikes: any other values, when the gap is 1000 times as wide as the core, of at most 5 rows between two
///   of the core.
///
/// A core without width, as of a valve that moves seldom, has fillers only.
std::vector<std::size_t> implausible_rows(const std::vector<double>& values, double lower, double upper,
                                          bool measured = false);

}  // namespace mpm
