#pragma once

#include <cstddef>
#include <vector>

namespace mpm {

/// Returns the rows of a recorded signal whose values cannot be measurements. NaN is no value.
///
/// The core of a signal is the range of its values between the quantiles of 5 and 95 %, and of all values
/// that follow without a large gap. The hard limits `lower` and `upper` also belong to the core if both are
/// finite. Implausible values lie outside the core:
///
/// - fillers: values that programs write for a missing one (-9999 and other nines, -999.25, the ends of
///   integers of 16 and 32 bits, 1e20 and above), if the gap to the core is more than 10 times the width of
///   the core. If the signal is `measured` and has more than a few levels, round values (100 and above, of
///   one or two digits) are fillers as well if they occur at least twice;
/// - spikes: any other values, if the gap is more than 1000 times the width of the core, in at most 5 rows
///   between two rows of the core.
///
/// A core without width, such as that of a valve that moves seldom, has fillers but no spikes.
std::vector<std::size_t> implausible_rows(const std::vector<double>& values, double lower, double upper,
                                          bool measured = false);

}  // namespace mpm
