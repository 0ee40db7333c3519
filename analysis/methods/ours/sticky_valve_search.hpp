#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/explained_errors.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/methods/ours/whitened_errors.hpp"

namespace mpm {

/// Finds for each of the first `mvs` inputs the sticking valve that explains the simulation errors best. It
/// moves all CVs by its position less what is asked for,
///
///   e_i = G0_ij x + Z_i' z_i + n_i,   x(k) = valve(u_j(0 ... k)) - u_j(k),   z_i ~ N(0, I),
///
/// with a StickyValve (S, J) or a FrictionValve (f_S, f_D). The likelihood is that of `errors`, one for each
/// CV. The first look takes valves of a grid of S and J/S, or f_S and f_D/f_S, that stick from the start. The
/// gains of single samples then give the best onset, before which samples are left out. The best few are
/// searched further, with the onset and the position of the stem at the onset free. They have four
/// parameters, and n is the number of samples of the CVs that the MV moves.
///
/// | symbol | name    | shape       |
/// |--------|---------|-------------|
/// | u      | inputs  | nu + nd x N |
///
/// Nothing is found if the MV moves no CV, if it does not move, or if its best start leads to so much less
/// than that of another MV that its other starts need not be searched.
std::vector<ExplainedErrors> best_sticky_valves(const std::vector<ModelErrors>& models,
                                                const std::vector<WhitenedErrors>& errors,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                const Eigen::Ref<const Eigen::VectorXd>& initial,
                                                Eigen::Index mvs, double sample_time);

}  // namespace mpm
