#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/model_errors.hpp"

namespace mpm {

/// The logarithm of the evidence that the valve of an MV sticks, in the measure of CvEvidence::healthy,
/// summed over the CVs. A valve that sticks from some sample on moves all CVs by what it does not do of what
/// is asked for,
///
///   e_i = G0_ij x + Z_i' z_i + n_i,   x(k) = valve(u_j(0 ... k); S, J) - u_j(k),   z_i ~ N(0, I),
///
/// with StickyValve, the noise n_i and the directions Z_i of ModelErrors. The likelihood is taken at the best
/// of a grid of S, J/S and the sample of the onset, searched further from there; the evidence is this less
/// 3/2 log n for these three (Schwarz 1978), n the samples of the CVs that the MV moves.
///
/// | symbol   | name    | shape         | unit                              |
/// |----------|---------|---------------|-----------------------------------|
/// | e_i, Z_i | series  | (1 + q_i) x N | standard deviations of the noise  |
/// | u        | inputs  | nu + nd x N   |                                   |
///
/// NaN in the first row of a series where there is no sample. One answer for each of the first `mvs` inputs;
/// -infinity for one that moves no CV or does not move.
std::vector<double> valve_log_evidence(const std::vector<ModelErrors>& models,
                                       const std::vector<Eigen::MatrixXd>& series,
                                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                       const Eigen::Ref<const Eigen::VectorXd>& initial, Eigen::Index mvs,
                                       double sample_time, double noise_freedom);

}  // namespace mpm
