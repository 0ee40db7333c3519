#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/records/record_panel.hpp"

// Simulated records like that of a plant: what is unknown in the record is unknown in them as well.

namespace mpm {

/// The largest bias of the operating point of a CV, up or down, in standard deviations of its noise. That of
/// an MV is the change that moves a CV as far.
inline constexpr double kTrialBias = 0.25;

/// Errors of the model in simulated records, relative to those that a healthy model may have: a plant is a
/// little worse than anyone says.
inline constexpr double kWorseWorlds = 1.5;

/// What the simulated records are made from.
struct TrialFrame {
  PlantRecord record;     ///< the record of the plant
  Study study;            ///< trial_study() of the record with what comes before it
  Eigen::Index lead = 0;  ///< samples before the record, which are simulated and cut off
  double bias = 0.0;      ///< kTrialBias, or 0
};

/// The record with `lead` samples before its first one, in which MDs, setpoints, limits and modes move as
/// they do after it, in the reverse order: nobody knows how they moved. `lead` is at most the number of
/// samples of the record less one.
PlantRecord with_lead(const PlantRecord& record, Eigen::Index lead);

/// Makes the loop of an experiment of the study look like the record of the plant: without what came before
/// it, with biases, and with its gaps, also in MVs and MDs.
PlantRecord trial_record(const TrialFrame& frame, const ExperimentDraw& draw, const Trajectory& loop);

/// What the methods say of an experiment that ran to its end, whose loop is kept.
using LoopAssessor = std::function<std::vector<AssessmentRecord>(const ExperimentRecord& record)>;

/// Puts the answers into the record of an experiment of `study`, which keeps its loop. One that did not run
/// to its end is not assessed.
void answer(ExperimentRecord& record, const Study& study, const LoopAssessor& assess);

/// Judges trial_record() of each experiment as the record of the plant is judged. Each thread needs its own.
LoopAssessor trial_assessor(const std::shared_ptr<const RecordFrame>& judged,
                            const std::shared_ptr<const TrialFrame>& made);

}  // namespace mpm
