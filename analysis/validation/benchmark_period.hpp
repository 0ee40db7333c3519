#pragma once

#include <utility>

#include <Eigen/Core>

namespace mpm {

/// The share of a record that is sought as its benchmark, one over this.
inline constexpr Eigen::Index kBenchmarkShare = 4;

/// The period of `samples` samples in which `signals` vary least while `inputs` move, for methods that
/// compare with a benchmark: the one with the least
///
///   sum_i log( mean (x_i - mean)^2 / m_i ),
///
/// m_i the same over all samples, in which each signal has half of the most values that it has in as many
/// samples and varies, and each input that moves at all moves. Of the simulation errors y - y_sim it is the
/// logarithm of the volume det(cov e) of Yu and Qin (2.13), which their benchmark index compares, without
/// their correlations; it does not depend on units, and a disturbance or a mismatch whose MV moves makes it
/// larger. Nothing says that this period is good: only that no other one of the record is better.
///
/// First sample and the one after the last; of equal ones the earliest. Equal numbers: there is no such
/// period, no signal has a value, or the record is shorter.
///
/// | symbol | name    | shape | unit                        |
/// |--------|---------|-------|-----------------------------|
/// | x      | signals | n x N | any; NaN where missing      |
/// |        | inputs  | m x N | any; NaN where missing      |
std::pair<Eigen::Index, Eigen::Index> quietest_period(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                      const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                      Eigen::Index samples);

}  // namespace mpm
