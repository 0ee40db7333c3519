#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/basis_case.hpp"
#include "analysis/basis/tuned_basis.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/sensitivity/loop_stability.hpp"
#include "analysis/sensitivity/s0_perturbation.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/experiment_draw.hpp"

namespace mpm {

/// Runs experiments of one study; keeps workspaces between them, so each thread needs a runner of its own.
/// Results depend on the index only.
class ExperimentRunner {
 public:
  /// Runs experiments of `study`, assessed by what the methods have learnt in `context`: the context of the
  /// study or, for a calibration study, of the study that it calibrates (scenarios/loop/calibration.hpp).
  /// `study`, and study and basis case of the context, must outlive the runner; the basis case must have
  /// status ok. Throws InputError for an unknown method.
  ExperimentRunner(const Study& study, AssessmentContext context, const std::vector<std::string>& methods);
  /// With the context of the study itself.
  ExperimentRunner(const Study& study, const BasisCase& basis, const std::vector<std::string>& methods,
                   QpSolverFactory factory);

  /// Runs experiment `index`, and keeps its loop record if the policy asks for it. `observer` sees each step
  /// of each of its loops.
  ExperimentRecord run(std::int64_t index, StorePolicy store, const StepObserver& observer = {});

  /// The answers of the methods on an experiment with status ok that was run before: on its stored loop, or
  /// on the loop run again if it was not stored.
  std::vector<AssessmentRecord> assess(const ExperimentRecord& record);
  /// The answers of these methods of the runner, in this order.
  std::vector<AssessmentRecord> assess(const ExperimentRecord& record,
                                       const std::vector<std::string>& methods);
  /// The loop of an experiment, run again.
  Trajectory simulated(const ExperimentDraw& draw) {
    return simulate_experiment(study_of(draw), draw, factory_);
  }
  /// The loop of such an experiment as the methods see it. If its controller has no S0 of its own, the loop
  /// has only y_sim.
  AssessedLoop loop_of(const ExperimentRecord& record);
  /// Another record of the plant of such an experiment, without a fault, as the methods see it: the world is
  /// the same; excitation, noise and historian are its own (own_benchmark_index()). It has no samples if its
  /// loop does not run to its end.
  AssessedLoop benchmark_of(const ExperimentRecord& record) const;
  /// Does assess() run loops of this experiment: its loop if it was not kept, the loops that give another S0,
  /// or for the chain the loops with each of two faults alone?
  bool runs_loops(const ExperimentRecord& record) const;

  const std::vector<std::shared_ptr<const AssessmentForm>>& forms() const { return panel_.forms(); }

 private:
  /// What is known about the loops of one world before they run: its benchmark, and the methods that have
  /// learnt from it.
  struct WorldCase {
    BasisCase basis;
    std::unique_ptr<MethodPanel> panel;  ///< null until a loop of this world is assessed
    double spectral_radius = kNaN;       ///< of its loops without a fault
  };
  /// One closed loop of an experiment, ready to be assessed.
  struct FinishedLoop {
    ExperimentStatus status;
    std::string message;  ///< why it failed; empty otherwise
    Trajectory trajectory;
    AssessedLoop assessed;          ///< only y_sim when the status is not ok
    std::optional<TunedBasis> own;  ///< of a changed tuning
  };

  FinishedLoop simulate(const ExperimentDraw& draw, const StepObserver& observer);
  FinishedLoop finished(const ExperimentDraw& draw, Trajectory trajectory);
  double spectral_radius(const ExperimentDraw& draw) const;
  /// Excludes an experiment that has run to its end if its loop, or the loop of its world without a fault, is
  /// not stable.
  void exclude_unstable(ExperimentRecord& record);
  FinishedLoop finished_again(const ExperimentRecord& record);
  void assess_alone(ExperimentRecord& record, const StepObserver& observer);
  /// Adds to the answer of the chain how much the mismatch dominates, from the loops with one fault alone.
  void add_dominance(AssessmentRecord& chain, const ExperimentDraw& draw, const FinishedLoop& mpm_alone,
                     const FinishedLoop& ud_alone);
  /// Adds the truth about an experiment that ran to its end.
  void add_truth(ExperimentRecord& record, const Trajectory& loop);

  /// y of the loop without the faults of the record, ny x N; a loop that is run for it counts in `solver`.
  Eigen::MatrixXd healthy_output(ExperimentRecord& record, const StepObserver& observer);
  /// The study with the excitation of this experiment.
  const Study& study_of(const ExperimentDraw& draw);
  const WorldCase& case_of(const ExperimentDraw& draw);
  const BasisCase& basis_of(const ExperimentDraw& draw);
  std::vector<AssessmentRecord> assessed(const ExperimentDraw& draw, const FinishedLoop& loop);
  std::optional<AssessmentRecord> assessed_by(std::string_view method, const ExperimentDraw& draw,
                                              const FinishedLoop& loop);
  /// Calls with(panel, own) of MethodPanel for a loop of this experiment.
  template <class Call>
  auto with_panel(const ExperimentDraw& draw, const FinishedLoop& loop, Call with);

  const Study& study_;
  const BasisCase& basis_;
  QpSolverFactory factory_;
  std::vector<std::string> methods_;
  MethodPanel panel_;  ///< of the exact world
  S0Perturbation perturbation_;
  LoopStability stability_;
  std::map<int, WorldCase> worlds_;                      ///< worlds of the experiments so far
  std::optional<std::pair<std::int64_t, Study>> moved_;  ///< study_of() of the last experiment
};

}  // namespace mpm
