#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "scenarios/study/study.hpp"

// What no record can tell from a model: where the operating point is, and what was before the record.

namespace mpm {

/// The first samples after at least `settling` samples without any CV: what moved the CVs before them is not
/// known. y is ny x N.
std::vector<Eigen::Index> starts_after_unknown(const Eigen::MatrixXd& y, Eigen::Index settling);

/// The columns of what no record can tell in the simulation errors y - y_sim of a CV, one row a sample: a
/// constant, and exp(-(k - k_m) Ts / T) from each start k_m on, for each time constant T of its channels.
Eigen::MatrixXd untold_columns(const Study& study, Eigen::Index cv, const std::vector<Eigen::Index>& starts,
                               Eigen::Index samples);

/// Returns whether the first `settling` samples of a record that seems to begin at rest show that it does
/// not: MVs may happen to pass the operating point. With e = y - y_sim of some CV and m the mean of its later
/// errors, they do if
///
///   mean (e - m)^2 of the first samples > 2 mean (e - m)^2 of the later ones
///
/// White noise of 30 samples against 300 does so in 1 of 1000 records.
bool shows_a_past(const AssessedLoop& loop, Eigen::Index settling);

}  // namespace mpm
