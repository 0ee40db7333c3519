#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment.hpp"
#include "plants/linear/transfer_function.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {

/// The mismatch of one parameter of a channel that explains a simulation error best.
///
/// | member       | meaning                                                                      |
/// |--------------|------------------------------------------------------------------------------|
/// | value        | as Mismatch::value: factor of gain or time constant, shift of the dead time  |
/// | lower, upper | its interval by the likelihood ratio; it stops at an end of the search       |
/// | residual_sum | least sum of squared residuals                                               |
struct ProfiledMismatch {
  MismatchParameter parameter;
  double value, lower, upper;
  double residual_sum;
  SizeBound bound = SizeBound::none;  ///< tells if the value lies at an end of the search
};

/// The best mismatch of the gain, of the time constant and of the dead time of a channel, in the order of
/// their residual sums: the first is the one to name. With s(v) = (G0_ij(v) - G0_ij) u_j and the
/// autoregression A of order p,
///
///   V(v) = min over c, A of sum_k (A (e - s(v)) - c)^2,    interval: n ln(V(v)/V_min) <= chi2(1)
///
/// which is -2 ln of the likelihood of Gaussian noise up to a constant, with noise model and level profiled
/// out. Gains are searched from -2 to 4 times that of the model, time constants from 1/8 to 8 times, dead
/// times up to 10 samples to either side. The search uses a grid first, and then the golden section between
/// the neighbours of the best point.
///
/// | symbol | name    | shape | meaning                                        |
/// |--------|---------|-------|------------------------------------------------|
/// | e      | e       | N     | simulation error of the CV, other mismatches taken out |
/// | u_j    | input   | M + N | input of the channel, with M samples before those of e |
/// | G0_ij  | channel |       | of the model; not integrating and not 0 for a time constant |
/// | p      | order   | 1     | of the autoregression of the noise             |
///
/// @throws InputError for fewer samples of the input than of e, fewer than 3 p + 10 of e, or a channel
/// without effect
std::vector<ProfiledMismatch> profiled_mismatches(const Eigen::Ref<const Eigen::VectorXd>& e,
                                                  const Eigen::Ref<const Eigen::VectorXd>& input,
                                                  const TransferFunction& channel, double sample_time,
                                                  Eigen::Index order, double confidence);

}  // namespace mpm
