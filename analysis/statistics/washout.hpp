#pragma once

#include <Eigen/Core>

namespace mpm {

/// Each row of `signals` with its gaps (NaN) filled by linear interpolation, and by the nearest value at both
/// ends; a row without values is unchanged.
Eigen::MatrixXd gaps_closed(Eigen::MatrixXd signals);

/// f = (1 - z^-1) / (1 - a z^-1) y, the high-pass filter of TransferFunction::behind_washout(): f(k) = y(k) -
/// w(k), w(k+1) = a w(k) + (1 - a) y(k), w(0) = `start`. Across missing samples (NaN) y is taken as by
/// gaps_closed(), and f is missing there.
Eigen::RowVectorXd washed_out(const Eigen::Ref<const Eigen::RowVectorXd>& y, double a, double start);

/// The y of washed_out() with w(0) = 0: what it was less its start.
Eigen::RowVectorXd washout_undone(const Eigen::Ref<const Eigen::RowVectorXd>& f, double a);

}  // namespace mpm
