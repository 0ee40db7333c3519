#include "results/archive/loop_rows.hpp"

#include <array>
#include <cstdint>

#include "plants/analyser.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {

std::vector<Row<SolverStatistics>> solver_rows() {
  using S = SolverStatistics;
  return {
      member_row<std::int64_t>({"solver_steps", "number of samples at which the controller was solved"},
                               &S::steps),
      member_row<std::int64_t>({"solver_iterations", "number of iterations of the solver"}, &S::iterations),
      member_row<std::int64_t>(
          {"solver_fallbacks",
           "number of optimisation problems that Ipopt solved instead of the active-set method", "1",
           "0 unless the solver is auto"},
          &S::fallbacks),
      member_row<double>({"kkt_residual_max", "largest KKT residual of a solution"},
                         &S::largest_kkt_residual)};
}

std::vector<Row<AuditedStep>> audit_rows() {
  using A = AuditedStep;
  using D = AuditDifference;
  const std::string no_answer = "NaN: one of the two has no solution";
  std::vector<Row<A>> rows{
      member_row<std::int64_t>({"experiment", "index of the experiment in the study"}, &A::experiment),
      member_row<std::int64_t>({"step", "step of the controller, counted over all loops of the experiment"},
                               &A::step)};
  const auto compared = [&](const std::string& name, const std::string& x, const std::string& problem,
                            D A::*of) {
    rows.push_back(member_row<std::int8_t, A>(
        {name + "_same_status", "both solvers give the same status for the " + problem, "1", "", no_yes()},
        path(of, &D::same_status)));
    rows.push_back(member_row<double, A>(
        {name + "_difference", "largest difference of a " + x, "1", "in MV units; " + no_answer},
        path(of, &D::x)));
    rows.push_back(
        member_row<double, A>({name + "_objective_difference",
                               "relative difference of the objectives of the " + problem, "1", no_answer},
                              path(of, &D::objective)));
  };
  compared("target", "target", "target problem", &A::targets);
  compared("move", "planned move", "MPC problem", &A::moves);
  rows.push_back(member_row<double>(
      {"ipopt_kkt_residual", "larger KKT residual of the two solutions of Ipopt"}, &A::ipopt_kkt_residual));
  return rows;
}

std::vector<Row<Trajectory>> loop_rows() {
  using T = Trajectory;
  return {member_row<std::int8_t>(
              {"status", "how the closed loop ended", "1", "",
               enum_words(std::array{ControlStatus::ok, ControlStatus::infeasible, ControlStatus::failed})},
              &T::status),
          member_row<std::int32_t>({"samples_done", "number of samples with a move of the controller", "1",
                                    "records are zero after these unless the status is ok"},
                                   &T::samples_done),
          member_row<std::int8_t>(
              {"failure", "what made the closed loop fail", "1", "", enum_words<LoopFailure>()}, &T::failure),
          member_row<std::string>({"message", "what failed", "1", "empty when nothing did"}, &T::message)};
}

std::vector<Row<Trajectory>> signal_rows(const Study& study) {
  const PlantModel& plant = study.plant;
  std::vector<Row<Trajectory>> rows;
  const auto add = [&](const char* name, const char* meaning, const std::string& unit, const char* special,
                       const char* of, Eigen::MatrixXd Trajectory::*member) {
    rows.push_back(signal_row<Trajectory>(study, {name, meaning, unit, special}, of, member).along("time"));
  };
  const std::string cv_unit = common_unit(plant.cvs), mv_unit = common_unit(plant.mvs);
  add("y", "measured CVs, noise included", cv_unit, "", "cv", &Trajectory::y);
  if (study.record.resamples())
    add("y_sampled", "CVs at the times of the rows of the record, noise included", cv_unit, "", "cv",
        &Trajectory::y_sampled);
  add("u", "MVs", mv_unit, "u(k) acts from sample k on", "mv", &Trajectory::u);
  add("u_target", "targets of the MVs", mv_unit, "", "mv", &Trajectory::u_target);
  add("d", "measured disturbances", common_unit(plant.mds),
      has_analysers(study.controller.md_analysers)
          ? "d(k) acts from sample k on; of an analyser what it shows at sample k"
          : "d(k) acts from sample k on",
      "md", &Trajectory::d);
  if (study.controller.has_setpoints())
    add("y_set", "setpoints; 0 for a CV without one", cv_unit, "", "cv", &Trajectory::y_set);
  return rows;
}

std::vector<Row<NominalOutputs>> nominal_rows(const Study& study) {
  const auto row = [&](const char* name, const char* meaning, Eigen::MatrixXd NominalOutputs::*member) {
    return signal_row<NominalOutputs>(study, {name, meaning, common_unit(study.plant.cvs)}, "cv", member)
        .along("time");
  };
  return {row("y_sim", "output of the nominal model under the recorded MVs and disturbances",
              &NominalOutputs::y_sim),
          row("y0", "nominal output y + S0 (y_sim - y)", &NominalOutputs::y0),
          row("y0_diag", "nominal diagonal output y + S0_diag (y_sim - y)", &NominalOutputs::y0_diag)};
}

}  // namespace mpm
