#pragma once

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// The time constant of a first-order channel that is as slow: -sum 1/p over the poles p other than 0.
double sum_of_time_constants(const TransferFunction& channel);

/// Dead time plus three times that sum: the time to 95 % of the step response of a first-order channel. 0 for
/// a channel that is zero.
double settling_time(const TransferFunction& channel);

}  // namespace mpm
