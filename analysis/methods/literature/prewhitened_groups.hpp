#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/literature/noise_model.hpp"

namespace mpm {

/// A regression of a CV's simulation error on groups of signals, prewhitened.
///
/// A simulation error of a mismatch Delta G and noise v is e = Delta G u + v. With A v = w white and X_j the
/// responses of some filters to input j, w = A (e - sum_j X_j b_j) is linearised about A and a first v,
///
///   A e(k) = c + sum_(l=1)^p da_l v(k-l) + sum_j A X_j(k) b_j + w(k)
///
/// and the past of v and the constant are projected out of both sides, which removes the part of the noise
/// that follows from its own past. In closed loop the MVs depend on past noise; X_j(k) contains u(k-1) and
/// earlier moves, and with the past of v projected out, the rest is uncorrelated with w(k) except for errors
/// of the noise model.
///
/// prewhitened_test() (analysis/identification) tests only whether groups help to predict e. It leaves the
/// past of v in, which costs power but no false alarms, and accepts gaps.
///
/// | symbol  | member   | shape         | meaning                                                      |
/// |---------|----------|---------------|--------------------------------------------------------------|
/// | A       | noise    |               | D of this noise model 1/D                                    |
/// | r       | r        | n             | A e without constant and past; n = N - `kHighestNoiseOrder`  |
/// | A X_j   | X        | n x m_j each  | the same of the regressors                                   |
/// | Q_j     | Q        | n x m_j' each | orthonormal columns that span X_j                            |
/// | sigma^2 | variance |               | of w, with all groups in the regression                      |
/// |         | rank     |               | of all groups together                                       |
/// |         | freedom  |               | n - 1 - p - rank                                             |
struct PrewhitenedGroups {
  NoiseModel noise;
  Eigen::VectorXd r;
  std::vector<Eigen::MatrixXd> X, Q;
  double variance = 0.0;
  Eigen::Index rank = 0;
  Eigen::Index freedom = 0;

  /// |Q_j'r|^2 / (m_j' sigma^2), which has the distribution F(m_j', freedom) if no group explains anything; 0
  /// for a group without columns and for an error that is 0.
  double ratio(std::size_t group) const;
  /// The increase of the residual sum of squares if the group is removed from the regression with all the
  /// others, over m_j' sigma^2.
  double partial_ratio(std::size_t group) const;
  /// The quantile of F(m_j', freedom) that is exceeded with this probability; infinite without columns.
  double critical_ratio(std::size_t group, double probability) const;
  /// The squares that all groups together explain over rank sigma^2: F(rank, freedom) if no group explains
  /// anything.
  double joint_ratio() const;
  /// The quantile of F(columns, freedom) that is exceeded with this probability; infinite without columns.
  double critical_ratio_of(Eigen::Index columns, double probability) const;
  /// The coefficients b of all groups together, one group after the other, with the least norm if they are
  /// not determined.
  Eigen::VectorXd coefficients() const;
};

/// The largest order of the autoregression of the noise. The order used is the one of least BIC.
inline constexpr Eigen::Index kHighestNoiseOrder = 12;

/// The length of the shortest record for which the regression on `columns` regressors leaves 20 degrees of
/// freedom.
Eigen::Index fewest_prewhitened_samples(Eigen::Index columns);

/// The regression about v = e, with the noise model of e alone. It assumes that no group explains anything:
/// `ratio` and `joint_ratio` test against this assumption.
///
/// | symbol | name   | shape        | meaning                              |
/// |--------|--------|--------------|--------------------------------------|
/// | e      | e      | N            | simulation error of a CV             |
/// | X_j    | groups | N x m_j each | regressors, strictly delayed; a group may have no columns |
///
/// @throws InputError for different lengths, values that are not finite, or a record that is too short
PrewhitenedGroups prewhitened_groups(const Eigen::Ref<const Eigen::VectorXd>& e,
                                     const std::vector<Eigen::MatrixXd>& groups);

/// The regression for the case that some group explains a part of e: about v = e - sum_j X_j b_j, in three
/// iterations that start from the least squares of e on the groups.
PrewhitenedGroups refined_groups(const Eigen::Ref<const Eigen::VectorXd>& e,
                                 const std::vector<Eigen::MatrixXd>& groups);

}  // namespace mpm
