#pragma once

#include <Eigen/Core>

#include "analysis/identification/model_order.hpp"

namespace mpm {

/// Refuses data that no model of these orders can be identified from: other than nu rows, different lengths,
/// values that are not finite, no parameter, or no more samples from `first_sample` on than parameters.
/// @throws InputError naming what was found and what is allowed
void require_identification_data(const Eigen::Ref<const Eigen::VectorXd>& y,
                                 const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                                 Eigen::Index first_sample);

}  // namespace mpm
