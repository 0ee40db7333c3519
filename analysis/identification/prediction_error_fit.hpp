#pragma once

#include <Eigen/Core>

#include "analysis/identification/arx.hpp"
#include "analysis/identification/identification.hpp"
#include "analysis/identification/prediction_error_options.hpp"

namespace mpm {

/// Fits an output-error model (nc = nd = 0) or a Box-Jenkins model of an output by minimising the sum of
/// squares of its prediction errors (Ljung 1999, chapter 7). For Gaussian innovations this is the
/// maximum-likelihood estimate, given what was before the record.
///
/// | symbol | meaning | shape  |
/// |--------|---------|--------|
/// | y      | output, deviation from the operating point | N      |
/// | u      | inputs, deviations from it                 | nu x N |
///
/// The search starts from the best of `prediction_error_starts`, and from the next one if it does not end at
/// a minimum of the loss. A minimum has a relative offset below 1e-4 (its square below 1e-8): the
/// coefficients are within 1e-4 sqrt(n) standard errors of it. C, D and F stay stable. If the prediction
/// errors are below 1e-9 of the output, there is no noise to describe: C and D are 1 and their rows of the
/// covariance 0.
///
/// The result depends on the data alone, bit for bit.
/// @throws InputError for an order with A or without a parameter, or for another number of inputs; different
///   lengths, values that are not finite, no more samples than parameters; invalid options
Identification identify_prediction_error(const Eigen::Ref<const Eigen::VectorXd>& y,
                                         const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                                         const PredictionErrorOptions& options = {});

/// Fits a model of any family: by the linear regression if the order is that of an ARX model, by
/// `identify_prediction_error` otherwise. The regression does not use `start`; its first sample is
/// `options.first_sample`, or `ModelOrder::memory` if that is later.
/// @throws InputError as these two
Identification identify(const Eigen::Ref<const Eigen::VectorXd>& y,
                        const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                        const PredictionErrorOptions& options = {});

}  // namespace mpm
