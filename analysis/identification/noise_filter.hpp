#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "analysis/identification/decorrelation.hpp"

namespace mpm {

/// How noise is removed from the signals before they are correlated (A1.2, step 1).
enum class NoiseFilter : std::int8_t {
  /// `external` if at least as many signals from outside move as there are MVs to tell apart, `none` if fewer
  /// do.
  automatic = 0,
  none = 1,
  moving_average = 2,  ///< the mean of the last n samples
  first_order = 3,     ///< x_f(k) = a x_f(k-1) + (1 - a) x(k), a = exp(-1/n)
  external = 4,        ///< only the part of the MVs that setpoints and measured disturbances cause
};

/// Passes each row of a record (m x N) through the same filter of length n samples, from the steady state of
/// the first column. The filters are linear and the same for all rows, so that e = Delta G u holds for the
/// filtered signals as for the measured ones. `external` and `automatic` do not filter each signal alone.
/// This function leaves the signals as they are for them, as it does for `none` (see `externally_driven`).
/// @throws InputError for a record without samples, values that are not finite, or n below 1
Eigen::MatrixXd noise_filtered(const Eigen::Ref<const Eigen::MatrixXd>& signals, NoiseFilter filter,
                               Eigen::Index length);

/// The rows of signals that move.
Eigen::MatrixXd moving_rows(const Eigen::Ref<const Eigen::MatrixXd>& signals);

/// The part of each MV that follows from signals outside the loop, u - eps with eps = u - V r (`decorrelate`,
/// without delay). It excludes noise and the answers of the MVs to unmeasured disturbances: r does not depend
/// on the disturbances, so neither does V r. Feedback alone, in contrast, correlates u with the prediction
/// error, with or without a mismatch.
///
/// | symbol | name     | shape  | meaning                            |
/// |--------|----------|--------|------------------------------------|
/// | u      | u        | nu x N | MVs                                |
/// | r      | external | nr x N | setpoints, measured disturbances; rows that stand still are left out |
///
/// If no row of r moves, the result stands still as well.
/// @throws InputError as `decorrelate`
Eigen::MatrixXd externally_driven(const Eigen::Ref<const Eigen::MatrixXd>& u,
                                  const Eigen::Ref<const Eigen::MatrixXd>& external,
                                  const DecorrelationOptions& options);

}  // namespace mpm
