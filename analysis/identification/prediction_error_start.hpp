#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"
#include "analysis/identification/prediction_error_options.hpp"

namespace mpm {

/// Order of the longest ARX model that a start comes from.
inline constexpr Eigen::Index kLongestArx = 25;
/// Rounds of Steiglitz and McBride's iteration.
inline constexpr int kReductionRounds = 12;

/// First guesses for `identify_prediction_error`, the one with the smallest loss first; all within
/// `options.largest_radius`. There is one guess for each of a few orders of the ARX model from which it is
/// made:
///
/// 1. ARX of high order, A y = sum_j B_j u_j + e, which describes any linear system with any noise;
/// 2. the part of each input alone, w_j = B_j/A u_j, free of noise, reduced to the wanted orders by the
///    iteration of Steiglitz and McBride (1965): least squares on w_j and u_j filtered by 1/F of the last
///    round. Every path gets an F of its own, which the iteration on y itself could not give;
/// 3. all B_j again by least squares on y, with the F_j known;
/// 4. C and D from v = y - sum_j B_j/F_j u_j by Hannan and Rissanen (1982): innovations from a long
///    autoregression, then v regressed on past v and innovations.
///
/// Data and order must have passed `require_identification_data`.
std::vector<PolynomialModel> prediction_error_starts(const Eigen::Ref<const Eigen::VectorXd>& y,
                                                     const Eigen::Ref<const Eigen::MatrixXd>& u,
                                                     const ModelOrder& order,
                                                     const PredictionErrorOptions& options);

}  // namespace mpm
