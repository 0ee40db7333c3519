#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/mismatch_responses.hpp"

namespace mpm {

/// What a channel whose dynamics are wrong in any way adds to the simulation error of its CV, in the span of
///
///   x = G0 u,   x / (T s + 1),   T = 1, 2, 4 ... samples up to an eighth of the record
///
/// as far as it is linear: with two lags of T, 1 - 2 / (T s + 1) has an inverse response, or the dead time 2
/// T by Pade, and a further lag or one that is missing is a sum of few of them. A coefficient of 1 is an
/// error of the size of the channel. One matrix for each channel with a gain among `responses`, rows x N, in
/// CV units.
///
/// | symbol | name    | shape         |
/// |--------|---------|---------------|
/// | u      | inputs  | (nu + nd) x N |
std::vector<Eigen::MatrixXd> any_shape_rows(const std::vector<MismatchResponses>& responses,
                                            const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                            const Eigen::Ref<const Eigen::VectorXd>& initial);

}  // namespace mpm
