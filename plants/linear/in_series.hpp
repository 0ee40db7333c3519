#pragma once

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// G_1(s) G_2(s): the output of the first is the input of the second. A washout is kept; if both have one,
/// the washout of the second is kept. If one of them has the coefficients of a step response, so has the
/// result; if both have, the rational form of the first is used. Errors: InputError for more than kMaxDelay
/// coefficients.
TransferFunction in_series(const TransferFunction& first, const TransferFunction& second);

}  // namespace mpm
