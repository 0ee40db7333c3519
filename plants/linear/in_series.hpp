#pragma once

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// G_1(s) G_2(s): the output of the one is the input of the other. A washout stays, of the second if both
/// have one. So do the coefficients of a step response; of two that have them the first is taken as its
/// rational form. Errors: InputError for more than kMaxDelay coefficients.
TransferFunction in_series(const TransferFunction& first, const TransferFunction& second);

}  // namespace mpm
