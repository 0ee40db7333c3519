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
  std::string archive;  ///< where its loops are stored
  std::int64_t loops = 0;
  /// The findings on each method, in the order of RecordAssessment::said. `mpmbench` has none, because it is
  /// asked only about the records that the model does not explain.
  std::vector<std::optional<TrialFindings>> methods;
  TrialFindings model;  ///< findings on RecordAssessment::model
  Eigen::VectorXd cost = {},
                  cost_since = {};  ///< thresholds of the costs of the CVs, ny (number_thresholds())
  double fit = kNaN;                ///< fit_threshold()
  double health = kNaN;             ///< threshold of the score of a channel in a period
  TrialCounts counts = {};          ///< counts for the source that the verdict names
};

/// What the methods say of a record of a plant, and what a person needs to judge it.
struct RecordAssessment {
  std::string file;     ///< name of the record's file, without its folder
  std::string version;  ///< version of the program
  Study study;          ///< recorded_study()
  PlantRecord record;
  AssessedLoop loop;
  Eigen::MatrixXd y0;                  ///< ny x N, the nominal loop under the recorded disturbances
  Eigen::Index unjudged = 0;           ///< samples at the start that only fill the memory of the model
  std::vector<AssessmentRecord> said;  ///< answers of the methods that were asked for
  AssessmentRecord model;              ///< model_check_method()
  std::vector<UnexplainedCv> unexplained = {};
  AssessmentRecord sources = {};  ///< answer of `mpmbench`, which the verdict follows
  AssessmentRecord odds = {};     ///< answer of `likelihood`, which `mpmbench` asks
  ControllerCheck controller;
  double model_error = 0.0;                 ///< RecordFrame::model_error
  std::vector<CvCost> costs = {};           ///< over all judged samples
  std::vector<Eigen::Index> periods = {};   ///< health_periods()
  std::vector<ChannelHistory> health = {};  ///< of all channels, CV by CV
  DataOptions data;                         ///< options of the study with which the record was read
  std::optional<PromisedRepair> repair;
  std::optional<ChannelInformation> information = {};  ///< about the channel of the repair
  std::vector<RepairProspect> prospects = {};  ///< ranked(); empty unless the fault may be in the model
  std::string no_repair;  ///< why there is no repair although the source is a mismatch; otherwise empty
  std::optional<RecordTrial> trial;
  std::string no_trial;  ///< why there is no calibration run
  std::vector<std::string> warnings;
  RecordVerdict verdict;  ///< conclusion from all of this

  /// The findings on the method in this place of `said`; null if it was not asked about the simulated
  /// records.
  const TrialFindings* trial_of(std::size_t method) const {
    return trial && trial->methods[method] ? &*trial->methods[method] : nullptr;
  }
  /// Returns whether the score of the method is above that of simulated records without a fault. Without such
  /// records its own flag counts; for a method that was not asked about all of them, its flag counts if the
  /// model does not explain the record.
  bool is_flagged(std::size_t method) const;
  /// The threshold of the score of the model: from the simulated records, or kFarTooLarge without any.
  double model_threshold() const { return trial ? trial->model.threshold : kFarTooLarge; }
  /// The threshold of the health of channels, in the same way.
  double health_threshold() const { return trial ? trial->health : kFarTooLarge; }
  /// The prospect of the channel that the verdict names; null if it was not simulated.
  const RepairProspect* named_prospect() const;
};

/// The CV that a person looks at first: the one that the verdict names, or else the one that the model
/// explains least.
Eigen::Index worst_cv(const RecordAssessment& assessment);

}  // namespace mpm
