#include "results/archive/columns.hpp"

#include <array>

namespace mpm {
namespace {

template <class Enum, std::size_t n>
Flags enum_flags(const std::array<Enum, n>& values) {
  Flags flags;
  for (const Enum value : values) {
    flags.values.push_back(static_cast<int>(value));
    flags.meanings.push_back(flag_word(std::string(to_string(value))));
  }
  return flags;
}

Flags parameter_flags() {
  Flags flags = enum_flags(
      std::array{MismatchParameter::gain, MismatchParameter::time_constant, MismatchParameter::dead_time});
  flags.values.insert(flags.values.begin(), -1);
  flags.meanings.insert(flags.meanings.begin(), "none");
  return flags;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Experiment = ExperimentRecord;
using ExperimentFlag = Access<Experiment, std::int8_t>;
using ExperimentIndex = Access<Experiment, std::int32_t>;
using ExperimentNumber = Access<Experiment, double>;

std::int8_t get_kind(const Experiment& record) {
  return static_cast<std::int8_t>(record.draw.kind);
}

/// Makes room for the faults of this kind.
void set_kind(Experiment& record, std::int8_t value) {
  ExperimentDraw& draw = record.draw;
  draw.kind = static_cast<ExperimentKind>(value);
  if (draw.kind == ExperimentKind::mpm || draw.kind == ExperimentKind::mpm_ud)
    draw.mismatches.emplace_back();
  if (draw.kind == ExperimentKind::ud || draw.kind == ExperimentKind::mpm_ud)
    draw.disturbances.emplace_back();
  if (draw.kind == ExperimentKind::tuning)
    draw.tuning.emplace();
}

/// With two random faults both are on the same CV.
void set_true_cv(Experiment& record, std::int32_t value) {
  for (Mismatch& mismatch : record.draw.mismatches)
    mismatch.cv = value;
  for (Disturbance& disturbance : record.draw.disturbances)
    disturbance.cv = value;
}

/// The fault of a random experiment. The faults of a named scenario are in the study, and in no column.
const Mismatch* drawn_mismatch(const Experiment& record) {
  return record.draw.named || record.draw.mismatches.empty() ? nullptr : &record.draw.mismatches.front();
}

const Disturbance* drawn_disturbance(const Experiment& record) {
  return record.draw.named || record.draw.disturbances.empty() ? nullptr : &record.draw.disturbances.front();
}

std::int32_t get_true_mv(const Experiment& record) {
  const Mismatch* mismatch = drawn_mismatch(record);
  return mismatch == nullptr ? -1 : static_cast<std::int32_t>(mismatch->input);
}

void set_true_mv(Experiment& record, std::int32_t value) {
  for (Mismatch& mismatch : record.draw.mismatches)
    mismatch.input = value;
}

std::int8_t get_parameter(const Experiment& record) {
  const Mismatch* mismatch = drawn_mismatch(record);
  return mismatch == nullptr ? std::int8_t{-1} : static_cast<std::int8_t>(mismatch->parameter);
}

void set_parameter(Experiment& record, std::int8_t value) {
  for (Mismatch& mismatch : record.draw.mismatches)
    mismatch.parameter = static_cast<MismatchParameter>(value);
}

template <double Mismatch::*member>
ExperimentNumber of_mismatch() {
  return {[](const Experiment& r) {
            const Mismatch* mismatch = drawn_mismatch(r);
            return mismatch == nullptr ? kNaN : mismatch->*member;
          },
          [](Experiment& r, double value) {
            for (Mismatch& mismatch : r.draw.mismatches)
              mismatch.*member = value;
          }};
}

template <double Disturbance::*member>
ExperimentNumber of_disturbance() {
  return {[](const Experiment& r) {
            const Disturbance* disturbance = drawn_disturbance(r);
            return disturbance == nullptr ? kNaN : disturbance->*member;
          },
          [](Experiment& r, double value) {
            for (Disturbance& disturbance : r.draw.disturbances)
              disturbance.*member = value;
          }};
}

/// A member of the change of the tuning, `none` without one.
template <class T, auto member>
Access<Experiment, T> of_tuning(T none) {
  return {
      [none](const Experiment& r) { return r.draw.tuning ? static_cast<T>((*r.draw.tuning).*member) : none; },
      [](Experiment& r, T value) {
        if (r.draw.tuning)
          (*r.draw.tuning).*member =
              static_cast<std::remove_cvref_t<decltype((*r.draw.tuning).*member)>>(value);
      }};
}

/// What is wrong in an experiment, the tuning of the controller included.
VariableText kind_text(const Study& study) {
  VariableText text{"kind", "what is wrong in the experiment", "1",
                    "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both", kind_flags()};
  if (study.experiments.tuning > 0) {
    text.comment += "; tuning: a weight of the controller";
    text.flags.values.push_back(static_cast<int>(ExperimentKind::tuning));
    text.flags.meanings.emplace_back(to_string(ExperimentKind::tuning));
  }
  return text;
}

/// In a study with bad tunings only: an archive of another one stays as it was before there were any.
void append_tuning(std::vector<Column<Experiment>>& columns) {
  Flags parameters = enum_flags(kTuningParameters);
  parameters.values.insert(parameters.values.begin(), -1);
  parameters.meanings.insert(parameters.meanings.begin(), "none");
  columns.push_back(
      {{"tuning_parameter", "weight of the controller that is changed", "1",
        "move_suppression, target_weight: of an MV; slack_weight, setpoint_weight: of a CV", parameters},
       of_tuning<std::int8_t, &TuningChange::parameter>(-1)});
  columns.push_back({{"tuning_index", "position of the MV in mv, or of the CV in cv, whose weight is changed",
                      "1", "-1: none"},
                     of_tuning<std::int32_t, &TuningChange::index>(-1)});
  columns.push_back({{"tuning_factor", "factor of the weight", "1", "NaN: none"},
                     of_tuning<double, &TuningChange::factor>(kNaN)});
}

/// A member that is in the file as it is in memory, but for its type.
template <class T, auto member, class Owner>
Access<Owner, T> plain() {
  return {[](const Owner& owner) { return static_cast<T>(owner.*member); },
          [](Owner& owner, T value) {
            owner.*member = static_cast<std::remove_cvref_t<decltype(owner.*member)>>(std::move(value));
          }};
}

template <class T, auto member>
Access<Diagnosis, T> of_indicator() {
  return {[](const Diagnosis& owner) { return static_cast<T>(owner.indicator.*member); },
          [](Diagnosis& owner, T value) { owner.indicator.*member = value; }};
}

/// A count of the scan behind I_MPM.
template <auto member>
Access<CvDiagnosis, std::int32_t> of_distribution() {
  return {[](const CvDiagnosis& cv) { return std::int32_t{cv.distribution.mpm.*member}; },
          [](CvDiagnosis& cv, std::int32_t value) { cv.distribution.mpm.*member = value; }};
}

/// The numbers of a part of an owner; `of` gives that part. A verdict becomes a flag.
template <class Owner, class Part, class Of>
void append_numbers(std::vector<Column<Owner>>& columns, const std::vector<NumberColumn<Part>>& numbers,
                    const std::string& prefix, Of of) {
  for (const NumberColumn<Part>& number : numbers) {
    VariableText text{prefix + number.name, number.meaning, number.unit};
    for (const std::string& word : number.words) {
      text.flags.values.push_back(static_cast<int>(text.flags.values.size()));
      text.flags.meanings.push_back(word);
    }
    const auto get = [value = number.value, of](const Owner& owner) { return value(of(owner)); };
    const auto set = [put = number.set, of](Owner& owner, double value) { put(of(owner), value); };
    if (number.words.empty())
      columns.push_back({text, Access<Owner, double>{get, set}});
    else
      columns.push_back(
          {text, Access<Owner, std::int8_t>{
                     [get](const Owner& owner) { return static_cast<std::int8_t>(get(owner)); }, set}});
  }
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

Flags kind_flags() {
  return enum_flags(
      std::array{ExperimentKind::none, ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud});
}

std::vector<Column<ExperimentRecord>> draw_columns(const Study& study) {
  const std::string time = unit_text(study.plant.time_unit);
  std::vector<Column<ExperimentRecord>> columns{
      {kind_text(study), ExperimentFlag{get_kind, set_kind}},
      {{"status", "how the experiment ended", "1",
        "infeasible: an MPC problem had no solution, the experiment is left out; failed: see message",
        enum_flags(std::array{ExperimentStatus::ok, ExperimentStatus::infeasible, ExperimentStatus::failed})},
       plain<std::int8_t, &Experiment::status, Experiment>()},
      {{"true_cv", "position of the affected CV in cv", "1", "-1: none, or more than one",
        index_flags(study.plant.cvs)},
       ExperimentIndex{[](const Experiment& r) { return static_cast<std::int32_t>(r.draw.true_cv()); },
                       set_true_cv}},
      {{"true_mv", "position of the MV of the mismatched channel in mv", "1",
        "-1: no mismatch, or a named scenario", index_flags(study.plant.mvs)},
       ExperimentIndex{get_true_mv, set_true_mv}},
      {{"parameter", "parameter of the channel that differs from the model", "1",
        "-1: no mismatch, or a named scenario", parameter_flags()},
       ExperimentFlag{get_parameter, set_parameter}},
      {{"parameter_value", "size of the mismatch", "1",
        "factor of gain or time constant; shift of the dead time in " + time +
            "; NaN: no mismatch, or a named scenario"},
       of_mismatch<&Mismatch::value>()},
      {{"ud_gain", "gain of the unmeasured disturbance model", common_unit(study.plant.cvs),
        "in the unit of the affected CV; NaN: no disturbance, or a named scenario"},
       of_disturbance<&Disturbance::gain>()},
      {{"ud_time_constant", "time constant of the unmeasured disturbance model", time,
        "NaN: no disturbance, or a named scenario"},
       of_disturbance<&Disturbance::time_constant>()},
  };
  if (study.experiments.tuning > 0)
    append_tuning(columns);
  return columns;
}

std::vector<CvColumn<Diagnosis>> variance_columns() {
  const std::string comment = "NaN unless the status is ok";
  return {
      {{"ivar", "Ivar = var y / var y0", "1", comment}, &Diagnosis::ivar},
      {{"ivar_diag", "Ivar_diag = var y / var y0_diag", "1", comment}, &Diagnosis::ivar_diag},
      {{"ivar_basis", "Ivar_basis = var y / var y of the basis case", "1", comment}, &Diagnosis::ivar_basis}};
}

std::vector<Column<Diagnosis>> verdict_columns(const Study& study) {
  return {
      {{"impactful", "some Ivar lies outside the band of impact", "1", "", yes_no_flags()},
       plain<std::int8_t, &Diagnosis::impactful, Diagnosis>()},
      {{"predicted_cv", "position in cv of the CV that Ivar_diag points at", "1", "-1: none",
        index_flags(study.plant.cvs)},
       plain<std::int32_t, &Diagnosis::predicted_cv, Diagnosis>()},
      {{"predicted_source", "source that I_MPM points at", "1", "none: no verdict", kind_flags()},
       plain<std::int8_t, &Diagnosis::predicted_source, Diagnosis>()},
      {{"co_dkts", "mean correlation of the differenced moving kurtosis"},
       of_indicator<double, &MpmIndicator::co_dkts>()},
      {{"co_dskn", "mean correlation of the differenced moving skewness"},
       of_indicator<double, &MpmIndicator::co_dskn>()},
      {{"i_mpm", "I_MPM = max(co_dkts, co_dskn)"}, of_indicator<double, &MpmIndicator::i_mpm>()},
      {{"co_kts", "mean correlation of the moving kurtosis"}, of_indicator<double, &MpmIndicator::co_kts>()},
      {{"co_skn", "mean correlation of the moving skewness"}, of_indicator<double, &MpmIndicator::co_skn>()},
      {{"windows_scanned", "number of moving-window lengths"},
       of_indicator<std::int32_t, &MpmIndicator::scanned>()},
      {{"windows_used", "number of window lengths behind the weakest of the means"},
       of_indicator<std::int32_t, &MpmIndicator::used>()},
  };
}

std::vector<Column<CvDiagnosis>> cv_columns() {
  std::vector<Column<CvDiagnosis>> columns{
      {{"flagged", "Ivar_diag lies outside the band of impact", "1", "", yes_no_flags()},
       plain<std::int8_t, &CvDiagnosis::flagged, CvDiagnosis>()},
      {{"source", "source of a flagged CV that I_MPM points at", "1", "none: not flagged", kind_flags()},
       plain<std::int8_t, &CvDiagnosis::source, CvDiagnosis>()},
      {{"sse", "SSE = norm of y_sim - y", "1", "in the unit of the CV; NaN unless the status is ok"},
       plain<double, &CvDiagnosis::sse, CvDiagnosis>()},
      {{"windows_scanned", "number of moving-window lengths"}, of_distribution<&MpmIndicator::scanned>()},
      {{"windows_used", "number of window lengths behind the weakest of the means"},
       of_distribution<&MpmIndicator::used>()},
  };
  const auto distribution = [](auto& cv) -> auto& {
    return cv.distribution;
  };
  append_numbers(columns, distribution_columns(), "", distribution);
  append_numbers(columns, scatter_columns(), "", distribution);
  append_numbers(
      columns, acf_columns(), "", [](auto& cv) -> auto& { return cv.acf; });
  return columns;
}

std::vector<Column<AcfComparison>> basis_acf_columns() {
  std::vector<Column<AcfComparison>> columns;
  append_numbers(
      columns, acf_columns(), "basis_", [](auto& acf) -> auto& { return acf; });
  return columns;
}

std::vector<Column<ExperimentRecord>> dominance_columns() {
  const std::string comment = "NaN unless the kind is mpm_ud and the status is ok";
  return {
      {{"ivar_diag_mpm_alone", "Ivar_diag of the affected CV with the mismatch alone", "1", comment},
       plain<double, &Experiment::ivar_diag_mpm_alone, Experiment>()},
      {{"ivar_diag_ud_alone", "Ivar_diag of the affected CV with the disturbance alone", "1", comment},
       plain<double, &Experiment::ivar_diag_ud_alone, Experiment>()},
      {{"dominance_mpm", "share of the mismatch in Ivar_diag", "1", comment},
       plain<double, &Experiment::dominance_mpm, Experiment>()},
      {{"message", "why the experiment failed", "1", "empty unless the status is failed"},
       plain<std::string, &Experiment::message, Experiment>()},
  };
}

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
          {{"reference_kkt_residual", "larger KKT residual of the two answers of Ipopt"},
           plain<double, &AuditedStep::reference_kkt_residual, AuditedStep>()}};
}

std::vector<Column<MethodVerdict>> method_verdict_columns(const Study& study) {
  return {{{"status", "how the assessment ended", "1", "see reason where it is not ok",
            enum_flags(std::array{AssessmentStatus::ok, AssessmentStatus::not_applicable,
                                  AssessmentStatus::failed})},
           plain<std::int8_t, &MethodVerdict::status, MethodVerdict>()},
          {{"flagged", "something is wrong with the loop", "1", "no unless the status is ok", yes_no_flags()},
           plain<std::int8_t, &MethodVerdict::flagged, MethodVerdict>()},
          {{"score", "how far the loop is from being flagged, larger is worse", "1",
            "comparable between loops of one method; NaN unless the status is ok"},
           plain<double, &MethodVerdict::score, MethodVerdict>()},
          {{"located_cv", "position in cv of the CV with the largest score", "1", "-1: none",
            index_flags(study.plant.cvs)},
           plain<std::int32_t, &MethodVerdict::located_cv, MethodVerdict>()},
          {{"source", "source that the method sees in the located CV", "1", "none: the method tells none",
            kind_flags()},
           plain<std::int8_t, &MethodVerdict::source, MethodVerdict>()},
          {{"seconds", "processor time of the assessment", "s", "differs from run to run"},
           plain<double, &MethodVerdict::seconds, MethodVerdict>()}};
}

std::vector<Column<Trajectory>> loop_columns() {
  return {{{"status", "how the closed loop ended", "1", "",
            enum_flags(std::array{ControlStatus::ok, ControlStatus::infeasible, ControlStatus::failed})},
           plain<std::int8_t, &Trajectory::status, Trajectory>()},
          {{"samples_done", "number of samples with a move of the controller", "1",
            "records are zero after these unless the status is ok"},
           plain<std::int32_t, &Trajectory::samples_done, Trajectory>()}};
}

std::vector<SignalColumn> signal_columns(const Study& study) {
  const PlantModel& plant = study.plant;
  const std::string u_comment = "u(k) acts from sample k on";
  const std::string d_comment = "d(k) acts from sample k on";
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
