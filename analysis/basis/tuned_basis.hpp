#pragma once

#include <optional>

#include "analysis/basis/basis_case.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The basis case of an experiment whose controller is not that of the study.
struct TunedBasis {
  Study study;  ///< with the controller of the experiment, and without perturbed S0
  /// Its operating point and S0. The status of its trajectory is not `ok` if the controller does not run on
  /// its own model or has no S0; `explanation` says why.
  BasisCase basis;
  SolverStatistics solver;  ///< of all its loops, including those that give T0
};

/// Whether the loop of this experiment is diagnosed with a basis case of its own: if its tuning differs from
/// that of the study, unless the change is unnoticed in the study (TuningSensitivity::design).
bool has_tuned_basis(const Study& study, const ExperimentDraw& draw);

/// The basis case with which the loop of this experiment is to be diagnosed: S0 belongs to the controller and
/// is determined anew when its tuning changes (appendix A2). None without has_tuned_basis().
///
/// Only S0 and the operating point are the experiment's own. The benchmark of Ivar_basis (6.22) stays the
/// basis case of the study, so that a bad tuning shows.
std::optional<TunedBasis> tuned_basis(const Study& study, const ExperimentDraw& draw,
                                      const QpSolverFactory& factory);

}  // namespace mpm
