#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Options of `group_lasso`.
struct GroupLassoOptions {
  /// The descent ends when no coefficient moves by more than this share of |c|.
  double tolerance = 1e-10;
  int most_sweeps = 10000;
};

/// The group lasso (Yuan and Lin 2006) by block coordinate descent, from the sums of products alone,
///
///   min over b of  1/2 b'C b - c'b + sum_j lambda_j |b_j|,    C = Q'Q, c = Q'r
///
/// for groups of columns of Q that are orthonormal within each group (C_jj = I). Each step is then exact,
/// b_j = (1 - lambda_j/|g_j|)_+ g_j with g_j = c_j - sum_(l != j) C_jl b_l, and its cost does not depend on
/// the length of the record. As the penalties fall, the first group j enters at |c_j| = lambda_j.
///
/// | symbol | name    | shape | meaning                                  |
/// |--------|---------|-------|------------------------------------------|
/// | C      | gram    | p x p | products of the columns of Q             |
/// | c      | product | p     | products of the columns with the response |
/// | lambda | penalty | groups | 0 or more                               |
/// |        | sizes   | groups | columns of each group; they add up to p |
///
/// Returns b (p). The order of the groups decides only which of several minimisers of a singular C is found.
/// @throws InputError for shapes that do not agree, a penalty below 0, or a group that is not orthonormal
Eigen::VectorXd group_lasso(const Eigen::Ref<const Eigen::MatrixXd>& gram,
                            const Eigen::Ref<const Eigen::VectorXd>& product,
                            const std::vector<Eigen::Index>& sizes,
                            const Eigen::Ref<const Eigen::VectorXd>& penalty,
                            const GroupLassoOptions& options = {});

}  // namespace mpm
