#include "analysis/experiment/experiment.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/fault_cost.hpp"
#include "analysis/experiment/fault_scale.hpp"
#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "plants/analyser.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/historian.hpp"

namespace mpm {
namespace {

ExperimentStatus experiment_status(ControlStatus status) {
  return status == ControlStatus::ok           ? ExperimentStatus::ok
         : status == ControlStatus::infeasible ? ExperimentStatus::infeasible
                                               : ExperimentStatus::failed;
}

/// Does the experiment need the loops with each of its two faults alone?
bool has_loops_alone(const ExperimentDraw& draw) {
  return draw.kind == ExperimentKind::mpm_ud && draw.true_cv() >= 0;
}

/// Does the method say how much the mismatch dominates, from the loops with one fault alone?
bool has_dominance(const AssessmentForm& form) {
  return form.find("ivar_diag_mpm_alone") != nullptr && form.find("ivar_diag_ud_alone") != nullptr &&
         form.find("dominance_mpm") != nullptr;
}

/// The answer of the method that has dominance; null if it was not asked or gave no verdict.
AssessmentRecord* chain_verdict(std::vector<AssessmentRecord>& assessments) {
  const auto chain = std::find_if(assessments.begin(), assessments.end(), [](const auto& said) {
    return has_dominance(*said.form) && said.answered();
  });
  return chain == assessments.end() ? nullptr : &*chain;
}

}  // namespace

ExperimentRunner::ExperimentRunner(const Study& study, AssessmentContext context,
                                   const std::vector<std::string>& methods)
    : study_(study),
      basis_(context.basis),
      factory_(context.factory),
      methods_(methods),
      panel_(study, std::move(context), methods),
      perturbation_(study, basis_.sensitivity),
      stability_(study, basis_.point) {}

ExperimentRunner::ExperimentRunner(const Study& study, const BasisCase& basis,
                                   const std::vector<std::string>& methods, QpSolverFactory factory)
    : ExperimentRunner(study, assessment_context(study, basis, std::move(factory)), methods) {}

ExperimentRunner::FinishedLoop ExperimentRunner::simulate(const ExperimentDraw& draw,
                                                          const StepObserver& observer) {
  return finished(draw, simulate_experiment(study_of(draw), draw, factory_, observer));
}

const Study& ExperimentRunner::study_of(const ExperimentDraw& draw) {
  if (study_.simulation.excitation == SignalSequence::shared)
    return study_;
  if (!moved_ || moved_->first != draw.index)
    moved_.emplace(draw.index, with_excitation(study_, draw.index));
  return moved_->second;
}

const ExperimentRunner::WorldCase& ExperimentRunner::case_of(const ExperimentDraw& draw) {
  WorldCase& known = worlds_[draw.world];
  if (known.basis.world == draw.world)
    return known;
  known.basis = world_basis(study_, basis_, draw.world, factory_);
  known.spectral_radius = stability_.spectral_radius(basis_draw(draw.world));
  return known;
}

const BasisCase& ExperimentRunner::basis_of(const ExperimentDraw& draw) {
  return draw.world == kExactWorld ? basis_ : case_of(draw).basis;
}

template <class Call>
auto ExperimentRunner::with_panel(const ExperimentDraw& draw, const FinishedLoop& loop, Call with) {
  // The panel of a world is made when its first loop is to be assessed: loops like a record of a plant are
  // assessed elsewhere.
  std::unique_ptr<MethodPanel>* const of_world =
      draw.world == kExactWorld ? nullptr : &worlds_[draw.world].panel;
  if (of_world && !*of_world)
    *of_world = std::make_unique<MethodPanel>(
        study_, assessment_context(study_, case_of(draw).basis, factory_), methods_);
  MethodPanel& panel = of_world ? **of_world : panel_;
  if (loop.own) {
    const MethodPanel::Own own{loop.own->study, loop.own->basis};
    return with(panel, &own);
  }
  if (study_.simulation.excitation == SignalSequence::shared)
    return with(panel, static_cast<const MethodPanel::Own*>(nullptr));
  const MethodPanel::Own own{study_of(draw), basis_of(draw)};
  return with(panel, &own);
}

std::vector<AssessmentRecord> ExperimentRunner::assessed(const ExperimentDraw& draw,
                                                         const FinishedLoop& loop) {
  return with_panel(draw, loop, [&](MethodPanel& panel, const MethodPanel::Own* own) {
    return panel.assess(loop.assessed, own);
  });
}

std::optional<AssessmentRecord> ExperimentRunner::assessed_by(std::string_view method,
                                                              const ExperimentDraw& draw,
                                                              const FinishedLoop& loop) {
  return with_panel(draw, loop, [&](MethodPanel& panel, const MethodPanel::Own* own) {
    return panel.assess_by(method, loop.assessed, own);
  });
}

ExperimentRunner::FinishedLoop ExperimentRunner::finished(const ExperimentDraw& draw, Trajectory trajectory) {
  const Study& study = study_of(draw);
  FinishedLoop loop{experiment_status(trajectory.status), trajectory.message, std::move(trajectory), {}, {}};
  if (loop.status == ExperimentStatus::ok && basis_of(draw).trajectory.status != ControlStatus::ok) {
    loop.status = experiment_status(basis_of(draw).trajectory.status);
    loop.message = basis_of(draw).explanation;
  }
  if (loop.status == ExperimentStatus::ok)
    loop.own = tuned_basis(study, draw, factory_);
  if (loop.own && loop.own->basis.trajectory.status != ControlStatus::ok) {
    loop.status = experiment_status(loop.own->basis.trajectory.status);
    if (loop.status == ExperimentStatus::failed)
      loop.message = "no S0 of its own: " + loop.own->basis.explanation;
  }
  if (loop.status != ExperimentStatus::ok)
    loop.assessed.y_sim =
        simulated_output(study.assessed_model(), study.controller.sample_time, basis_.point.u,
                         loop.trajectory.u, as_taken(study.controller.md_analysers, loop.trajectory.d));
  else if (loop.own)
    loop.assessed =
        assessed_loop(loop.own->study, loop.own->basis.point, recorded(study, draw.index, loop.trajectory));
  else
    loop.assessed = assessed_loop(study, basis_.point, recorded(study, draw.index, loop.trajectory));
  loop.assessed.candidates = logged_candidates(study, draw);
  return loop;
}

double ExperimentRunner::spectral_radius(const ExperimentDraw& draw) const {
  return draw.tuning ? LoopStability(with_tuning(study_, draw), basis_.point).spectral_radius(draw)
                     : stability_.spectral_radius(draw);
}

void ExperimentRunner::exclude_unstable(ExperimentRecord& record) {
  if (has_cause(record.conditions, NonlinearCause::unstable))
    record.status = ExperimentStatus::unstable;
  if (record.draw.world == kExactWorld || !(case_of(record.draw).spectral_radius >= 1.0))
    return;
  record.status = ExperimentStatus::unstable;
  record.message = fmt::format("world {} is not stable without a fault: spectral radius {:.4f}",
                               record.draw.world, case_of(record.draw).spectral_radius);
}

/// Runs the loops with each of the two faults alone, without which the experiment is not complete.
void ExperimentRunner::assess_alone(ExperimentRecord& record, const StepObserver& observer) {
  const FinishedLoop mpm_alone = simulate(record.draw.mismatch_alone(), observer);
  const FinishedLoop ud_alone = simulate(record.draw.disturbance_alone(), observer);
  for (const FinishedLoop* part : {&mpm_alone, &ud_alone}) {
    record.solver.add(part->trajectory.solver);
    record.status = std::max(record.status, part->status);
    if (record.message.empty())
      record.message = part->message;
  }
  if (AssessmentRecord* const chain = chain_verdict(record.assessments))
    add_dominance(*chain, record.draw, mpm_alone, ud_alone);
  if (record.truth) {
    record.truth->mpm_alone = {mpm_alone.trajectory.y, mpm_alone.trajectory.u};
    record.truth->ud_alone = {ud_alone.trajectory.y, ud_alone.trajectory.u};
  }
}

void ExperimentRunner::add_dominance(AssessmentRecord& chain, const ExperimentDraw& draw,
                                     const FinishedLoop& mpm_alone, const FinishedLoop& ud_alone) {
  if (mpm_alone.status != ExperimentStatus::ok || ud_alone.status != ExperimentStatus::ok)
    return;
  const auto ivar_diag = [&](const FinishedLoop& part) {
    return assessed_by(chain.form->method().name, draw, part)->number("ivar_diag", draw.true_cv());
  };
  const double mpm = ivar_diag(mpm_alone);
  const double ud = ivar_diag(ud_alone);
  chain.set_number("ivar_diag_mpm_alone", mpm);
  chain.set_number("ivar_diag_ud_alone", ud);
  chain.set_number("dominance_mpm", mpm / (mpm + ud));
}

void ExperimentRunner::add_truth(ExperimentRecord& record, const Trajectory& loop) {
  if (!study_.world) {
    record.ivar_basis = basis_variance_indices(study_of(record.draw), loop.y, healthy_output(record, {}));
    return;
  }
  PilotCosts costs;
  record.cost = fault_cost(study_of(record.draw), record.draw, study_.world->cost_loops, factory_,
                           record.solver, &costs);
  record.ivar_basis = record.cost->variance_ratio;
  record.repair = repair_gains(study_of(record.draw), record.draw, study_.world->repair_loops, factory_,
                               record.solver, costs);
}

Eigen::MatrixXd ExperimentRunner::healthy_output(ExperimentRecord& record, const StepObserver& observer) {
  const ExperimentDraw& draw = record.draw;
  if (draw.world == kExactWorld && study_.simulation.excitation == SignalSequence::shared)
    return basis_.trajectory.y;
  Trajectory healthy = simulate_experiment(study_of(draw), draw.without_faults(), factory_, observer);
  record.solver.add(healthy.solver);
  return std::move(healthy.y);
}

ExperimentRecord ExperimentRunner::run(std::int64_t index, StorePolicy store, const StepObserver& observer) {
  ExperimentRecord record;
  record.draw = draw_experiment(study_, index);
  if (has_asked_impact(study_, record.draw))
    record.draw =
        with_scales(study_, record.draw,
                    scales_for_impact(study_of(record.draw), record.draw, healthy_output(record, observer),
                                      factory_, record.solver, observer));
  FinishedLoop main = simulate(record.draw, observer);
  record.status = main.status;
  record.message = main.message;
  record.solver.add(main.trajectory.solver);
  if (main.own)
    record.solver.add(main.own->solver);
  record.conditions = loop_conditions(study_of(record.draw), basis_, main.trajectory);
  record.conditions.spectral_radius = spectral_radius(record.draw);
  if (record.status == ExperimentStatus::ok && study_.diagnosis.unstable == UnstableLoops::exclude)
    exclude_unstable(record);
  if (record.status == ExperimentStatus::ok)
    record.assessments = assessed(record.draw, main);
  if (store == StorePolicy::truth) {
    LoopSignals signals = experiment_signals(study_of(record.draw), record.draw);
    record.truth = LoopTruth{std::move(signals.noise), std::move(signals.y_d)};
  }
  const Eigen::Index true_cv = record.draw.true_cv();
  if (has_loops_alone(record.draw) && record.status == ExperimentStatus::ok)
    assess_alone(record, observer);
  if (record.status == ExperimentStatus::ok) {
    add_truth(record, main.trajectory);
    if (true_cv >= 0 && !main.assessed.y.row(true_cv).hasNaN())  // S0 needs every sample
      record.perturbed = perturbation_.ivar_diag(true_cv, Eigen::RowVectorXd(main.assessed.y.row(true_cv)),
                                                 Eigen::RowVectorXd(main.assessed.y_sim.row(true_cv)));
  } else {
    record.assessments = unassessed(panel_.forms());
  }
  if (store == StorePolicy::all || store == StorePolicy::truth ||
      (store == StorePolicy::flagged && !record.assessments.empty() &&
       judge(study_, record, record.assessments.front()).wrong()))
    record.loop = {std::move(main.trajectory), study_.plant.G.is_integrating()
                                                   ? from_washout(study_, main.assessed.y_sim)
                                                   : std::move(main.assessed.y_sim)};
  return record;
}

ExperimentRunner::FinishedLoop ExperimentRunner::finished_again(const ExperimentRecord& record) {
  return finished(record.draw, record.loop ? record.loop->trajectory : simulated(record.draw));
}

AssessedLoop ExperimentRunner::loop_of(const ExperimentRecord& record) {
  return finished_again(record).assessed;
}

AssessedLoop ExperimentRunner::benchmark_of(const ExperimentRecord& record) const {
  ExperimentDraw draw = basis_draw(record.draw.world);
  draw.index = own_benchmark_index(record.draw.index);
  Trajectory loop = simulate_experiment(study_, draw, factory_);
  if (loop.status != ControlStatus::ok)
    return {};
  return assessed_loop(study_, basis_.point, recorded(study_, draw.index, std::move(loop)));
}

std::vector<AssessmentRecord> ExperimentRunner::assess(const ExperimentRecord& record) {
  return assess(record, methods_);
}

std::vector<AssessmentRecord> ExperimentRunner::assess(const ExperimentRecord& record,
                                                       const std::vector<std::string>& methods) {
  const FinishedLoop loop = finished_again(record);
  if (loop.status == ExperimentStatus::ok) {
    std::vector<AssessmentRecord> assessments;
    if (methods == methods_)
      assessments = assessed(record.draw, loop);
    else
      for (const std::string& method : methods)
        assessments.push_back(*assessed_by(method, record.draw, loop));
    if (AssessmentRecord* const chain = chain_verdict(assessments); chain && has_loops_alone(record.draw))
      add_dominance(*chain, record.draw, simulate(record.draw.mismatch_alone(), {}),
                    simulate(record.draw.disturbance_alone(), {}));
    return assessments;
  }
  std::vector<AssessmentRecord> failed = unassessed(assessment_forms(study_, methods));
  for (AssessmentRecord& assessment : failed) {
    assessment.status = AssessmentStatus::failed;
    assessment.reason = loop.own ? "its controller has no S0 of its own: " + loop.own->basis.explanation
                                 : "the loop does not run to its end";
  }
  return failed;
}

bool ExperimentRunner::runs_loops(const ExperimentRecord& record) const {
  const bool asks_dominance =
      std::any_of(forms().begin(), forms().end(), [](const auto& form) { return has_dominance(*form); });
  return !record.loop || has_tuned_basis(study_, record.draw) ||
         (asks_dominance && has_loops_alone(record.draw));
}

}  // namespace mpm
