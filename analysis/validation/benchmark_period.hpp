#pragma once

#include <utility>

#include <Eigen/Core>

namespace mpm {

/// The benchmark that is sought in a record is one part in kBenchmarkShare of it.
inline constexpr Eigen::Index kBenchmarkShare = 4;

/// Finds the period of `samples` samples in which `signals` vary least while `inputs` move, for methods that
/// compare with a benchmark. It is the period with the least
///
///   sum_i log( mean (x_i - mean)^2 / m_i ),
///
/// where m_i is the same mean square over all samples. In the period each signal must vary and have at least
/// half of the most values that it has in any period of this length, and each input that moves at all must
/// move. For the simulation errors y - y_sim the sum is the logarithm of the volume det(cov e) of Yu and Qin
/// (2.13), which their benchmark index compares, but without correlations. It does not depend on units, and a
/// disturbance or a mismatch whose MV moves makes it larger. The period need not be good: it is only the
/// best one of the record.
///
/// Returns its first sample and the sample after its last one; the earliest of equal periods. The two are
/// equal if there is no such period, if no signal has a value, or if the record is shorter.
///
/// | symbol | name    | shape | unit                        |
/// |--------|---------|-------|-----------------------------|
/// | x      | signals | n x N | any; NaN where missing      |
/// |        | inputs  | m x N | any; NaN where missing      |
std::pair<Eigen::Index, Eigen::Index> quietest_period(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                      const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                      Eigen::Index samples);

}  // namespace mpm
