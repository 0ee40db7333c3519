#include "results/archive/record_tables.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "analysis/experiment/judgement.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"
#include "results/archive/columns.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/world.hpp"

namespace mpm {
namespace {

using Record = ExperimentRecord;

std::size_t count_of(Eigen::Index length) {
  return static_cast<std::size_t>(length);
}

/// The variable where it has this use alone.
RecordVariable only(RecordUse use, RecordVariable variable) {
  variable.use = use;
  return variable;
}

/// One value of each record.
template <class T>
RecordVariable scalar(VariableText text, std::function<T(const Record&)> get,
                      std::function<void(Record&, T)> set) {
  RecordAccess<T> access{[get = std::move(get)](const Record& record, T* value) { *value = get(record); },
                         {}};
  if (set)
    access.set = [set = std::move(set)](Record& record, const T* value) { set(record, *value); };
  return {std::move(text), {}, {}, std::move(access)};
}

/// A variable of a part of a record from the column that describes it; `of` gives the part.
template <class Part, class Of>
RecordVariable of_column(const Column<Part>& column, Of of) {
  return std::visit(
      [&]<class T>(const Access<Part, T>& access) {
        return scalar<T>(
            column.text, [get = access.get, of](const Record& record) { return get(of(record)); },
            [set = access.set, of](Record& record, T value) { set(of(record), std::move(value)); });
      },
      column.access);
}

/// A member that is in the file as it is in memory, but for its type.
template <class T, class Member>
RecordVariable plain(VariableText text, Member Record::*member) {
  return scalar<T>(
      std::move(text), [member](const Record& record) { return static_cast<T>(record.*member); },
      [member](Record& record, T value) { record.*member = static_cast<Member>(std::move(value)); });
}

/// A vector of every record, NaN in the file where it is empty. `present` says of which records it is not.
RecordVariable vector(VariableText text, const std::string& dimension, Eigen::Index size,
                      std::function<const Eigen::VectorXd&(const Record&)> get,
                      std::function<void(Record&, Eigen::VectorXd)> set) {
  RecordAccess<double> access{[get = std::move(get), size](const Record& record, double* values) {
                                const Eigen::VectorXd& vector = get(record);
                                std::fill_n(std::copy(vector.begin(), vector.end(), values),
                                            size - vector.size(), kNaN);
                              },
                              [set = std::move(set), size](Record& record, const double* values) {
                                set(record, Eigen::Map<const Eigen::VectorXd>(values, size));
                              }};
  return {std::move(text), {dimension}, {count_of(size)}, std::move(access)};
}

/// A matrix, row by row; NaN where it is empty.
template <class Of>
RecordVariable matrix(VariableText text, std::vector<std::string> dimensions, Eigen::Index rows,
                      Eigen::Index columns, Of of) {
  RecordAccess<double> access{[of, rows, columns](const Record& record, double* values) {
                                const Eigen::MatrixXd& from = of(record);
                                if (from.size() == 0)
                                  std::fill_n(values, rows * columns, kNaN);
                                else
                                  Eigen::Map<RowMajorMatrix>(values, rows, columns) = from;
                              },
                              [of, rows, columns](Record& record, const double* values) {
                                of(record) = Eigen::Map<const RowMajorMatrix>(values, rows, columns);
                              }};
  return {std::move(text), std::move(dimensions), {count_of(rows), count_of(columns)}, std::move(access)};
}

// --- What was drawn ---

Flags with_none(Flags flags) {
  flags.values.insert(flags.values.begin(), -1);
  flags.meanings.insert(flags.meanings.begin(), "none");
  return flags;
}

/// Makes room for the faults of this kind.
void set_kind(Record& record, std::int8_t value) {
  ExperimentDraw& draw = record.draw;
  draw.kind = static_cast<ExperimentKind>(value);
  if (draw.kind == ExperimentKind::mpm || draw.kind == ExperimentKind::mpm_ud)
    draw.mismatches.emplace_back();
  if (draw.kind == ExperimentKind::ud || draw.kind == ExperimentKind::mpm_ud)
    draw.disturbances.emplace_back();
  if (draw.kind == ExperimentKind::tuning)
    draw.tuning.emplace();
}

/// With two random faults both are on the same CV. A fault of another kind affects those that it is said to.
void set_true_cv(Record& record, std::int32_t value) {
  if (record.draw.kind == ExperimentKind::other && value >= 0)
    record.draw.affected_cvs = std::vector<Eigen::Index>{value};
  for (Mismatch& mismatch : record.draw.mismatches)
    mismatch.cv = value;
  for (Disturbance& disturbance : record.draw.disturbances)
    disturbance.cv = value;
}

/// A member of the fault of a random experiment, `none` without one. The faults of a named scenario are in
/// the study, and in no variable.
template <class T, class Fault, class Member>
RecordVariable of_fault(VariableText text, std::vector<Fault> ExperimentDraw::*faults, Member Fault::*member,
                        T none) {
  return scalar<T>(
      std::move(text),
      [=](const Record& record) {
        const std::vector<Fault>& list = record.draw.*faults;
        return record.draw.named || list.empty() ? none : static_cast<T>(list.front().*member);
      },
      [=](Record& record, T value) {
        for (Fault& fault : record.draw.*faults)
          fault.*member = static_cast<Member>(value);
      });
}

/// A member of the change of the tuning, `none` without one.
template <class T, class Member>
RecordVariable of_tuning(VariableText text, Member TuningChange::*member, T none) {
  return scalar<T>(
      std::move(text),
      [=](const Record& record) {
        return record.draw.tuning ? static_cast<T>((*record.draw.tuning).*member) : none;
      },
      [=](Record& record, T value) {
        if (record.draw.tuning)
          (*record.draw.tuning).*member = static_cast<Member>(value);
      });
}

VariableText kind_text(const Study& study) {
  VariableText text{"kind", "what is wrong in the experiment", "1",
                    "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both",
                    enum_flags(std::array{ExperimentKind::healthy, ExperimentKind::mpm, ExperimentKind::ud,
                                          ExperimentKind::mpm_ud, ExperimentKind::tuning})};
  if (study.experiments.other > 0) {
    text.flags =
        enum_flags(std::array{ExperimentKind::healthy, ExperimentKind::mpm, ExperimentKind::ud,
                              ExperimentKind::mpm_ud, ExperimentKind::tuning, ExperimentKind::other});
    text.comment += "; other: neither, see other_fault";
  }
  if (study.experiments.tuning > 0)
    text.comment += "; tuning: a weight of the controller";
  return text;
}

Flags parameter_flags(const Study& study) {
  if (study.has_plain_faults())
    return enum_flags(
        std::array{MismatchParameter::gain, MismatchParameter::time_constant, MismatchParameter::dead_time});
  return enum_flags(kRandomMismatchParameters);
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

/// What follows from study and index alone, beyond one parameter of one channel and noise on one CV.
std::vector<RecordVariable> further_draws(const Study& study) {
  const auto follows = []<class T>(VariableText text, std::function<T(const ExperimentDraw&)> get) {
    return only(
        RecordUse::archive_only,
        scalar<T>(std::move(text), [get = std::move(get)](const Record& r) { return get(r.draw); }, {}));
  };
  const auto whole = [&](VariableText text, std::function<std::int32_t(const ExperimentDraw&)> get) {
    return follows(std::move(text), std::move(get));
  };
  const auto flag = [&](VariableText text, std::function<std::int8_t(const ExperimentDraw&)> get) {
    return follows(std::move(text), std::move(get));
  };
  const auto quantity = [&](VariableText text, std::function<double(const ExperimentDraw&)> get) {
    return follows(std::move(text), std::move(get));
  };
  std::vector<RecordVariable> variables{
      whole({"mismatches", "parameters of channels or of the plant that differ from the model", "1"},
            [](const ExperimentDraw& draw) {
              return static_cast<std::int32_t>(draw.mismatches.size() + draw.parameters.size());
            }),
      whole({"disturbances", "places where an unmeasured disturbance acts", "1"},
            [](const ExperimentDraw& draw) { return static_cast<std::int32_t>(draw.disturbances.size()); }),
      flag({"ud_signal", "shape of the signal of the unmeasured disturbance", "1", "-1: no disturbance",
            with_none(enum_flags(kDisturbanceShapes))},
           [](const ExperimentDraw& draw) {
             return draw.disturbances.empty()
                        ? std::int8_t{-1}
                        : static_cast<std::int8_t>(shape_of(draw.disturbances.front().signal));
           }),
      whole({"ud_mv", "position in mv of the MV on which the unmeasured disturbance acts", "1", "-1: on none",
             index_flags(study.plant.mvs)},
            [](const ExperimentDraw& draw) {
              return static_cast<std::int32_t>(
                  draw.disturbances.empty() ? -1 : draw.disturbances.front().mv.value_or(-1));
            }),
      whole({"onset", "sample at which the faults begin", "1"},
            [](const ExperimentDraw& draw) { return static_cast<std::int32_t>(draw.onset.sample); }),
      whole({"onset_growth", "samples over which the faults grow", "1"},
            [](const ExperimentDraw& draw) { return static_cast<std::int32_t>(draw.onset.growth); })};
  if (study.experiments.other == 0)
    return variables;
  variables.push_back(flag({"other_fault", "what is wrong besides model and disturbance", "1", "-1: nothing",
                            with_none(enum_flags(kOtherFaultKinds))},
                           [](const ExperimentDraw& draw) {
                             return draw.other ? static_cast<std::int8_t>(draw.other->kind) : std::int8_t{-1};
                           }));
  variables.push_back(
      whole({"other_variable", "position of the CV, MV or MD at fault, in cv, mv or md", "1", "-1: none"},
            [](const ExperimentDraw& draw) {
              return static_cast<std::int32_t>(draw.other ? draw.other->variable : -1);
            }));
  variables.push_back(
      quantity({"other_size", "size of the other fault", "1",
                "in the unit of its variable, a factor for the gain of an MD; NaN: none"},
               [](const ExperimentDraw& draw) { return draw.other ? draw.other->size : kNaN; }));
  return variables;
}

RecordTable drawn(const Study& study) {
  const std::string time = unit_text(study.plant.time_unit);
  using M = ExperimentDraw;
  RecordTable table;
  table.dimension = "experiment";
  table.from_draw = true;
  table.variables = {
      scalar<std::int8_t>(
          kind_text(study), [](const Record& r) { return static_cast<std::int8_t>(r.draw.kind); }, set_kind),
      scalar<std::int32_t>(
          {"true_cv", "position of the affected CV in cv", "1", "-1: none, or more than one",
           index_flags(study.plant.cvs)},
          [](const Record& r) { return static_cast<std::int32_t>(r.draw.true_cv()); }, set_true_cv),
      of_fault<std::int32_t>({"true_mv", "position of the MV of the mismatched channel in mv", "1",
                              "-1: no mismatch, or a named scenario", index_flags(study.plant.mvs)},
                             &M::mismatches, &Mismatch::input, -1),
      of_fault<std::int8_t>({"parameter", "parameter of the channel that differs from the model", "1",
                             "-1: no mismatch, or a named scenario", with_none(parameter_flags(study))},
                            &M::mismatches, &Mismatch::parameter, -1),
      of_fault<double>({"parameter_value", "size of the mismatch", "1",
                        "factor of gain or time constant; shift of the dead time in " + time +
                            "; NaN: no mismatch, or a named scenario"},
                       &M::mismatches, &Mismatch::value, kNaN),
      of_fault<double>({"ud_gain", "gain of the unmeasured disturbance model", common_unit(study.plant.cvs),
                        "in the unit of the affected CV; NaN: no disturbance, or a named scenario"},
                       &M::disturbances, &Disturbance::gain, kNaN),
      of_fault<double>({"ud_time_constant", "time constant of the unmeasured disturbance model", time,
                        "NaN: no disturbance, or a named scenario"},
                       &M::disturbances, &Disturbance::time_constant, kNaN),
  };
  if (!study.has_plain_faults())
    for (RecordVariable& variable : further_draws(study))
      table.variables.push_back(std::move(variable));
  if (study.simulation.noise.factor != Distribution::constant(1))
    table.variables.push_back(scalar<double>(
        {"noise_factor", "factor of the standard deviations of the measurement noise", "1",
         "against those of the study, which the basis case has"},
        [](const Record& r) { return r.draw.noise_factor; },
        [](Record& r, double value) { r.draw.noise_factor = value; }));
  if (study.world)
    table.variables.push_back(scalar<std::int32_t>(
        {"world", "world in which the experiment takes place", "1", "from 0"},
        [](const Record& r) { return static_cast<std::int32_t>(r.draw.world); },
        [study](Record& r, std::int32_t) { r.draw.world = world_of(study, r.draw.index); }));
  if (study.record.candidates > 0)
    table.variables.push_back(scalar<std::int32_t>(
        {"true_candidate", "position of the logged candidate that drives the disturbance", "1",
         "-1: none of them does"},
        [study](const Record& r) { return static_cast<std::int32_t>(true_candidate(study, r.draw)); },
        [](Record&, std::int32_t) {}));  // it follows from the draw
  if (study.experiments.tuning == 0)
    return table;
  table.variables.push_back(of_tuning<std::int8_t>(
      {"tuning_parameter", "weight of the controller that is changed", "1",
       "move_suppression, target_weight: of an MV; slack_weight, setpoint_weight: of a CV",
       with_none(enum_flags(kTuningParameters))},
      &TuningChange::parameter, -1));
  table.variables.push_back(of_tuning<std::int32_t>(
      {"tuning_index", "position of the MV in mv, or of the CV in cv, whose weight is changed", "1",
       "-1: none"},
      &TuningChange::index, -1));
  table.variables.push_back(of_tuning<double>({"tuning_factor", "factor of the weight", "1", "NaN: none"},
                                              &TuningChange::factor, kNaN));
  return table;
}

/// A scale of the faults; with it the draw is made anew.
RecordVariable of_scale(const Study& study, VariableText text, double FaultScales::*scale) {
  return scalar<double>(
      std::move(text), [scale](const Record& record) { return record.draw.scales.*scale; },
      [study, scale](Record& record, double value) {
        FaultScales scales = record.draw.scales;
        scales.*scale = value;
        record.draw = with_scales(study, draw_experiment(study, record.draw.index), scales);
      });
}

/// The sizes that pilot loops have found, which bytes have to keep.
RecordTable fault_scales(const Study& study) {
  RecordTable table;
  table.dimension = "experiment";
  const char* const meaning = "by which the drawn sizes are scaled for the effect that the study asks for";
  table.variables = {
      of_scale(study, {"mismatch_scale", meaning, "1", "exponent of factors, factor of times"},
               &FaultScales::mismatch),
      of_scale(study, {"disturbance_scale", meaning, "1", "factor of the gain"}, &FaultScales::disturbance),
      of_scale(study, {"other_scale", meaning, "1", "factor of the size; exponent of the factor of an MD"},
               &FaultScales::other)};
  return table;
}

// --- How it ended, the truth, and the verdicts ---

/// One value a method of each record; `member` of AssessmentRecord.
template <class T, class Member>
RecordVariable of_methods(VariableText text, const AssessmentForms& forms, Member AssessmentRecord::*member) {
  const std::size_t methods = forms.size();
  RecordAccess<T> access{[=](const Record& record, T* values) {
                           for (std::size_t m = 0; m < methods; ++m)
                             values[m] = static_cast<T>(record.assessments[m].*member);
                         },
                         [=](Record& record, const T* values) {
                           for (std::size_t m = 0; m < methods; ++m)
                             record.assessments[m].*member = static_cast<Member>(values[m]);
                         }};
  return {std::move(text), {"method"}, {methods}, std::move(access)};
}

Flags source_flags() {
  return enum_flags(std::array{FaultSource::none, FaultSource::mpm, FaultSource::ud, FaultSource::mpm_ud,
                               FaultSource::other});
}

Flags stable_flags() {
  return {{-1, 0, 1}, {"not_known", "no", "yes"}};
}

/// What archives of an earlier minor version lack.
RecordVariable lately(RecordVariable variable) {
  variable.may_lack = true;
  return variable;
}

/// A number of the conditions under which the loop worked.
RecordVariable of_conditions(VariableText text, double LoopConditions::*member) {
  return lately(scalar<double>(
      std::move(text), [member](const Record& r) { return r.conditions.*member; },
      [member](Record& r, double value) { r.conditions.*member = value; }));
}

/// The cost of the faults of a record with status ok, made where it is read.
FaultCost& cost_of(Record& record) {
  if (!record.cost)
    record.cost.emplace();
  record.cost->variance_ratio = record.ivar_basis;
  return *record.cost;
}

/// What faults cost in the worlds of a study (FaultCost), but for the ratios of the variances: ivar_basis.
std::vector<RecordVariable> fault_costs(const Study& study) {
  const auto of_cv = [&](VariableText text, Eigen::VectorXd FaultCost::*member) {
    return vector(
        std::move(text), "cv", study.cv_count(),
        [member](const Record& r) -> const Eigen::VectorXd& {
          static const Eigen::VectorXd none;
          return r.cost ? (*r.cost).*member : none;
        },
        [member](Record& r, Eigen::VectorXd values) {
          if (r.status == ExperimentStatus::ok)
            cost_of(r).*member = std::move(values);
        });
  };
  const auto of_loop = [](VariableText text, double FaultCost::*member) {
    return scalar<double>(
        std::move(text), [member](const Record& r) { return r.cost ? (*r.cost).*member : kNaN; },
        [member](Record& r, double value) {
          if (r.status == ExperimentStatus::ok)
            cost_of(r).*member = value;
        });
  };
  const char* const same =
      "against the same loop without the fault, mean over noise; NaN unless the status is ok";
  return {
      of_cv({"loss", "what the fault adds to the cost of the CV in the weights of the controller", "1", same},
            &FaultCost::loss),
      of_cv({"violation", "what the fault adds to the mean distance outside the soft limits",
             common_unit(study.plant.cvs), same},
            &FaultCost::violation),
      of_loop({"loss_ratio", "cost of the loop with the fault over that without it", "1", same},
              &FaultCost::loss_ratio),
      of_loop({"loss_ratio_error", "standard error of loss_ratio", "1", "NaN: of one pair of loops"},
              &FaultCost::error),
      of_loop({"effort", "what the fault adds to the cost of the moves", "1", same}, &FaultCost::effort),
      of_loop({"economics", "what the fault adds to the objective of the target optimizer", "1", same},
              &FaultCost::economics)};
}

/// The channels of some inputs in a matrix of RepairGains, `count` of them from column `first` on.
RecordVariable repair_gain_variable(const Study& study, VariableText text, const char* inputs,
                                    Eigen::Index first, Eigen::Index count,
                                    Eigen::MatrixXd RepairGains::*member) {
  const Eigen::Index rows = study.cv_count(), all = study.mv_count() + study.md_count();
  RecordAccess<double> access{[=](const Record& record, double* values) {
                                Eigen::Map<RowMajorMatrix> to(values, rows, count);
                                if (const Eigen::MatrixXd& from = record.repair.*member; from.size() == 0)
                                  to.setConstant(kNaN);
                                else
                                  to = from.middleCols(first, count);
                              },
                              [=](Record& record, const double* values) {
                                Eigen::MatrixXd& to = record.repair.*member;
                                if (to.size() == 0)
                                  to.setConstant(rows, all, kNaN);
                                to.middleCols(first, count) =
                                    Eigen::Map<const RowMajorMatrix>(values, rows, count);
                              }};
  return lately({std::move(text), {"cv", inputs}, {count_of(rows), count_of(count)}, std::move(access)});
}

/// What repairs of the model would bring in the worlds of a study (RepairGains), since version 2.5.
std::vector<RecordVariable> repair_gain_variables(const Study& study) {
  const Eigen::Index nu = study.mv_count(), nd = study.md_count();
  const VariableText gain{
      "repair_gain",
      "what the loop costs less once the controller's model has the true channel, over what it costs "
      "without the fault",
      "1", "0: plant and model agree; NaN: not computed, or the repaired loop does not run to its end"};
  const VariableText error{"repair_gain_error", "standard error of repair_gain", "1",
                           "NaN: of one loop, or as repair_gain"};
  std::vector<RecordVariable> variables{repair_gain_variable(study, gain, "mv", 0, nu, &RepairGains::gain),
                                        repair_gain_variable(study, error, "mv", 0, nu, &RepairGains::error)};
  if (nd > 0) {
    VariableText of_mds = gain, error_of_mds = error;
    of_mds.name = "repair_gain_md";
    error_of_mds.name = "repair_gain_md_error";
    error_of_mds.long_name = "standard error of repair_gain_md";
    variables.push_back(repair_gain_variable(study, of_mds, "md", nu, nd, &RepairGains::gain));
    variables.push_back(repair_gain_variable(study, error_of_mds, "md", nu, nd, &RepairGains::error));
  }
  return variables;
}

RecordTable outcomes(const Study& study, const AssessmentForms& forms) {
  RecordTable table;
  table.dimension = "experiment";
  // A record comes with room for every method; `status` comes first, since it says what else there is.
  table.make = [forms](Record& record) { record.assessments = unassessed(forms); };
  table.variables = {
      plain<std::int8_t>(
          {"status", "how the experiment ended", "1",
           "infeasible: an MPC problem had no solution, the experiment is left out; failed: see "
           "message; unstable: the loop is not stable, the experiment is left out",
           enum_flags(std::array{ExperimentStatus::ok, ExperimentStatus::infeasible, ExperimentStatus::failed,
                                 ExperimentStatus::unstable})},
          &Record::status),
      plain<std::string>({"message", "why the experiment failed", "1",
                          study.world ? "empty unless the status is failed, or unstable because of its world"
                                      : "empty unless the status is failed"},
                         &Record::message),
      vector(
          {"ivar_basis", "Ivar_basis = var y / var y of the basis case", "1",
           "NaN unless the status is ok, and where neither varies; infinite where the basis case does not"},
          "cv", study.cv_count(), [](const Record& r) -> const Eigen::VectorXd& { return r.ivar_basis; },
          [](Record& r, Eigen::VectorXd values) {
            if (r.status == ExperimentStatus::ok)
              r.ivar_basis = std::move(values);
          }),
      only(RecordUse::archive_only,
           scalar<std::int8_t>({"impact", "some Ivar_basis lies outside the band of impact", "1",
                                "the truth about what is wrong; no method has a part in it", yes_no_flags()},
                               [options = study.diagnosis](const Record& r) {
                                 return static_cast<std::int8_t>(has_impact(options, r));
                               },
                               {})),
      of_conditions({"spectral_radius", "spectral radius of the loop with the active set of the basis case",
                     "1", "below 1: stable; NaN: not known"},
                    &LoopConditions::spectral_radius),
      only(RecordUse::archive_only,
           scalar<std::int8_t>({"stable", "the spectral radius is below 1", "1", "", stable_flags()},
                               [](const Record& r) {
                                 const std::optional<bool> stable = r.conditions.stable();
                                 return static_cast<std::int8_t>(stable ? (*stable ? 1 : 0) : -1);
                               },
                               {})),
      of_conditions({"other_cv_active",
                     "share of the samples in which a CV that the basis case has inside its range is at a "
                     "soft limit or over it",
                     "1", "NaN: not known"},
                    &LoopConditions::other_cv_active),
      of_conditions({"mv_at_limit",
                     "share of the samples in which an MV that the basis case has free is at a hard limit",
                     "1", "NaN: not known"},
                    &LoopConditions::mv_at_limit),
      of_methods<std::int8_t>(
          {"assessment_status", "how the assessment by a method ended", "1",
           "see reason of the method's group",
           enum_flags(std::array{AssessmentStatus::ok, AssessmentStatus::not_applicable,
                                 AssessmentStatus::failed, AssessmentStatus::not_assessed})},
          forms, &AssessmentRecord::status),
      of_methods<std::int8_t>({"flagged", "the method says that something is wrong with the loop", "1",
                               "no unless the assessment status is ok", yes_no_flags()},
                              forms, &AssessmentRecord::flagged),
      of_methods<double>({"score", "how far the loop is from being flagged, larger is worse", "1",
                          "comparable between loops of one method; NaN unless the assessment status is ok"},
                         forms, &AssessmentRecord::score),
      of_methods<std::int32_t>({"predicted_cv", "position in cv of the CV with the largest score", "1",
                                "-1: none", index_flags(study.plant.cvs)},
                               forms, &AssessmentRecord::predicted_cv),
      of_methods<std::int8_t>({"predicted_source", "source that the method sees in the predicted CV", "1",
                               "none: the method tells none", source_flags()},
                              forms, &AssessmentRecord::predicted_source),
      only(RecordUse::bytes_only,
           of_methods<double>({"milliseconds", "processor time of the assessment", "ms"}, forms,
                              &AssessmentRecord::milliseconds)),
  };
  for (const Column<SolverStatistics>& column : solver_columns())
    table.variables.push_back(of_column(
        column, [](auto& record) -> auto& { return record.solver; }));
  if (study.world)
    for (auto* const variables : {&fault_costs, &repair_gain_variables})
      for (RecordVariable& variable : variables(study))
        table.variables.push_back(std::move(variable));
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

std::vector<std::size_t> shape_of(const NumberPlace& place) {
  if (place.info.scope == NumberScope::window)
    return {count_of(place.columns)};
  std::vector<std::size_t> shape{count_of(place.rows), count_of(place.columns)};
  shape.resize(dimensions_of(place.info.scope).size());
  return shape;
}

VariableText text_of(const NumberPlace& place) {
  VariableText text{place.info.name, place.info.meaning, place.info.unit, "NaN without a verdict"};
  if (place.info.scope == NumberScope::cv_lag)
    text.coordinates = "lag_time";
  if (place.info.scope == NumberScope::window)
    text.coordinates = "window_end";
  if (place.info.words.empty())
    return text;
  text.comment = "-1: nothing is said";
  text.flags = {{-1}, {"no_answer"}};
  for (std::size_t word = 0; word < place.info.words.size(); ++word) {
    text.flags.values.push_back(static_cast<int>(word));
    text.flags.meanings.push_back(flag_word(place.info.words[word]));
  }
  return text;
}

/// A quantity: as it is. Words: their position, -1 for NaN.
RecordVariable of_number(const NumberPlace& place, std::size_t method) {
  const Eigen::Index first = place.first, size = place.size();
  const auto get = [=]<class T>(const Record& record, T* values, T none) {
    const Eigen::VectorXd& numbers = record.assessments[method].numbers;
    for (Eigen::Index i = 0; i < size; ++i) {
      const double number = numbers.size() == 0 ? kNaN : numbers(first + i);
      values[i] = std::is_same_v<T, double> || number == number ? static_cast<T>(number) : none;
    }
  };
  const auto set = [=]<class T>(Record& record, const T* values) {
    AssessmentRecord& assessment = record.assessments[method];
    if (!assessment.answered())
      return;
    assessment.numbers.conservativeResize(assessment.form->size());
    for (Eigen::Index i = 0; i < size; ++i)
      assessment.numbers(first + i) =
          !std::is_same_v<T, double> && values[i] < T{} ? kNaN : static_cast<double>(values[i]);
  };
  RecordVariable variable{text_of(place), dimensions_of(place.info.scope), shape_of(place),
                          RecordAccess<double>{}};
  if (place.info.words.empty())
    variable.access =
        RecordAccess<double>{[get](const Record& record, double* values) { get(record, values, kNaN); }, set};
  else
    variable.access = RecordAccess<std::int8_t>{
        [get](const Record& record, std::int8_t* values) { get(record, values, std::int8_t{-1}); }, set};
  return variable;
}

// --- Kept loops, and Ivar_diag with a modified S0 ---

RecordTable kept_loops(const Study& study) {
  RecordTable table{.group = "trajectories",
                    .dimension = "stored",
                    .title = "Closed-loop records of the experiments that kept theirs",
                    .has = [](const Record& record) { return record.loop.has_value(); },
                    .make = [](Record& record) { record.loop.emplace(); }};
  const auto trajectory = [](auto& record) -> auto& {
    return record.loop->trajectory;
  };
  for (const Column<Trajectory>& column : loop_columns())
    table.variables.push_back(of_column(column, trajectory));
  for (const Column<SolverStatistics>& column : solver_columns())
    table.variables.push_back(of_column(
        column, [](auto& record) -> auto& { return record.loop->trajectory.solver; }));
  const Eigen::Index samples = study.simulation.samples;
  for (const SignalColumn& column : signal_columns(study))
    table.variables.push_back(matrix(
        column.text, {column.rows, "sample"}, row_count(column, study),
        samples, [member = column.member](auto& record) -> auto& {
          return record.loop->trajectory.*member;
        }));
  table.variables.push_back(matrix(
      y_sim_text(study), {"cv", "sample"}, study.cv_count(), samples,
      [](auto& record) -> auto& { return record.loop->y_sim; }));
  return table;
}

/// What only a simulation knows of kept loops.
RecordTable truth_of_loops(const Study& study) {
  RecordTable table{.group = "truth",
                    .dimension = "stored",
                    .title = "What only a simulation knows of the loops that were kept",
                    .has = [](const Record& record) { return record.truth.has_value(); },
                    .make = [](Record& record) { record.truth.emplace(); }};
  const Eigen::Index samples = study.simulation.samples;
  table.variables.push_back(matrix(
      {"v", "measurement noise, which is in y", "CV"}, {"cv", "sample"}, study.cv_count(), samples,
      [](auto& record) -> auto& { return record.truth->v; }));
  table.variables.push_back(matrix(
      {"y_d", "what unmeasured disturbances and errors of sensors add to the CVs", "CV"}, {"cv", "sample"},
      study.cv_count(), samples, [](auto& record) -> auto& { return record.truth->y_d; }));
  return table;
}

/// The loops with one of two faults alone.
RecordTable loops_alone(const Study& study) {
  RecordTable table{
      .group = "truth_alone",
      .dimension = "stored",
      .title = "The loops of experiments with two faults that have one of them alone",
      .has = [](const Record& record) { return record.truth && record.truth->mpm_alone.y.size() > 0; },
      .make =
          [](Record& record) {
            if (!record.truth)  // in an archive without the group of the others
              record.truth.emplace();
          }};
  const Eigen::Index samples = study.simulation.samples;
  const auto add = [&](const char* name, const char* meaning, LoopTruth::Alone LoopTruth::*fault,
                       Eigen::MatrixXd LoopTruth::Alone::*signal) {
    const bool of_cvs = signal == &LoopTruth::Alone::y;
    table.variables.push_back(matrix(
        {name, meaning, of_cvs ? "CV" : "MV"}, {of_cvs ? "cv" : "mv", "sample"},
        of_cvs ? study.cv_count() : study.mv_count(), samples,
        [ fault, signal ](auto& record) -> auto& { return (*record.truth).*fault.*signal; }));
  };
  add("y_mpm_alone", "measured CVs with the mismatch alone", &LoopTruth::mpm_alone, &LoopTruth::Alone::y);
  add("u_mpm_alone", "MVs with the mismatch alone", &LoopTruth::mpm_alone, &LoopTruth::Alone::u);
  add("y_ud_alone", "measured CVs with the disturbance alone", &LoopTruth::ud_alone, &LoopTruth::Alone::y);
  add("u_ud_alone", "MVs with the disturbance alone", &LoopTruth::ud_alone, &LoopTruth::Alone::u);
  return table;
}

RecordTable perturbed(const Study& study) {
  RecordTable table{.group = "s0_perturbation",
                    .dimension = "perturbed",
                    .title = "Ivar_diag with S0_diag modified in time constant or damping",
                    .has = [](const Record& record) { return record.perturbed.time_constant.size() > 0; }};
  const auto of = [&](const char* name, const char* meaning, Eigen::VectorXd PerturbedIvar::*member) {
    table.variables.push_back(vector(
        {name, meaning}, "multiplier", static_cast<Eigen::Index>(study.s0_perturbation.multipliers.size()),
        [member](const Record& record) -> const Eigen::VectorXd& { return record.perturbed.*member; },
        [member](Record& record, Eigen::VectorXd values) { record.perturbed.*member = std::move(values); }));
  };
  of("ivar_diag_time_constant", "Ivar_diag of the affected CV, time constant of S0 multiplied",
     &PerturbedIvar::time_constant);
  of("ivar_diag_damping", "Ivar_diag of the affected CV, damping of S0 multiplied", &PerturbedIvar::damping);
  return table;
}

// A member more in one of these and this does not compile: it is then to be added to a table above. Not in
// one is `uncertified`: what the execution goes by that has just made the record.
[[maybe_unused]] void every_member_is_in_a_table(const Record& record, const AssessmentRecord& assessment,
                                                 const LoopRecord& loop, const LoopTruth& truth,
                                                 const SolverStatistics& statistics) {
  [[maybe_unused]] const auto& [draw, status, message, conditions, ivar_basis, cost, repair, assessments,
                                perturbed, solver, kept, known] = record;
  [[maybe_unused]] const auto& [gain, gain_error] = repair;
  if (cost) {
    [[maybe_unused]] const auto& [ratio, loss, violation, loss_ratio, error, effort, economics] = *cost;
  }
  [[maybe_unused]] const auto& [radius, other_cv, mv] = conditions;
  [[maybe_unused]] const auto& [form, ended, reason, flagged, score, cv, source, numbers, milliseconds] =
      assessment;
  [[maybe_unused]] const auto& [trajectory, y_sim] = loop;
  [[maybe_unused]] const auto& [v, y_d, mpm_alone, ud_alone] = truth;
  [[maybe_unused]] const auto& [loop_status, samples_done, y, u, u_target, d, y_set, of_loop, failure, what] =
      trajectory;
  [[maybe_unused]] const auto& [steps, iterations, fallbacks, uncertified, residual] = statistics;
}

}  // namespace

std::size_t RecordVariable::size() const {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

RecordTable method_table(const AssessmentForm& form, std::size_t method) {
  RecordTable table{.group = "methods/" + form.method().name,
                    .dimension = "experiment",
                    .title = form.method().title + ": what it says of each loop"};
  table.variables.push_back(scalar<std::string>(
      {"reason", "why there is no verdict", "1", "empty when there is one, or when the method was not asked"},
      [method](const Record& r) { return r.assessments[method].reason; },
      [method](Record& r, std::string text) { r.assessments[method].reason = std::move(text); }));
  for (const NumberPlace& place : form.places())
    table.variables.push_back(of_number(place, method));
  return table;
}

std::vector<RecordTable> record_tables(const Study& study, const AssessmentForms& forms) {
  std::vector<RecordTable> tables{drawn(study)};
  if (study.asks_for_impact())
    tables.push_back(fault_scales(study));
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
