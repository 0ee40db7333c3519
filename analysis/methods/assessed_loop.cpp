#include "analysis/methods/assessed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "analysis/sensitivity/control_structure.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/washout.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/analyser.hpp"
#include "plants/linear/settling_time.hpp"
#include "scenarios/loop/excitation.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

constexpr double kAtRest = 0.5;  // of a standard deviation

/// Does each row begin near `rest`, compared with its own standard deviation?
bool begins_at(const Eigen::VectorXd& rest, const Eigen::MatrixXd& signals) {
  const Eigen::VectorXd deviation = ((signals.colwise() - signals.rowwise().mean()).rowwise().squaredNorm() /
                                     static_cast<double>(signals.cols()))
                                        .cwiseSqrt();
  return ((signals.col(0) - rest).cwiseAbs().array() <= kAtRest * deviation.array()).all();
}

/// `recorded`, with the values of `otherwise` where it is NaN.
Eigen::MatrixXd where_recorded(const Eigen::MatrixXd& recorded, const Eigen::MatrixXd& otherwise) {
  return recorded.array().isNaN().select(otherwise, recorded);
}

/// e^(-Ts / T_w).
double washout_pole(const Study& study) {
  return std::exp(-study.controller.sample_time / study.washout());
}

/// The mean of the first samples, over a part of the time constant of the washout, so that less of
/// their noise shows as a decay.
double washout_start(const Eigen::RowVectorXd& e, double washout_samples) {
  constexpr double kPart = 0.25;
  const auto count = std::min(e.size(), static_cast<Eigen::Index>(std::ceil(kPart * washout_samples)));
  return e.head(count).mean();
}

/// Puts CVs that integrate behind their washout: `y_sim` is G0 (u, d), `seen` is the same for
/// assessed_model().
void wash_out(const Study& study, const Eigen::MatrixXd& y_sim, const Eigen::MatrixXd& seen,
              AssessedLoop& loop) {
  const double a = washout_pole(study);
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    if (!study.plant.G.is_integrating(cv))
      continue;
    const Eigen::RowVectorXd e = loop.y.row(cv) - y_sim.row(cv);
    const double start = washout_start(gaps_closed(e), study.washout() / study.controller.sample_time);
    loop.y.row(cv) = seen.row(cv) + washed_out(e, a, start);
    loop.y_sim.row(cv) = seen.row(cv);
    if (loop.has_setpoint(cv))
      loop.y_set.row(cv) = washed_out(loop.y_set.row(cv), a, loop.y_set(cv, 0));
    else
      loop.y_set.row(cv).setConstant(kNaN);
  }
}

/// The signal, preceded by `samples` samples at its first value.
Eigen::MatrixXd after_rest(const Eigen::MatrixXd& signal, Eigen::Index samples) {
  Eigen::MatrixXd longer(signal.rows(), samples + signal.cols());
  longer << signal.col(0).replicate(1, samples), signal;
  return longer;
}

/// What tells when an analyser takes its samples: the study, or the changes in the record of a plant.
enum class FirstAnalysis { of_study, of_record };

/// Replaces the rows of CVs that have an analyser by their analyses, at the samples at which they were taken.
void take_analyses(const Study& study, FirstAnalysis first, Eigen::MatrixXd& y) {
  const std::vector<AnalyserTiming>& timings = study.controller.analysers;
  for (std::size_t i = 0; i < timings.size(); ++i) {
    if (!timings[i].is_analyser())
      continue;
    auto shown = y.row(static_cast<Eigen::Index>(i));
    shown = analyses(first == FirstAnalysis::of_study ? timings[i] : with_first_of(timings[i], shown), shown);
  }
}

/// Replaces `y` and `y_sim` by what an analyser shows that reports its result `delay` samples after taking
/// its sample. Before the first analysis of a record it shows that first one. If the next analysis is
/// missing, so are the samples until the one after it, unless the record ends before that analysis could be
/// shown.
void hold(const AnalyserTiming& timing, Eigen::Index delay,
          Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> y,
          Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> y_sim) {
  const Eigen::RowVectorXd taken = y, simulated = y_sim;
  const Eigen::Index unfinished = y.size() - (timing.delay - delay);
  Eigen::Index last = 0;
  while (last + 1 < std::min<Eigen::Index>(timing.period, y.size()) && std::isnan(taken(last)))
    ++last;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    if (k >= delay && !std::isnan(taken(k - delay)))
      last = k - delay;
    const bool is_known = k - delay - last < timing.period || k >= unfinished;
    y(k) = is_known ? taken(last) : kNaN;
    y_sim(k) = simulated(last);
  }
}

}  // namespace

Eigen::Index slowest_settling(const Study& study) {
  double slowest = 0.0;
  for (Eigen::Index cv = 0; cv < study.plant.G.rows(); ++cv)
    for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input)
      slowest = std::max(slowest, settling_time(study.assessed_channel(cv, input)));
  constexpr double kLongest = 1e9;  // samples: more than any record has
  return static_cast<Eigen::Index>(std::min(std::ceil(slowest / study.controller.sample_time), kLongest));
}

Eigen::MatrixXd behind_washout(const Study& study, Eigen::MatrixXd signals) {
  for (Eigen::Index cv = 0; cv < signals.rows(); ++cv)
    if (study.plant.G.is_integrating(cv)) {
      const Eigen::RowVectorXd y = signals.row(cv);
      signals.row(cv) = washed_out(y, washout_pole(study), gaps_closed(y)(0));
    }
  return signals;
}

Eigen::MatrixXd from_washout(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  Eigen::MatrixXd closed = gaps_closed(signals);
  for (Eigen::Index cv = 0; cv < closed.rows(); ++cv)
    if (study.plant.G.is_integrating(cv))
      closed.row(cv) = washout_undone(closed.row(cv), washout_pole(study));
  return closed;
}

bool AssessedLoop::has_setpoint(Eigen::Index cv) const {
  return y_set.cols() > 0 && !std::isnan(y_set(cv, 0));
}

std::vector<Eigen::Index> AssessedLoop::setpoint_cvs() const {
  std::vector<Eigen::Index> cvs;
  for (Eigen::Index cv = 0; cv < y_set.rows(); ++cv)
    if (has_setpoint(cv))
      cvs.push_back(cv);
  return cvs;
}

AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const Trajectory& loop) {
  const Eigen::MatrixXd d = as_taken(study.controller.md_analysers, loop.d);
  const auto simulated = [&](const TransferMatrix& model) {
    return simulated_output(model, study.controller.sample_time, point.u, loop.u, d);
  };
  const Eigen::MatrixXd y_sim = simulated(study.plant.G);
  AssessedLoop assessed{
      .y = loop.y, .u = loop.u, .u_target = loop.u_target, .d = d, .y_sim = y_sim, .y_set = {}};
  take_analyses(study, FirstAnalysis::of_study, assessed.y);
  assessed.y_set =
      study.assessment.setpoints == AssessmentSetpoints::optimizer && study.controller.has_targets()
          ? optimizer_steady_state(study, loop, y_sim)
          : Eigen::MatrixXd::Constant(loop.y.rows(), loop.y.cols(), kNaN);
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    if (study.controller.has_setpoint(cv))
      assessed.y_set.row(cv) = loop.y_set.row(cv);
  if (study.plant.G.is_integrating())
    wash_out(study, y_sim, simulated(study.assessed_model()), assessed);
  return assessed;
}

Eigen::Index samples_to_settle(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                               RecordStart start) {
  const bool at_rest =
      start == RecordStart::rest || (start == RecordStart::automatic && begins_at(point.u, record.u) &&
                                     begins_at(Eigen::VectorXd::Zero(record.d.rows()), record.d));
  return at_rest ? 0 : slowest_settling(study);
}

AssessedLoop assessed_loop(const Study& study, const OperatingPoint& point, const PlantRecord& record,
                           Eigen::Index unjudged) {
  const Eigen::Index before = 3 * unjudged;  // a system of higher order needs more than its settling time
  const Eigen::MatrixXd d = as_taken_in_record(study.controller.md_analysers, record.d);
  const auto simulated = [&](const TransferMatrix& model) -> Eigen::MatrixXd {
    return simulated_output(model, study.controller.sample_time, point.u, after_rest(record.u, before),
                            after_rest(d, before))
        .rightCols(record.samples());
  };
  const Eigen::MatrixXd y_sim = simulated(study.plant.G);
  AssessedLoop loop{.y = record.y,
                    .u = record.u,
                    .u_target = where_recorded(record.u_target, point.u.replicate(1, record.samples())),
                    .d = d,
                    .y_sim = where_recorded(record.y_sim, y_sim),
                    .y_set = Eigen::MatrixXd::Constant(record.y.rows(), record.samples(), kNaN),
                    .candidates = record.candidates};
  take_analyses(study, FirstAnalysis::of_record, loop.y);
  loop.y.leftCols(std::min(unjudged, record.samples())).setConstant(kNaN);
  const Eigen::MatrixXd of_study = setpoints(study);
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    if (study.controller.has_setpoint(cv))
      loop.y_set.row(cv) = of_study.row(cv);
  if (study.plant.G.is_integrating())
    wash_out(study, Eigen::MatrixXd(loop.y_sim), simulated(study.assessed_model()), loop);
  return loop;
}

AssessedLoop window_of(const AssessedLoop& record, Eigen::Index first, Eigen::Index samples) {
  const auto cut = [&](const Eigen::MatrixXd& signal) -> Eigen::MatrixXd {
    return signal.cols() == 0 ? signal : Eigen::MatrixXd(signal.middleCols(first, samples));
  };
  return {.y = cut(record.y),
          .u = cut(record.u),
          .u_target = cut(record.u_target),
          .d = cut(record.d),
          .y_sim = cut(record.y_sim),
          .y_set = cut(record.y_set),
          .candidates = cut(record.candidates),
          .whole = &record,
          .first = first};
}

std::shared_ptr<AssessedLoop> same_window(const AssessedLoop& loop, AssessedLoop record) {
  struct Kept {
    AssessedLoop record, window;
  };
  auto kept = std::make_shared<Kept>(Kept{std::move(record), {}});
  if (loop.whole)
    kept->window = window_of(kept->record, loop.first, loop.samples());
  for (AssessedLoop* each : {&kept->record, &kept->window})
    each->derived.keep(PaidBy::each);
  return {kept, loop.whole ? &kept->window : &kept->record};
}

std::shared_ptr<const AssessedLoop> with_analyses_held(const Study& study, const AssessedLoop& loop,
                                                       AnalysesHeld from) {
  const bool shown = from == AnalysesHeld::from_shown;
  return loop.derived.of<const AssessedLoop>(shown ? "held from shown" : "held from taken", [&] {
    AssessedLoop whole = loop.from_start();
    const std::vector<AnalyserTiming>& timings = study.controller.analysers;
    for (std::size_t i = 0; i < timings.size(); ++i)
      if (const auto cv = static_cast<Eigen::Index>(i); timings[i].is_analyser())
        hold(timings[i], shown ? timings[i].delay : 0, whole.y.row(cv), whole.y_sim.row(cv));
    return same_window(loop, std::move(whole));
  });
}

std::optional<std::string> out_of_proportion(const Study& study, const AssessedLoop& loop) {
  const AssessedLoop& whole = loop.from_start();
  const auto &cvs = study.plant.cvs, &mvs = study.plant.mvs, &mds = study.plant.mds;
  enum class Gaps { none, some };
  const auto first_in = [](const Eigen::MatrixXd& signal, Gaps gaps,
                           const auto& name) -> std::optional<std::string> {
    if ((signal.array().abs() <= kLargestValue).all())
      return std::nullopt;
    for (Eigen::Index k = 0; k < signal.cols(); ++k)
      for (Eigen::Index row = 0; row < signal.rows(); ++row)
        if (const double value = signal(row, k);
            std::isnan(value) ? gaps == Gaps::none : std::abs(value) > kLargestValue)
          return fmt::format("{} of {} at sample {}", name(static_cast<std::size_t>(row)), value, k);
    return std::nullopt;
  };
  const auto name_of = [](const std::vector<PlantModel::Variable>& variables, const char* what) {
    return [&variables, what](std::size_t row) { return what + variables[row].name; };
  };
  const auto candidate = [](std::size_t row) { return fmt::format("candidate {}", row + 1); };
  std::optional<std::string> found = first_in(whole.y, Gaps::some, name_of(cvs, ""));
  if (!found)
    found = first_in(whole.u, Gaps::none, name_of(mvs, ""));
  if (!found)
    found = first_in(whole.d, Gaps::none, name_of(mds, ""));
  if (!found)
    found = first_in(whole.y_sim, Gaps::none, name_of(cvs, "y_sim of "));
  if (!found)
    found = first_in(whole.u_target, Gaps::some, name_of(mvs, "target of "));
  if (!found)
    found = first_in(whole.y_set, Gaps::some, name_of(cvs, "setpoint of "));
  if (!found)
    found = first_in(whole.candidates, Gaps::some, candidate);
  return found;
}

Eigen::MatrixXd recorded_basis(const AssessmentContext& context) {
  return recorded(context.study, basis_index(context.basis.world), context.basis.trajectory).y;
}

}  // namespace mpm
