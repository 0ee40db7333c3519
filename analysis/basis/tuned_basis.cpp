#include "analysis/basis/tuned_basis.hpp"

#include <algorithm>

#include "analysis/basis/basis_runs.hpp"
#include "base/error.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

/// Counts the steps of the loops of a basis case, and remembers how the last one ended.
class StepCounter {
 public:
  explicit StepCounter(SolverStatistics& statistics) : statistics_(statistics) {}

  void observe(const Controller& controller) {
    ++statistics_.steps;
    last_ = QpStatus::solved;
    const std::optional<SolvedQp> moves = controller.move_problem();
    if (const std::optional<SolvedQp> targets = controller.target_problem())
      add(targets->result);
    if (last_ == QpStatus::solved && moves)  // otherwise there were no moves to be found
      add(moves->result);
  }
  /// What ended the loops, if something did: `failed` if the solver gave up on the last problem, otherwise
  /// `infeasible`.
  ControlStatus reason() const {
    const bool gave_up = last_ != QpStatus::solved && last_ != QpStatus::infeasible;
    return gave_up ? ControlStatus::failed : ControlStatus::infeasible;
  }

 private:
  void add(const QpResult& result) {
    last_ = result.status;
    statistics_.iterations += result.iterations;
    statistics_.fallbacks += result.from_ipopt ? 1 : 0;
    if (result.status != QpStatus::solved)
      return;
    statistics_.largest_kkt_residual = std::max(statistics_.largest_kkt_residual, result.kkt_residual);
  }

  SolverStatistics& statistics_;
  QpStatus last_ = QpStatus::solved;
};

}  // namespace

bool has_tuned_basis(const Study& study, const ExperimentDraw& draw) {
  return draw.tuning && study.tuning.sensitivity != TuningSensitivity::design;
}

std::optional<TunedBasis> tuned_basis(const Study& study, const ExperimentDraw& draw,
                                      const QpSolverFactory& factory) {
  if (!has_tuned_basis(study, draw))
    return std::nullopt;
  TunedBasis own{with_tuning(study, draw), {}, {}};
  own.study.s0_perturbation = {};
  StepCounter counter(own.solver);
  try {
    own.basis = run_basis_case(own.study, factory,
                               [&](const Controller& controller) { counter.observe(controller); });
  } catch (const InputError& error) {
    // The study itself has an S0, so the changed weight is the reason that there is none.
    own.basis.trajectory.status = counter.reason();
    own.basis.explanation = error.what();
  }
  return own;
}

}  // namespace mpm
