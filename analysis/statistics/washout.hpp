#pragma once

#include <Eigen/Core>

namespace mpm {

/// Fills the gaps (NaN) of each row of `signals` by linear interpolation, and at both ends by the nearest
/// value. A row without values is unchanged.
Eigen::MatrixXd gaps_closed(Eigen::MatrixXd signals);

/// Returns f = (1 - z^-1) / (1 - a z^-1) y, the high-pass filter of TransferFunction::behind_washout(): f(k)
/// = y(k) - w(k), w(k+1) = a w(k) + (1 - a) y(k), w(0) = `start`. Where samples of y are missing (NaN), y is
/// filled as by gaps_closed(), and f is missing there.
Eigen::RowVectorXd washed_out(const Eigen::Ref<const Eigen::RowVectorXd>& y, double a, double start);

/// Inverts washed_out() with w(0) = 0: returns y less its `start`.
Eigen::RowVectorXd washout_undone(const Eigen::Ref<const Eigen::RowVectorXd>& f, double a);

}  // namespace mpm
