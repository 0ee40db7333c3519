#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// Autocovariances of the control errors of a loop, for one CV after the other,
///
///   c_i(tau) = 1/N sum_k z_i(k) z_i(k + tau),   z_i = y_i - y_set,i
///
/// | symbol | name  | shape  | meaning                                                     |
/// |--------|-------|--------|-------------------------------------------------------------|
/// | z      | z     | ny x N | CVs as deviations from their setpoints                      |
/// | tau    | lags  | n_lag  | samples, 0 or more                                          |
/// | c      |       | ny n_lag | c_1(tau_1), c_1(tau_2), ..., c_2(tau_1), ...              |
///
/// The deviations are taken from the setpoints, not from means: theory and sample then agree without a
/// correction.
Eigen::VectorXd loop_autocovariance(const Eigen::Ref<const Eigen::MatrixXd>& z,
                                    const std::vector<Eigen::Index>& lags);

/// A linear MPC loop in the form of internal model control. Its MVs follow from the signals from outside and,
/// through linear filters, from the errors e = y - y_sim of its model,
///
///   u = u_0 + Q e,   y = y_0 + S e,   S = I + G0 Q,   e = (G - G0) u + v,   v_l = (1 / A_l) w_l
///
/// where u_0, y_0 are the loop on its model under the setpoints and measured disturbances of the record. Q
/// and S have the step responses of the controller on its own model, with all limits relaxed, to a step added
/// to a CV. The noise v of each CV is an autoregression, independent of the noise of the other CVs.
///
/// | symbol | member     | shape           | meaning                                          |
/// |--------|------------|-----------------|--------------------------------------------------|
/// | Q      | q[l]       | nu x L          | impulse response of the MVs to e_l               |
/// | S      | s[l]       | ny x L          | impulse response of the CVs to e_l               |
/// | Q v_l  | noise_moves[l]   | nu x L    | of the MVs to w_l, with v_l 1 / A_l times the deviation of w_l |
/// | S v_l  | noise_outputs[l] | ny x L    | of the CVs                                       |
struct LinearLoop {
  double sample_time = 1.0;
  std::vector<Eigen::MatrixXd> q = {}, s = {};
  std::vector<Eigen::MatrixXd> noise_moves = {}, noise_outputs = {};
};

/// The loop of a study without limits, with the noise of the benchmark: v is the simulation error of the
/// benchmark, modelled by the autoregression of least BIC. `samples` is L.
/// @throws InputError if the controller has no solution, or the benchmark is too short
LinearLoop linear_loop(const AssessmentContext& context, const AssessedLoop& benchmark, Eigen::Index samples);

/// A channel of the plant that differs from the model. D is the difference of the impulse responses, G - G0,
/// counted from the move of the MV on: L values, the first of which is 0.
struct ChannelDifference {
  Eigen::Index cv, mv;
  Eigen::VectorXd D;
};

/// D for this channel of the plant instead of this channel of the model.
ChannelDifference channel_difference(const TransferFunction& nominal, const TransferFunction& plant,
                                     Eigen::Index cv, Eigen::Index mv, double sample_time,
                                     Eigen::Index samples);

/// The response of a loop to signals from outside: the loop on its model, without noise.
///
/// | symbol | member  | shape  | meaning                                                       |
/// |--------|---------|--------|---------------------------------------------------------------|
/// | u_0    | u0      | nu x N | its MVs, as deviations from where it begins                   |
/// | z_0    | z0      | ny x N | its CVs, as deviations from their setpoints                   |
///
/// Autocovariances are taken over `samples` samples from `first` on.
struct OutsideMoves {
  Eigen::MatrixXd u0, z0;
  Eigen::Index first = 0, samples = 0;
};

/// The response to the signals of a record, window or whole: the controller without limits on its model,
/// under the measured disturbances and setpoints of the record.
/// @throws InputError if the controller has no solution
OutsideMoves outside_moves(const AssessmentContext& context, const AssessedLoop& loop);

/// z of a record: y - y_set, or y for a CV that has no setpoint.
Eigen::MatrixXd control_errors(const AssessedLoop& loop, const Eigen::Ref<const Eigen::MatrixXd>& y);

/// The autocovariances of the loop if one channel of the plant, or none, differs from the model. With e_i = D
/// u_j + v_i for that channel, and only noise in all other errors,
///
///   u_j = u_0j + Q_ji D u_j + sum_l Q_jl v_l,   y = y_0 + S e
///
/// that is, y = y_0 + S_i D / (1 - Q_ji D) u_j with the u_j of the loop on its model, for u_0 and for an
/// impulse in each w_l. With z = z_d + n, the effects of both,
///
///   E c_i(tau) = 1/N sum_k z_d,i(k) z_d,i(k + tau) + (N - tau)/N g_ii(tau),  g_im(tau) = E n_i(k) n_m(k+tau)
///   N cov(c_i(a), c_m(b)) = h sum_t g_im(t) g_im(t + b - a) + g_im(t + b) g_im(t - a)     (Bartlett 1946)
///                           + 1/N sum_k,l x_ia(k) g_im(l - k) x_mb(l)
///   x_ia(k) = z_d,i(k + a) + z_d,i(k - a)
///
/// for normal noise. The last sum is the interaction of the noise with the moves. h is 1 if g is known, and 1
/// + N/N_b if g was estimated from a benchmark of N_b samples.
/// The values are not finite if the loop is unstable.
Eigen::VectorXd theoretical_autocovariance(const LinearLoop& loop, const OutsideMoves& moves,
                                           const std::vector<Eigen::Index>& lags,
                                           const ChannelDifference* changed);

/// The covariance of these autocovariances; `noise_share` is h.
Eigen::MatrixXd autocovariance_covariance(const LinearLoop& loop, const OutsideMoves& moves,
                                          const std::vector<Eigen::Index>& lags,
                                          const ChannelDifference* changed, double noise_share);

}  // namespace mpm
