#include "results/archive/columns.hpp"

#include <array>
#include <utility>

#include "plants/analyser.hpp"

namespace mpm {
namespace {

/// A member that is in the file as it is in memory, but for its type.
template <class T, auto member, class Owner>
Access<Owner, T> plain() {
  return {[](const Owner& owner) { return static_cast<T>(owner.*member); },
          [](Owner& owner, T value) {
            owner.*member = static_cast<std::remove_cvref_t<decltype(owner.*member)>>(std::move(value));
          }};
}

template <class T, auto problem, auto member>
Access<AuditedStep, T> of_difference() {
  return {[](const AuditedStep& step) { return static_cast<T>((step.*problem).*member); },
          [](AuditedStep& step, T value) {
            (step.*problem).*member =
                static_cast<std::remove_cvref_t<decltype((step.*problem).*member)>>(value);
          }};
}

}  // namespace

std::vector<Column<SolverStatistics>> solver_columns() {
  return {{{"solver_steps", "number of samples at which the controller was solved"},
           plain<std::int64_t, &SolverStatistics::steps, SolverStatistics>()},
          {{"solver_iterations", "number of iterations of the solver"},
           plain<std::int64_t, &SolverStatistics::iterations, SolverStatistics>()},
          {{"solver_fallbacks",
            "number of optimisation problems that Ipopt had to answer in place of the "
            "active-set method",
            "1", "0 unless the solver is auto"},
           plain<std::int64_t, &SolverStatistics::fallbacks, SolverStatistics>()},
          {{"kkt_residual_max", "largest KKT residual of a solution"},
           plain<double, &SolverStatistics::largest_kkt_residual, SolverStatistics>()}};
}

std::vector<Column<AuditedStep>> audit_columns() {
  const std::string no_answer = "NaN: one of the two has no answer";
  return {{{"experiment", "index of the experiment in the study"},
           plain<std::int64_t, &AuditedStep::experiment, AuditedStep>()},
          {{"step", "step of the controller, counted over all loops of the experiment"},
           plain<std::int64_t, &AuditedStep::step, AuditedStep>()},
          {{"target_same_status", "both solvers say the same of the target problem", "1", "", yes_no_flags()},
           of_difference<std::int8_t, &AuditedStep::targets, &AuditDifference::same_status>()},
          {{"target_difference", "largest difference of a target", "1", "in MV units; " + no_answer},
           of_difference<double, &AuditedStep::targets, &AuditDifference::x>()},
          {{"target_objective_difference", "relative difference of the objectives of the target problem", "1",
            no_answer},
           of_difference<double, &AuditedStep::targets, &AuditDifference::objective>()},
          {{"move_same_status", "both solvers say the same of the MPC problem", "1", "", yes_no_flags()},
           of_difference<std::int8_t, &AuditedStep::moves, &AuditDifference::same_status>()},
          {{"move_difference", "largest difference of a planned move", "1", "in MV units; " + no_answer},
           of_difference<double, &AuditedStep::moves, &AuditDifference::x>()},
          {{"move_objective_difference", "relative difference of the objectives of the MPC problem", "1",
            no_answer},
           of_difference<double, &AuditedStep::moves, &AuditDifference::objective>()},
          {{"ipopt_kkt_residual", "larger KKT residual of the two answers of Ipopt"},
           plain<double, &AuditedStep::ipopt_kkt_residual, AuditedStep>()}};
}

std::vector<Column<Trajectory>> loop_columns() {
  return {{{"status", "how the closed loop ended", "1", "",
            enum_flags(std::array{ControlStatus::ok, ControlStatus::infeasible, ControlStatus::failed})},
           plain<std::int8_t, &Trajectory::status, Trajectory>()},
          {{"samples_done", "number of samples with a move of the controller", "1",
            "records are zero after these unless the status is ok"},
           plain<std::int32_t, &Trajectory::samples_done, Trajectory>()},
          {{"failure", "what made the closed loop fail", "1", "",
            enum_flags(std::array{LoopFailure::none, LoopFailure::solver, LoopFailure::plant,
                                  LoopFailure::no_steady_state, LoopFailure::controller})},
           plain<std::int8_t, &Trajectory::failure, Trajectory>()},
          {{"message", "what failed", "1", "empty when nothing did"},
           plain<std::string, &Trajectory::message, Trajectory>()}};
}

std::vector<SignalColumn> signal_columns(const Study& study) {
  const PlantModel& plant = study.plant;
  const std::string u_comment = "u(k) acts from sample k on";
  const std::string d_comment = has_analysers(study.controller.md_analysers)
                                    ? "d(k) acts from sample k on; of an analyser what it shows at sample k"
                                    : "d(k) acts from sample k on";
  std::vector<SignalColumn> columns{
      {{"y", "measured CVs, noise included", common_unit(plant.cvs), "", {}, "time"}, "cv", &Trajectory::y},
      {{"u", "MVs", common_unit(plant.mvs), u_comment, {}, "time"}, "mv", &Trajectory::u},
      {{"u_target", "targets of the MVs", common_unit(plant.mvs), "", {}, "time"},
       "mv",
       &Trajectory::u_target},
      {{"d", "measured disturbances", common_unit(plant.mds), d_comment, {}, "time"}, "md", &Trajectory::d}};
  if (study.controller.has_setpoints())
    columns.push_back({{"y_set", "setpoints; 0 for a CV without one", common_unit(plant.cvs), "", {}, "time"},
                       "cv",
                       &Trajectory::y_set});
  return columns;
}

Eigen::Index row_count(const SignalColumn& signal, const Study& study) {
  return signal.rows == "cv" ? study.cv_count() : signal.rows == "mv" ? study.mv_count() : study.md_count();
}

VariableText y_sim_text(const Study& study) {
  return {"y_sim",
          "output of the nominal model under the recorded MVs and disturbances",
          common_unit(study.plant.cvs),
          "",
          {},
          "time"};
}

}  // namespace mpm
