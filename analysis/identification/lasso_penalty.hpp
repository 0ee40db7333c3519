#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Chooses the penalty of a group lasso by cross-validation. Group j has the penalty lambda sqrt(m_j). lambda
/// goes in kPenalties steps from the least lambda at which no group enters down to a thousandth of it; the
/// lambda is chosen whose coefficients best predict the samples that were left out. kFolds times a stretch of
/// the record is left out, so that neighbours in time are on the same side.
///
/// | symbol | name   | shape        | meaning                                 |
/// |--------|--------|--------------|-----------------------------------------|
/// | r      | r      | n            | response                                |
/// | X_j    | groups | n x m_j each | columns of a group, linearly independent |
///
/// Returns lambda, the largest one if several predict equally well; 0 if no group has a column.
/// @throws InputError for different lengths
double cross_validated_penalty(const Eigen::Ref<const Eigen::VectorXd>& r,
                               const std::vector<Eigen::MatrixXd>& groups);

/// Returns the coefficients of each group under the penalty lambda sqrt(m_j) on |X_j b_j|, for the groups as
/// they are given. If the columns of a group depend on each other in this record, returns those of least
/// norm.
std::vector<Eigen::VectorXd> penalised_coefficients(const Eigen::Ref<const Eigen::VectorXd>& r,
                                                    const std::vector<Eigen::MatrixXd>& groups,
                                                    double lambda);

}  // namespace mpm
