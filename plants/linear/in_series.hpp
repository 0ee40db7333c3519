#pragma once

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// G_1(s) G_2(s): the output of one is the input of the other. A washout is kept; if both have one, that of
/// the second. Coefficients of a step response are kept too; if both have some, the first is taken as its
/// rational form. Errors: InputError for more than kMaxDelay coefficients.
TransferFunction in_series(const TransferFunction& first, const TransferFunction& second);

}  // namespace mpm
