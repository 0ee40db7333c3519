#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// The penalty of a group lasso by cross-validation: of lambda sqrt(m_j) on group j, in kPenalties steps from
/// the least lambda at which no group enters down to a thousandth of it, that one whose coefficients predict
/// best what was left out. kFolds times a stretch of the record is left out, so that neighbours in time stand
/// on one side.
///
/// | symbol | name   | shape        | meaning                                 |
/// |--------|--------|--------------|-----------------------------------------|
/// | r      | r      | n            | response                                |
/// | X_j    | groups | n x m_j each | columns of a group, linearly independent |
///
/// Returns lambda; 0 where no group has a column. The largest of several that predict equally well.
/// @throws InputError for different lengths
double cross_validated_penalty(const Eigen::Ref<const Eigen::VectorXd>& r,
                               const std::vector<Eigen::MatrixXd>& groups);

/// Coefficients under the penalty lambda sqrt(m_j) on |X_j b_j| of each group, of these groups as they stand;
/// of a group whose columns depend on each other in this record those of least norm.
std::vector<Eigen::VectorXd> penalised_coefficients(const Eigen::Ref<const Eigen::VectorXd>& r,
                                                    const std::vector<Eigen::MatrixXd>& groups,
                                                    double lambda);

}  // namespace mpm
