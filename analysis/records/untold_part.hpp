#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenarios/study/study.hpp"

// What no record can tell from a model: where the operating point is, and what was before the record.

namespace mpm {

/// The first samples after so many without any CV: what moved the CVs before them is not known. y is ny x N.
std::vector<Eigen::Index> starts_after_unknown(const Eigen::MatrixXd& y, Eigen::Index settling);

/// What the simulation errors y - y_sim of a CV may have of it, one row a sample: a constant, and
/// exp(-(k - k_m) Ts / T) from each start k_m on, for each T of its channels.
Eigen::MatrixXd untold_columns(const Study& study, Eigen::Index cv, const std::vector<Eigen::Index>& starts,
                               Eigen::Index samples);

}  // namespace mpm
