#pragma once

#include <memory>
#include <string>

#include "analysis/basis/basis_case.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/qp_solver.hpp"

// What methods learn before they see a loop.

namespace mpm {

/// What `assessment.model` means for loops under a context, and why, for people.
struct ModelAssumption {
  AssessmentModel model;  ///< nominal or benchmark
  std::string why;        ///< a clause: "the plant is a program"
};

/// What AssessmentModel::automatic means under the context that learn_model() has filled:
///
/// | the plant                                         | means                                             |
/// |---------------------------------------------------|---------------------------------------------------|
/// | of a study with worlds                            | benchmark                                         |
/// | a program or an FMU                               | benchmark                                         |
/// | is nonlinear by equations of ours, or its record  | benchmark if the benchmark rejects an exact model |
/// | has averages or shifted rows                      | (ModelErrors::rejects_exact_model()), or nominal  |
/// | the linear model                                  | nominal                                           |
ModelAssumption model_assumption(const AssessmentContext& context);

/// "assessment.model: benchmark, because the plant is a program"
std::string to_string(const ModelAssumption& assumption);

/// Puts the errors of the model that `benchmark` shows into the context, if its study learns them
/// (model_assumption()). It puts nothing there if the study does not, or if the benchmark has too few samples
/// of a CV or lacks samples of an input. The first method that needs the errors learns them; it fails if the
/// likelihood of the benchmark is not a number. Study and basis of the context must outlive it.
void learn_model(const AssessedLoop& benchmark, AssessmentContext& context);

/// What was learnt; null if nothing was. Throws the InputError of the first use.
std::shared_ptr<const LearntModel> learnt_model(const AssessmentContext& context);

/// The context of the loops of `study`. Its benchmark is the record of the basis case, which has no fault;
/// errors of the model are learnt from it as model_assumption() says.
AssessmentContext assessment_context(const Study& study, const BasisCase& basis, QpSolverFactory factory);

}  // namespace mpm
