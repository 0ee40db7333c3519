#include "analysis/records/trial_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/method_table.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/candidates.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// Holds the value of sample k - 1 at each unknown sample k.
void hold_unknown(const std::vector<bool>& unknown, Eigen::MatrixXd& signals) {
  for (std::size_t k = 1; k < unknown.size(); ++k)
    if (unknown[k])
      signals.col(static_cast<Eigen::Index>(k)) = signals.col(static_cast<Eigen::Index>(k) - 1);
}

/// The change of each MV that moves a CV by one standard deviation of its noise: the least over the CVs, or 0
/// if the MV moves none. A CV that integrates counts as methods see it.
Eigen::VectorXd noise_in_mvs(const Study& study) {
  const Eigen::MatrixXd gain = study.assessed_model().static_gain().leftCols(study.mv_count());
  Eigen::VectorXd least = Eigen::VectorXd::Constant(study.mv_count(), kInfinity);
  for (Eigen::Index mv = 0; mv < gain.cols(); ++mv)
    for (Eigen::Index cv = 0; cv < gain.rows(); ++cv)
      if (gain(cv, mv) != 0.0)
        least(mv) =
            std::min(least(mv), study.simulation.noise_standard_deviation(cv) / std::abs(gain(cv, mv)));
  return least.array().isFinite().select(least, 0.0);
}

/// Adds to each row a constant of up to `most` times its size, up or down.
void add_biases(const Eigen::VectorXd& size, double most, RandomStream& stream, Eigen::MatrixXd& signals) {
  for (Eigen::Index row = 0; row < signals.rows(); ++row)
    signals.row(row).array() += most * size(row) * (2.0 * stream.uniform() - 1.0);
}

}  // namespace

PlantRecord with_lead(const PlantRecord& record, Eigen::Index lead) {
  PlantRecord longer = record;
  for (Eigen::MatrixXd PlantRecord::*const signals :
       {&PlantRecord::y, &PlantRecord::u, &PlantRecord::d, &PlantRecord::u_target, &PlantRecord::y_set,
        &PlantRecord::lower, &PlantRecord::upper, &PlantRecord::y_sim, &PlantRecord::u_off,
        &PlantRecord::y_off, &PlantRecord::candidates}) {
    const Eigen::MatrixXd& all = record.*signals;
    if (all.cols() == 0)
      continue;
    Eigen::MatrixXd& joined = longer.*signals;
    joined.resize(all.rows(), lead + all.cols());
    joined << all.middleCols(1, lead).rowwise().reverse(), all;
  }
  return longer;
}

PlantRecord trial_record(const TrialFrame& frame, const ExperimentDraw& draw, const Trajectory& loop) {
  const PlantRecord& like = frame.record;
  const Eigen::Index N = like.samples();
  PlantRecord record = like;
  const Trajectory kept = recorded(frame.study, draw.index, loop);
  record.y = kept.y.rightCols(N);
  record.u = kept.u.rightCols(N);
  record.d = kept.d.rightCols(N);
  record.u_target = loop.u_target.rightCols(N);
  record.y_sim.setConstant(kNaN);
  if (record.candidates.size() > 0)
    record.candidates = logged_candidates(frame.study, draw).rightCols(N);
  // The gaps are those of the record, so their random numbers are free for the biases.
  RandomStream stream = experiment_stream(frame.study, draw.index, StreamId::missing);
  add_biases(frame.study.simulation.noise_standard_deviation, frame.bias, stream, record.y);
  add_biases(noise_in_mvs(frame.study), frame.bias, stream, record.u);
  record.y = like.y.array().isNaN().select(kNaN, record.y);
  const std::vector<bool> unknown = unknown_samples(like);
  hold_unknown(unknown, record.u);
  hold_unknown(unknown, record.d);
  return record;
}

void answer(ExperimentRecord& record, const Study& study, const LoopAssessor& assess) {
  record.assessments = record.status == ExperimentStatus::ok
                           ? assess(record)
                           : unassessed(assessment_forms(study, study_methods(study)));
}

LoopAssessor trial_assessor(const std::shared_ptr<const RecordFrame>& judged,
                            const std::shared_ptr<const TrialFrame>& made) {
  const auto panel = std::make_shared<RecordPanel>(*judged);
  return [judged, made, panel](const ExperimentRecord& experiment) {
    const PlantRecord record = trial_record(*made, experiment.draw, experiment.loop->trajectory);
    const ExperimentDraw without = experiment.draw.without_faults();
    const bool is_healthy = is_faultless(experiment.draw.kind);
    const auto [first, end] = record.benchmark;
    if (is_healthy || first == end || judged->finds_benchmark)
      return panel->judge(record).said;
    const PlantRecord healthy =
        trial_record(*made, without, simulate_experiment(made->study, without, judged->factory));
    return panel->judge(record, &healthy).said;
  };
}

}  // namespace mpm
