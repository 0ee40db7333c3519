#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/experiment/judgement.hpp"
#include "analysis/findings/collector.hpp"
#include "analysis/findings/endings.hpp"
#include "analysis/findings/finding.hpp"
#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/regression.hpp"
#include "analysis/statistics/roc.hpp"
#include "analysis/statistics/sample_summary.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// What a method says about the experiments of one kind with a fault.
struct KindFindings : Endings {
  ExperimentKind kind = ExperimentKind::healthy;
  Rate flagged;  ///< of those with a verdict; of the chain: with impact
  /// Ivar_basis against the method's estimate of it over all CVs of all experiments with a verdict
  /// (figures 6.18, 6.22), and CV by CV. Without pairs for a method that estimates none.
  LinearFitIntervals regression;
  std::vector<LinearFitIntervals> regression_of_cv;
  /// The fit over all CVs of the experiments that have not this cause, whatever others they have; with `none`
  /// that of those without any. Empty where no cause of an experiment is known.
  struct WithoutCause {
    NonlinearCause cause;
    std::int64_t experiments = 0;  ///< that have the cause; with `none` those that have one
    LinearFit fit;
  };
  std::vector<WithoutCause> without_cause;
  ConfusionMatrix confusion{1};  ///< true CV against predicted CV over the flagged experiments (6.20, 6.23)
  Rate located;                  ///< its accuracy
  /// Experiments whose source is the right one (6.21), over in_source_population(). No trials for experiments
  /// with both faults.
  Rate source_recognised;
  /// Of each number of the method that is to be summarised, over the same population.
  std::vector<SampleSummary> summaries;
};

/// The kinds with a fault that the study has: mpm, ud, mpm_ud. `method` is the place of the method in the
/// assessments of each record; the order of the records does not matter beyond the last bits.
/// `study` and `form` must outlive the collector.
Collector<std::vector<KindFindings>> kind_collector(const Study& study, const AssessmentForm& form,
                                                    std::size_t method);

/// Its rows; names begin with `prefix`.
std::vector<Finding> rows_of(const KindFindings& kind, const Study& study, const AssessmentForm& form,
                             const std::string& prefix);

/// The share of loops that are not stable, in a row that is `like` this.
Finding unstable_row(const Endings& endings, Finding like);

/// The numbers of the method that are summarised, in the order of KindFindings::summaries.
std::vector<const AssessmentNumberInfo*> summarised_numbers(const AssessmentForm& form);

/// I_MPM of the experiments with both faults whose dominance lies in [lower, upper) (figure 6.24).
struct DominanceBin {
  double lower, upper;
  SampleSummary i_mpm;
  Rate above_threshold;
};

/// Edges 0, 0.3, 0.5, 0.7, 1; empty without experiments of both faults. `method` is the place of the chain.
/// `study` must outlive the collector.
Collector<std::vector<DominanceBin>> dominance_collector(const Study& study, std::size_t method);

std::vector<Finding> rows_of(const std::vector<DominanceBin>& bins);

/// A rate of the experiments of all kinds, which have none in common.
Rate over_kinds(const std::vector<KindFindings>& kinds, Rate KindFindings::*rate, double confidence);

/// How well I_MPM tells a mismatch from a disturbance, whatever its threshold: its ROC curve over the
/// experiments with one fault of in_source_population(). Not defined without experiments of either kind.
struct SourceCurve {
  RocCurve curve;
  Interval area{kNaN, kNaN};            ///< of the area under it
  Interval best_threshold{kNaN, kNaN};  ///< of the threshold with the largest J, by bootstrap
  RocPoint at_study{};                  ///< with the threshold of the study
};

/// `method` is the place of the chain. `study` must outlive the collector.
Collector<SourceCurve> source_curve_collector(const Study& study, std::size_t method);

/// The area, and the threshold with the largest J.
std::vector<Finding> rows_of(const SourceCurve& source);

}  // namespace mpm
