#pragma once

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// The time constant that a first-order channel would need to be as slow: -sum 1/p over the poles p.
double sum_of_time_constants(const TransferFunction& channel);

/// Dead time and three times that: 95 % of a step of a first-order channel. 0 of a channel that is zero.
double settling_time(const TransferFunction& channel);

}  // namespace mpm
