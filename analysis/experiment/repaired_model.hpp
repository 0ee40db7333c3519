#pragma once

#include "plants/linear/transfer_matrix.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

// The common basis of all repairs of a model, true or identified.

namespace mpm {

/// The transfer functions of the linear plant of an experiment, after its onset.
TransferMatrix true_plant(const Study& study, const ExperimentDraw& draw);

/// The loop of the experiment under the controller of the study with another model: `model` instead of
/// Study::plant. The plant, the noise and all other signals are those of the experiment; its faults are there
/// from the first sample on.
Trajectory loop_with_model(const Study& study, const TransferMatrix& model, ExperimentDraw draw,
                           const QpSolverFactory& factory);

}  // namespace mpm
