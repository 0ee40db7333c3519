#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/mismatch_responses.hpp"

namespace mpm {

/// The signals that span what a channel adds to the simulation error of its CV if its dynamics are wrong in
/// any way:
///
///   x = G0 u,   x / (T s + 1),   T = 1, 2, 4 ... samples up to an eighth of the record
///
/// as far as it is linear. 2 / (T s + 1) - 1 is an inverse response, which is also Pade's approximation of a
/// dead time of 2 T; a further lag is one of these signals, and a missing lag is a sum of a few. A
/// coefficient of 1 is an error of the size of the channel. Returns one matrix for each channel with a gain
/// among `responses`, rows x N, in CV units.
///
/// | symbol | name    | shape         |
/// |--------|---------|---------------|
/// | u      | inputs  | (nu + nd) x N |
std::vector<Eigen::MatrixXd> any_shape_rows(const std::vector<MismatchResponses>& responses,
                                            const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                            const Eigen::Ref<const Eigen::VectorXd>& initial);

}  // namespace mpm
