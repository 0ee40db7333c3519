#pragma once

#include <vector>

#include <Eigen/Core>

#include "plants/linear/linear_plant.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "solvers/qp.hpp"

namespace mpm {

/// The forced response of the CVs over the prediction horizon, linear in the planned MV positions.
///
/// v(i), i = 0..Hc-1, are the MVs relative to u(k-1), from sample k + start(i) on until the next position
/// acts; the last one is held to the end:
///     y(k+l) = free(k+l) + sum_i sum_j R[l, (i, j)] v_j(i),   l = 1..Hp,
/// where free is the response to MVs held at u(k-1). R follows from the step responses S of the nominal
/// model: v(i) adds S(l-start(i)) - S(l-start(i+1)), and the last one S(l-start(Hc-1)).
///
/// Row `cv * Hp + l - 1`, column `i * nu + j`; shape (ny Hp) x (nu Hc).
///
/// `model` has the MVs in its first `mv_count` columns, then the MDs. `starts` are MpcOptions::move_starts():
/// 0, 1, ..., Hc-1 without move blocking.
RowMajorMatrix forced_response(const TransferMatrix& model, Eigen::Index mv_count, double sample_time,
                               int prediction_horizon, const std::vector<int>& starts);

/// The free response: y(k+1..k+Hp) of `model` with `held_input` (MVs, then MDs) held from sample k on.
/// Writes ny x Hp numbers into `response`; `scratch` is a plant of the same structure that is overwritten.
/// Allocates nothing.
void free_response(const LinearPlant& model, const Eigen::Ref<const Eigen::VectorXd>& held_input,
                   LinearPlant& scratch, Eigen::Ref<Eigen::MatrixXd> response);

}  // namespace mpm
