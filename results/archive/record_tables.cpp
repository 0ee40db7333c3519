#include "results/archive/record_tables.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "analysis/experiment/judgement.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"
#include "results/archive/loop_rows.hpp"
#include "results/archive/variable_text.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/world.hpp"

namespace mpm {
namespace {

using Record = ExperimentRecord;
using Draw = ExperimentDraw;
using DrawRow = Row<Draw>;

template <class Owner>
void append(const std::vector<Row<Owner>>& further, std::vector<Row<Owner>>& rows) {
  rows.insert(rows.end(), further.begin(), further.end());
}

/// The lens of the content of an optional.
const auto kContent = [](auto& optional) -> auto& {
  return *optional;
};

// --- What was drawn ---

/// Makes room for the faults of this kind.
void set_kind(Draw& draw, std::int8_t value) {
  draw.kind = static_cast<ExperimentKind>(value);
  if (draw.kind == ExperimentKind::mpm || draw.kind == ExperimentKind::mpm_ud)
    draw.mismatches.emplace_back();
  if (draw.kind == ExperimentKind::ud || draw.kind == ExperimentKind::mpm_ud)
    draw.disturbances.emplace_back();
  if (draw.kind == ExperimentKind::tuning)
    draw.tuning.emplace();
}

/// Sets the CV of all faults: two random faults are on the same CV. A fault of another kind affects the CVs
/// that it states.
void set_true_cv(Draw& draw, std::int32_t value) {
  if (draw.kind == ExperimentKind::other && value >= 0)
    draw.affected_cvs = std::vector<Eigen::Index>{value};
  for (Mismatch& mismatch : draw.mismatches)
    mismatch.cv = value;
  for (Disturbance& disturbance : draw.disturbances)
    disturbance.cv = value;
}

/// A member of the fault of a random experiment; `none` if there is no fault. The faults of a named scenario
/// are in the study and not in a row.
template <class T, class Fault, class Member>
DrawRow of_fault(NumberText text, std::vector<Fault> Draw::*faults, Member Fault::*member, T none) {
  return value_row<T, Draw>(
      std::move(text),
      [=](const Draw& draw) {
        const std::vector<Fault>& list = draw.*faults;
        return draw.named || list.empty() ? none : static_cast<T>(list.front().*member);
      },
      [=](Draw& draw, T value) {
        for (Fault& fault : draw.*faults)
          fault.*member = static_cast<Member>(value);
      });
}

/// A member of the change of the tuning; `none` if there is no change.
template <class T, class Member>
DrawRow of_tuning(NumberText text, Member TuningChange::*member, T none) {
  return value_row<T, Draw>(
      std::move(text),
      [=](const Draw& draw) { return draw.tuning ? static_cast<T>((*draw.tuning).*member) : none; },
      [=](Draw& draw, T value) {
        if (draw.tuning)
          (*draw.tuning).*member = static_cast<Member>(value);
      });
}

NumberText kind_text(const Study& study) {
  std::vector<ExperimentKind> kinds{ExperimentKind::healthy, ExperimentKind::mpm, ExperimentKind::ud,
                                    ExperimentKind::mpm_ud, ExperimentKind::tuning};
  std::string special = "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both";
  if (study.experiments.other > 0) {
    kinds.push_back(ExperimentKind::other);
    special += "; other: neither, see other_fault";
  }
  if (study.experiments.tuning > 0)
    special += "; tuning: a weight of the controller";
  return {"kind", "what is wrong in the experiment", "1", special, enum_words(kinds)};
}

std::vector<NumberWord> parameter_words(const Study& study) {
  if (study.has_plain_faults())
    return enum_words(
        std::array{MismatchParameter::gain, MismatchParameter::time_constant, MismatchParameter::dead_time});
  return enum_words(kRandomMismatchParameters);
}

/// The shape of the signal of the first disturbance.
DisturbanceShape shape_of(const DisturbanceSignal& signal) {
  return std::visit(
      []<class Signal>(const Signal&) {
        return std::is_same_v<Signal, StepSequence> ? DisturbanceShape::step
               : std::is_same_v<Signal, Ramp>       ? DisturbanceShape::ramp
               : std::is_same_v<Signal, RandomWalk> ? DisturbanceShape::random_walk
               : std::is_same_v<Signal, Sine>       ? DisturbanceShape::sine
               : std::is_same_v<Signal, Bursts>     ? DisturbanceShape::burst
                                                    : DisturbanceShape::white;
      },
      signal);
}

/// A row that follows from study and index alone.
template <class T>
DrawRow follows(NumberText text, std::function<T(const Draw&)> get) {
  return value_row<T, Draw>(std::move(text), std::move(get)).only(RowUse::archive_only);
}

/// Rows of what is drawn beyond one parameter of one channel and noise on one CV.
std::vector<DrawRow> further_draws(const Study& study) {
  const auto whole = follows<std::int32_t>;
  std::vector<DrawRow> rows{
      whole({"mismatches", "parameters of channels or of the plant that differ from the model"},
            [](const Draw& draw) {
              return static_cast<std::int32_t>(draw.mismatches.size() + draw.parameters.size());
            }),
      whole({"disturbances", "places where an unmeasured disturbance acts"},
            [](const Draw& draw) { return static_cast<std::int32_t>(draw.disturbances.size()); }),
      follows<std::int8_t>({"ud_signal", "shape of the signal of the unmeasured disturbance", "1",
                            "-1: no disturbance", with_none(enum_words<DisturbanceShape>())},
                           [](const Draw& draw) {
                             return draw.disturbances.empty() ? std::int8_t{-1}
                                                              : static_cast<std::int8_t>(shape_of(
                                                                    draw.disturbances.front().signal));
                           }),
      whole({"ud_mv", "position in mv of the MV on which the unmeasured disturbance acts", "1", "-1: on none",
             index_words(study.plant.mvs)},
            [](const Draw& draw) {
              return static_cast<std::int32_t>(
                  draw.disturbances.empty() ? -1 : draw.disturbances.front().mv.value_or(-1));
            }),
      whole({"onset", "sample at which the faults begin"},
            [](const Draw& draw) { return static_cast<std::int32_t>(draw.onset.sample); }),
      whole({"onset_growth", "samples over which the faults grow"},
            [](const Draw& draw) { return static_cast<std::int32_t>(draw.onset.growth); })};
  if (study.experiments.other == 0)
    return rows;
  rows.push_back(follows<std::int8_t>({"other_fault", "what is wrong besides model and disturbance", "1",
                                       "-1: nothing", with_none(enum_words<OtherFaultKind>())},
                                      [](const Draw& draw) {
                                        return draw.other ? static_cast<std::int8_t>(draw.other->kind)
                                                          : std::int8_t{-1};
                                      }));
  rows.push_back(whole(
      {"other_variable", "position of the CV, MV or MD at fault, in cv, mv or md", "1", "-1: none"},
      [](const Draw& draw) { return static_cast<std::int32_t>(draw.other ? draw.other->variable : -1); }));
  rows.push_back(follows<double>({"other_size", "size of the other fault", "1",
                                  "in the unit of its variable, a factor for the gain of an MD; NaN: none"},
                                 [](const Draw& draw) { return draw.other ? draw.other->size : kNaN; }));
  return rows;
}

std::vector<DrawRow> draw_rows(const Study& study) {
  const std::string time = unit_text(study.plant.time_unit);
  std::vector<DrawRow> rows{
      value_row<std::int8_t, Draw>(
          kind_text(study), [](const Draw& draw) { return static_cast<std::int8_t>(draw.kind); }, set_kind),
      value_row<std::int32_t, Draw>(
          {"true_cv", "position of the affected CV in cv", "1", "-1: none, or more than one",
           index_words(study.plant.cvs)},
          [](const Draw& draw) { return static_cast<std::int32_t>(draw.true_cv()); }, set_true_cv),
      of_fault<std::int32_t>({"true_mv", "position of the MV of the mismatched channel in mv", "1",
                              "-1: no mismatch, or a named scenario", index_words(study.plant.mvs)},
                             &Draw::mismatches, &Mismatch::input, -1),
      of_fault<std::int8_t>({"parameter", "parameter of the channel that differs from the model", "1",
                             "-1: no mismatch, or a named scenario", with_none(parameter_words(study))},
                            &Draw::mismatches, &Mismatch::parameter, -1),
      of_fault<double>({"parameter_value", "size of the mismatch", "1",
                        "factor of gain or time constant; shift of the dead time in " + time +
                            "; NaN: no mismatch, or a named scenario"},
                       &Draw::mismatches, &Mismatch::value, kNaN),
      of_fault<double>({"ud_gain", "gain of the unmeasured disturbance model", common_unit(study.plant.cvs),
                        "in the unit of the affected CV; NaN: no disturbance, or a named scenario"},
                       &Draw::disturbances, &Disturbance::gain, kNaN),
      of_fault<double>({"ud_time_constant", "time constant of the unmeasured disturbance model", time,
                        "NaN: no disturbance, or a named scenario"},
                       &Draw::disturbances, &Disturbance::time_constant, kNaN),
  };
  if (!study.has_plain_faults())
    append(further_draws(study), rows);
  if (study.simulation.noise.factor != Distribution::constant(1))
    rows.push_back(
        member_row<double>({"noise_factor", "factor of the standard deviations of the measurement noise", "1",
                            "relative to those of the study, which the basis case has"},
                           &Draw::noise_factor));
  if (study.world)
    rows.push_back(value_row<std::int32_t, Draw>(
        {"world", "world in which the experiment takes place", "1", "from 0"},
        [](const Draw& draw) { return static_cast<std::int32_t>(draw.world); },
        [study](Draw& draw, std::int32_t) { draw.world = world_of(study, draw.index); }));
  if (study.record.candidates > 0)
    rows.push_back(value_row<std::int32_t, Draw>(
        {"true_candidate", "position of the logged candidate that drives the disturbance", "1",
         "-1: none of them does"},
        [study](const Draw& draw) { return static_cast<std::int32_t>(true_candidate(study, draw)); },
        [](Draw&, std::int32_t) {}));  // it follows from the draw
  if (study.experiments.tuning == 0)
    return rows;
  rows.push_back(of_tuning<std::int8_t>(
      {"tuning_parameter", "weight of the controller that is changed", "1",
       "move_suppression, target_weight: of an MV; slack_weight, setpoint_weight: of a CV",
       with_none(enum_words<TuningParameter>())},
      &TuningChange::parameter, -1));
  rows.push_back(of_tuning<std::int32_t>(
      {"tuning_index", "position of the MV in mv, or of the CV in cv, whose weight is changed", "1",
       "-1: none"},
      &TuningChange::index, -1));
  rows.push_back(of_tuning<double>({"tuning_factor", "factor of the weight", "1", "NaN: none"},
                                   &TuningChange::factor, kNaN));
  return rows;
}

/// The scales of the faults that pilot loops have found. The bytes must keep them, because the experiment is
/// drawn again with them.
std::vector<DrawRow> scale_rows(const Study& study) {
  const auto of_scale = [&](const char* name, const char* special, double FaultScales::*scale) {
    return value_row<double, Draw>(
        {name, "scale of the drawn sizes that gives the effect that the study sets", "1", special},
        path(&Draw::scales, scale), [study, scale](Draw& draw, double value) {
          FaultScales scales = draw.scales;
          scales.*scale = value;
          draw = with_scales(study, draw_experiment(study, draw.index), scales);
        });
  };
  return {
      of_scale("mismatch_scale", "exponent of factors, factor of times", &FaultScales::mismatch),
      of_scale("disturbance_scale", "factor of the gain", &FaultScales::disturbance),
      of_scale("other_scale", "factor of the size; exponent of the factor of an MD", &FaultScales::other)};
}

// --- How it ended, the truth, and the verdicts ---

/// Returns the same row, read back only into records with status ok.
RecordRow of_ok(RecordRow row) {
  std::visit(
      [](auto& access) {
        access.set = [set = access.set](Record& record, const auto* values) {
          if (record.status == ExperimentStatus::ok)
            set(record, values);
        };
      },
      row.access);
  return row;
}

/// The lens of the cost of the faults. When a record with status ok is read, its cost is created here.
struct CostLens {
  const FaultCost& operator()(const Record& record) const {
    static const FaultCost none{{}, {}, {}, kNaN, kNaN, kNaN, kNaN};
    return record.cost ? *record.cost : none;
  }
  FaultCost& operator()(Record& record) const {
    if (!record.cost)
      record.cost.emplace();
    record.cost->variance_ratio = record.ivar_basis;
    return *record.cost;
  }
};

/// What faults cost in the worlds of a study, without the ratios of the variances: those are in ivar_basis.
std::vector<Row<FaultCost>> fault_cost_rows(const Study& study) {
  using C = FaultCost;
  const std::string same =
      "against the same loop without the fault, mean over noise; NaN where the status is not ok, and "
      "where one of these loops does not run to its end";
  const auto of_cv = [&](NumberText text, Eigen::VectorXd C::*member) {
    return vector_row<C>(std::move(text), "cv", study.cv_count(), member);
  };
  std::vector<Row<FaultCost>> rows{
      of_cv({"loss", "what the fault adds to the cost of the CV in the weights of the controller", "1", same},
            &C::loss),
      of_cv({"violation", "what the fault adds to the mean distance outside the soft limits",
             common_unit(study.plant.cvs), same},
            &C::violation),
      member_row<double>({"loss_ratio", "cost of the loop with the fault over that without it", "1",
                          same + ", or if both costs are 0; infinite if only the latter is 0"},
                         &C::loss_ratio),
      member_row<double>({"loss_ratio_error", "standard error of loss_ratio", "1",
                          "NaN: of one pair of loops, or as loss_ratio"},
                         &C::error),
      member_row<double>({"effort", "what the fault adds to the cost of the moves", "1", same}, &C::effort),
      member_row<double>(
          {"economics", "what the fault adds to the objective of the target optimizer", "1", same},
          &C::economics)};
  if (study.diagnosis.impact == ImpactMeasure::cost)
    append<FaultCost>(
        {of_cv({"cost_ratio",
                "cost of the CV in its controller from the onset on, over the cost without the fault: "
                "squared distance from the setpoint, or squared distance outside of the soft limits plus the "
                "variance of the noise",
                "1", same},
               &C::cost_ratio),
         of_cv({"cost_ratio_error", "standard error of cost_ratio", "1", "NaN: as loss_ratio_error"},
               &C::cost_ratio_error)},
        rows);
  return rows;
}

/// The channels of some inputs in a matrix of RepairGains: `count` columns from column `first` on.
Row<RepairGains> repair_gain_row(const Study& study, NumberText text, const char* inputs, Eigen::Index first,
                                 Eigen::Index count, Eigen::MatrixXd RepairGains::*member) {
  const Eigen::Index rows = study.cv_count(), all = study.mv_count() + study.md_count();
  RowAccess<RepairGains, double> access{[=](const RepairGains& gains, double* values) {
                                          Eigen::Map<RowMajorMatrix> to(values, rows, count);
                                          if (const Eigen::MatrixXd& from = gains.*member; from.size() == 0)
                                            to.setConstant(kNaN);
                                          else
                                            to = from.middleCols(first, count);
                                        },
                                        [=](RepairGains& gains, const double* values) {
                                          Eigen::MatrixXd& to = gains.*member;
                                          if (to.size() == 0)
                                            to.setConstant(rows, all, kNaN);
                                          to.middleCols(first, count) =
                                              Eigen::Map<const RowMajorMatrix>(values, rows, count);
                                        }};
  Row<RepairGains> row{std::move(text),
                       {"cv", inputs},
                       {static_cast<std::size_t>(rows), static_cast<std::size_t>(count)},
                       std::move(access)};
  return row.from_version(5);
}

/// What repairs of the model would gain in the worlds of a study.
std::vector<Row<RepairGains>> repair_gain_rows(const Study& study) {
  std::vector<Row<RepairGains>> rows;
  const auto add = [&](const std::string& name, const char* inputs, Eigen::Index first, Eigen::Index count) {
    rows.push_back(repair_gain_row(
        study,
        {name,
         "cost that the true channel in the model of the controller saves, over the cost without the fault",
         "1", "0: plant and model agree; NaN: not computed, or the repaired loop does not run to its end"},
        inputs, first, count, &RepairGains::gain));
    rows.push_back(repair_gain_row(
        study, {name + "_error", "standard error of " + name, "1", "NaN: of one loop, or as repair_gain"},
        inputs, first, count, &RepairGains::error));
  };
  const Eigen::Index nu = study.mv_count(), nd = study.md_count();
  add("repair_gain", "mv", 0, nu);
  if (nd > 0)
    add("repair_gain_md", "md", nu, nd);
  return rows;
}

/// The conditions under which the loop ran.
std::vector<Row<LoopConditions>> condition_rows() {
  using C = LoopConditions;
  const auto row = [](const char* name, const char* meaning, const char* special, double C::*member) {
    return member_row<double>({name, meaning, "1", special}, member).from_version(3);
  };
  return {row("spectral_radius", "spectral radius of the loop with the active set of the basis case",
              "below 1: stable; NaN: not known", &C::spectral_radius),
          value_row<std::int8_t, C>(
              {"stable", "the spectral radius is below 1", "1", "", with_none(no_yes(), "not_known")},
              [](const C& conditions) {
                const std::optional<bool> stable = conditions.stable();
                return static_cast<std::int8_t>(stable ? (*stable ? 1 : 0) : -1);
              })
              .only(RowUse::archive_only),
          row("other_cv_active",
              "share of the samples in which a CV that is inside its range in the basis case is at a soft "
              "limit or beyond it",
              "NaN: not known", &C::other_cv_active),
          row("mv_at_limit",
              "share of the samples in which an MV that is free in the basis case is at a hard limit",
              "NaN: not known", &C::mv_at_limit)};
}

/// What each method says about a loop.
std::vector<Row<AssessmentRecord>> verdict_rows(const Study& study) {
  using A = AssessmentRecord;
  return {
      member_row<std::int8_t>({"assessment_status", "how the assessment by a method ended", "1",
                               "see `reason` in the group of the method", enum_words<AssessmentStatus>()},
                              &A::status),
      member_row<std::int8_t>({"flagged", "the method finds a fault in the loop", "1",
                               "no unless the assessment status is ok", no_yes()},
                              &A::flagged),
      member_row<double>({"score", "how far the loop is from being flagged, larger is worse", "1",
                          "comparable between loops of one method; NaN unless the assessment status is ok"},
                         &A::score),
      member_row<std::int32_t>({"predicted_cv", "position in cv of the CV with the largest score", "1",
                                "-1: none", index_words(study.plant.cvs)},
                               &A::predicted_cv),
      member_row<std::int8_t>({"predicted_source", "source that the method names for the predicted CV", "1",
                               "none: the method names none",
                               enum_words(std::array{FaultSource::none, FaultSource::mpm, FaultSource::ud,
                                                     FaultSource::mpm_ud, FaultSource::other})},
                              &A::predicted_source),
      member_row<double>({"milliseconds", "processor time of the assessment", "ms"}, &A::milliseconds)
          .only(RowUse::bytes_only)};
}

RecordTable outcomes(const Study& study, const AssessmentForms& forms) {
  RecordTable table;
  table.dimension = "experiment";
  // A record starts with room for every method; `status` comes first, since it tells what else the record
  // has.
  table.make = [forms](Record& record) { record.assessments = unassessed(forms); };
  table.rows = {
      member_row<std::int8_t>(
          {"status", "how the experiment ended", "1",
           "infeasible: an MPC problem had no solution, the experiment is left out; failed: see "
           "message; unstable: the loop is not stable, the experiment is left out",
           enum_words<ExperimentStatus>()},
          &Record::status),
      member_row<std::string>(
          {"message", "why the experiment failed", "1",
           study.world ? "empty unless the status is failed, or unstable because of its world"
                       : "empty unless the status is failed"},
          &Record::message),
      of_ok(vector_row<Record>(
          {"ivar_basis", "Ivar_basis = var y / var y of the basis case", "1",
           "NaN unless the status is ok, and where neither varies; infinite where the basis case does not"},
          "cv", study.cv_count(), &Record::ivar_basis)),
      value_row<std::int8_t, Record>(
          {"impact", "some Ivar_basis lies outside the band of impact", "1",
           "truth about the faults, which does not depend on any method", no_yes()},
          [options = study.diagnosis](const Record& record) {
            return static_cast<std::int8_t>(has_impact(options, record));
          })
          .only(RowUse::archive_only)};
  append(of_part<Record>(condition_rows(), &Record::conditions), table.rows);
  for (const Row<AssessmentRecord>& row : verdict_rows(study))
    table.rows.push_back(of_each<Record>(row, "method", forms.size(), &Record::assessments));
  append(of_part<Record>(solver_rows(), &Record::solver), table.rows);
  if (study.world) {
    for (const Row<FaultCost>& row : fault_cost_rows(study))
      table.rows.push_back(of_ok(of_part<Record>(row, CostLens{})));
    append(of_part<Record>(repair_gain_rows(study), &Record::repair), table.rows);
  }
  return table;
}

// --- The numbers of a method ---

std::vector<std::string> dimensions_of(NumberScope scope) {
  switch (scope) {
    case NumberScope::loop:
      return {};
    case NumberScope::cv:
      return {"cv"};
    case NumberScope::channel:
      return {"cv", "mv"};
    case NumberScope::cv_lag:
      return {"cv", "lag"};
    case NumberScope::window:
      return {"window"};
  }
  return {};
}

std::vector<std::size_t> lengths_of(const NumberPlace& place) {
  const auto rows = static_cast<std::size_t>(place.rows), columns = static_cast<std::size_t>(place.columns);
  if (place.info.scope == NumberScope::window)
    return {columns};
  std::vector<std::size_t> shape{rows, columns};
  shape.resize(dimensions_of(place.info.scope).size());
  return shape;
}

/// Accesses a number of a method: a quantity as it is, a word as its position, with -1 for NaN.
template <class T>
RowAccess<AssessmentRecord, T> access_of(const NumberPlace& place) {
  const Eigen::Index first = place.first, size = place.size();
  constexpr bool kQuantity = std::is_same_v<T, double>;
  return {[=](const AssessmentRecord& assessment, T* values) {
            for (Eigen::Index i = 0; i < size; ++i) {
              const double number = assessment.numbers.size() == 0 ? kNaN : assessment.numbers(first + i);
              values[i] = kQuantity || !std::isnan(number) ? static_cast<T>(number) : T(-1);
            }
          },
          [=](AssessmentRecord& assessment, const T* values) {
            if (!assessment.answered())
              return;
            assessment.numbers.conservativeResize(assessment.form->size());
            for (Eigen::Index i = 0; i < size; ++i)
              assessment.numbers(first + i) =
                  !kQuantity && values[i] < T{} ? kNaN : static_cast<double>(values[i]);
          }};
}

Row<AssessmentRecord> number_row(const NumberPlace& place) {
  const NumberScope scope = place.info.scope;
  Row<AssessmentRecord> row{kept_text(place.info), dimensions_of(scope), lengths_of(place),
                            access_of<double>(place)};
  if (!place.info.words.empty())
    row.access = access_of<std::int8_t>(place);
  return row.along(scope == NumberScope::cv_lag   ? "lag_time"
                   : scope == NumberScope::window ? "window_end"
                                                  : "");
}

/// The numbers of one method, which is at position `method` among the assessments.
RecordTable method_table(const AssessmentForm& form, std::size_t method) {
  RecordTable table{.group = "methods/" + form.method().name,
                    .dimension = "experiment",
                    .title = form.method().title + ": what it says about each loop"};
  std::vector<Row<AssessmentRecord>> rows{member_row<std::string>(
      {"reason", "why there is no verdict", "1", "empty when there is one, or when the method was not asked"},
      &AssessmentRecord::reason)};
  for (const NumberPlace& place : form.places())
    rows.push_back(number_row(place));
  table.rows = of_part<Record>(
      rows, [method](auto& record) -> auto& { return record.assessments[method]; });
  return table;
}

// --- Kept loops, and Ivar_diag with a modified S0 ---

RecordTable kept_loops(const Study& study) {
  RecordTable table{.group = "trajectories",
                    .dimension = "stored",
                    .title = "Closed-loop records of the experiments that kept theirs",
                    .has = [](const Record& record) { return record.loop.has_value(); },
                    .make = [](Record& record) { record.loop.emplace(); }};
  const auto trajectory = path(&Record::loop, kContent, &LoopRecord::trajectory);
  append(of_part<Record>(loop_rows(), trajectory), table.rows);
  append(of_part<Record>(solver_rows(), path(trajectory, &Trajectory::solver)), table.rows);
  append(of_part<Record>(signal_rows(study), trajectory), table.rows);
  const Row<NominalOutputs> y_sim = nominal_rows(study).front();
  table.rows.push_back(
      signal_row<Record>(study, y_sim.text, "cv", path(&Record::loop, kContent, &LoopRecord::y_sim))
          .along("time"));
  return table;
}

/// Signals of kept loops that only a simulation knows.
RecordTable truth_of_loops(const Study& study) {
  const auto row = [&](const char* name, const char* meaning, Eigen::MatrixXd LoopTruth::*signal) {
    return signal_row<Record>(study, {name, meaning, "CV"}, "cv", path(&Record::truth, kContent, signal));
  };
  return {.group = "truth",
          .dimension = "stored",
          .title = "Signals of the stored loops that only a simulation knows",
          .has = [](const Record& record) { return record.truth.has_value(); },
          .make = [](Record& record) { record.truth.emplace(); },
          .rows = {row("v", "measurement noise, which is in y", &LoopTruth::v),
                   row("y_d", "sum of the unmeasured disturbances and errors of sensors on the CVs",
                       &LoopTruth::y_d)}};
}

/// For experiments with two faults: the loops that have only one of them.
RecordTable loops_alone(const Study& study) {
  RecordTable table{
      .group = "truth_alone",
      .dimension = "stored",
      .title = "The loops of experiments with two faults that have one of them alone",
      .has = [](const Record& record) { return record.truth && record.truth->mpm_alone.y.size() > 0; },
      .make =
          [](Record& record) {
            if (!record.truth)  // the archive has no group `truth`
              record.truth.emplace();
          }};
  using Alone = LoopTruth::Alone;
  const auto add = [&](const std::string& name, const std::string& fault, Alone LoopTruth::*member) {
    const auto alone = path(&Record::truth, kContent, member);
    table.rows.push_back(
        signal_row<Record>(study, {"y_" + name + "_alone", "measured CVs with the " + fault + " alone", "CV"},
                           "cv", path(alone, &Alone::y)));
    table.rows.push_back(
        signal_row<Record>(study, {"u_" + name + "_alone", "MVs with the " + fault + " alone", "MV"}, "mv",
                           path(alone, &Alone::u)));
  };
  add("mpm", "mismatch", &LoopTruth::mpm_alone);
  add("ud", "disturbance", &LoopTruth::ud_alone);
  return table;
}

RecordTable perturbed(const Study& study) {
  const auto row = [&](const char* name, const char* meaning, Eigen::VectorXd PerturbedIvar::*member) {
    return vector_row<Record>({name, meaning}, "multiplier", std::ssize(study.s0_perturbation.multipliers),
                              path(&Record::perturbed, member));
  };
  return {
      .group = "s0_perturbation",
      .dimension = "perturbed",
      .title = "Ivar_diag with S0_diag modified in time constant or damping",
      .has = [](const Record& record) { return record.perturbed.time_constant.size() > 0; },
      .rows = {row("ivar_diag_time_constant", "Ivar_diag of the affected CV, time constant of S0 multiplied",
                   &PerturbedIvar::time_constant),
               row("ivar_diag_damping", "Ivar_diag of the affected CV, damping of S0 multiplied",
                   &PerturbedIvar::damping)}};
}

// If one of these gets a new member, this does not compile: then add the member to a table above.
[[maybe_unused]] void every_member_is_in_a_table(const Record& record, const AssessmentRecord& assessment,
                                                 const LoopRecord& loop, const LoopTruth& truth,
                                                 const SolverStatistics& statistics) {
  [[maybe_unused]] const auto& [draw, status, message, conditions, ivar_basis, cost, repair, assessments,
                                perturbed, solver, kept, known] = record;
  [[maybe_unused]] const auto& [gain, gain_error] = repair;
  if (cost) {
    [[maybe_unused]] const auto& [ratio, loss, violation, loss_ratio, error, effort, economics, cost_ratio,
                                  cost_ratio_error] = *cost;
  }
  [[maybe_unused]] const auto& [radius, other_cv, mv] = conditions;
  [[maybe_unused]] const auto& [form, ended, reason, flagged, score, cv, source, numbers, milliseconds] =
      assessment;
  [[maybe_unused]] const auto& [trajectory, y_sim] = loop;
  [[maybe_unused]] const auto& [v, y_d, mpm_alone, ud_alone] = truth;
  [[maybe_unused]] const auto& [loop_status, samples_done, y, u, u_target, d, y_set, y_rows, of_loop, failure,
                                what] = trajectory;
  [[maybe_unused]] const auto& [steps, iterations, fallbacks, residual] = statistics;
}

}  // namespace

NumberText kept_text(NumberText text) {
  text.special = text.words.empty() ? "NaN without a verdict" : "-1: nothing is said";
  if (!text.words.empty())
    text.words = with_none(std::move(text.words), "no_answer");
  return text;
}

std::vector<RecordTable> record_tables(const Study& study, const AssessmentForms& forms) {
  const auto of_draw = [](const std::vector<DrawRow>& rows, bool from_draw) {
    return RecordTable{.group = "",
                       .dimension = "experiment",
                       .title = "",
                       .from_draw = from_draw,
                       .rows = of_part<Record>(rows, &Record::draw)};
  };
  std::vector<RecordTable> tables{of_draw(draw_rows(study), true)};
  if (study.asks_for_impact())
    tables.push_back(of_draw(scale_rows(study), false));
  tables.push_back(outcomes(study, forms));
  for (std::size_t m = 0; m < forms.size(); ++m)
    tables.push_back(method_table(*forms[m], m));
  tables.push_back(kept_loops(study));
  tables.push_back(truth_of_loops(study));
  tables.push_back(loops_alone(study));
  if (!study.s0_perturbation.multipliers.empty())
    tables.push_back(perturbed(study));
  return tables;
}

}  // namespace mpm
