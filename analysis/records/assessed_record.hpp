#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/repair.hpp"
#include "analysis/findings/trial_findings.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/records/channel_health.hpp"
#include "analysis/records/channel_information.hpp"
#include "analysis/records/controller_check.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/record_verdict.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The calibration run behind the answers on a record.
struct RecordTrial {
  std::string archive;  ///< where it is kept
  std::int64_t loops = 0;
  /// In the order of the answers; none of `mpmbench`, which is asked only of the records that the model does
  /// not explain.
  std::vector<std::optional<TrialFindings>> methods;
  TrialFindings model;  ///< of RecordAssessment::model
  Eigen::VectorXd cost = {},
                  cost_since = {};  ///< thresholds of the costs of the CVs, ny (number_thresholds())
  double fit = kNaN;                ///< fit_threshold()
  double health = kNaN;             ///< that of the score of a channel in a period
  TrialCounts counts = {};          ///< of the source that the verdict names
};

/// What the methods say of a record of a plant, and what a person needs to judge it.
struct RecordAssessment {
  std::string file;     ///< of the record, its name only
  std::string version;  ///< of the program
  Study study;          ///< recorded_study()
  PlantRecord record;
  AssessedLoop loop;
  Eigen::MatrixXd y0;                  ///< ny x N, the nominal loop under the recorded disturbances
  Eigen::Index unjudged = 0;           ///< samples at the start that only fill the memory of the model
  std::vector<AssessmentRecord> said;  ///< by each method that was asked for
  AssessmentRecord model;              ///< model_check_method()
  std::vector<UnexplainedCv> unexplained = {};
  AssessmentRecord sources = {};  ///< `mpmbench`, whose answer the verdict is
  AssessmentRecord odds = {};     ///< `likelihood`, which it asks
  ControllerCheck controller;
  double model_error = 0.0;                 ///< RecordFrame::model_error
  std::vector<CvCost> costs = {};           ///< over all judged samples
  std::vector<Eigen::Index> periods = {};   ///< health_periods()
  std::vector<ChannelHistory> health = {};  ///< of all channels, CV by CV
  DataOptions data;                         ///< of the study, by which the record was read
  std::optional<PromisedRepair> repair;
  std::optional<ChannelInformation> information = {};  ///< of the channel of the repair
  std::vector<RepairProspect> prospects = {};          ///< ranked(), of a fault that may be the model's
  std::string no_repair;  ///< why there is none, of a verdict that names a channel; otherwise empty
  std::optional<RecordTrial> trial;
  std::string no_trial;  ///< why there is none
  std::vector<std::string> warnings;
  RecordVerdict verdict;  ///< what all of this comes to

  /// What the method in this place made of the simulated records; null where nobody asked it.
  const TrialFindings* trial_of(std::size_t method) const {
    return trial && trial->methods[method] ? &*trial->methods[method] : nullptr;
  }
  /// Is its score above that of simulated records without a fault? Without those, does it flag the record; of
  /// a method that nobody asked of all of them, one that the model does not explain?
  bool is_flagged(std::size_t method) const;
  /// That of the score of the model: of the simulated records, or kFarTooLarge without any.
  double model_threshold() const { return trial ? trial->model.threshold : kFarTooLarge; }
  /// The same of the health of channels.
  double health_threshold() const { return trial ? trial->health : kFarTooLarge; }
  /// Of the channel that the verdict names; null where it was not run.
  const RepairProspect* named_prospect() const;
};

/// The CV that a person looks at first: the one that the verdict names, or else the one that the model
/// explains least.
Eigen::Index worst_cv(const RecordAssessment& assessment);

}  // namespace mpm
