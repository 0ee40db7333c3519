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
  Rate flagged;  ///< of the experiments with a verdict; for the chain: with impact
  /// Fits of Ivar_basis on the method's estimate of it: over all CVs of all experiments with a verdict
  /// (figures 6.18, 6.22), and CV by CV. Without pairs if the method does not estimate it.
  LinearFitIntervals regression;
  std::vector<LinearFitIntervals> regression_of_cv;
  /// The fit over all CVs of the experiments that do not have this cause, whatever other causes they have;
  /// for `none`, of the experiments without any cause. `without_cause` is empty if no experiment has known
  /// conditions.
  struct WithoutCause {
    NonlinearCause cause;
    std::int64_t experiments = 0;  ///< that have the cause; for `none`: that have any cause
    LinearFit fit;
  };
  std::vector<WithoutCause> without_cause;
  ConfusionMatrix confusion{1};  ///< true CV against predicted CV over the flagged experiments (6.20, 6.23)
  Rate located;                  ///< accuracy of `confusion`
  /// Share of experiments with the right source (6.21), over in_source_population(). Experiments with both
  /// faults do not count.
  Rate source_recognised;
  /// A summary of each of summarised_numbers(), over in_source_population().
  std::vector<SampleSummary> summaries;
};

/// Collects the findings on each kind with a fault that the study has: mpm, ud, mpm_ud. `method` is the place
/// of the method in the assessments of each record. The order of the records changes at most the last bits.
/// `study` and `form` must outlive the collector.
Collector<std::vector<KindFindings>> kind_collector(const Study& study, const AssessmentForm& form,
                                                    std::size_t method);

/// Returns the rows of `kind`; their names begin with `prefix`.
std::vector<Finding> rows_of(const KindFindings& kind, const Study& study, const AssessmentForm& form,
                             const std::string& prefix);

/// Returns the row `like` with the label, the meaning and the value of the share of unstable loops.
Finding unstable_row(const Endings& endings, Finding like);

/// The numbers of the method that are summarised, in the order of KindFindings::summaries.
std::vector<const AssessmentNumberInfo*> summarised_numbers(const AssessmentForm& form);

/// I_MPM of the experiments with both faults whose dominance lies in [lower, upper) (figure 6.24).
struct DominanceBin {
  double lower, upper;
  SampleSummary i_mpm;
  Rate above_threshold;
};

/// Collects bins with the edges 0, 0.3, 0.5, 0.7, 1; no bins if the study has no experiments with both
/// faults. `method` is the place of the chain. `study` must outlive the collector.
Collector<std::vector<DominanceBin>> dominance_collector(const Study& study, std::size_t method);

std::vector<Finding> rows_of(const std::vector<DominanceBin>& bins);

/// Returns a rate over the experiments of all kinds together. No experiment is in two kinds.
Rate over_kinds(const std::vector<KindFindings>& kinds, Rate KindFindings::*rate, double confidence);

/// How well I_MPM tells a mismatch from a disturbance, whatever its threshold: the ROC curve of I_MPM over
/// the experiments of in_source_population() with one fault. Not defined if one of the two kinds has no
/// experiments.
struct SourceCurve {
  RocCurve curve;
  Interval area{kNaN, kNaN};            ///< of the area under the curve
  Interval best_threshold{kNaN, kNaN};  ///< of the threshold with the largest J, by bootstrap
  RocPoint at_study{};                  ///< at the threshold of the study
};

/// `method` is the place of the chain. `study` must outlive the collector.
Collector<SourceCurve> source_curve_collector(const Study& study, std::size_t method);

/// Returns the rows of the area and of the threshold with the largest J.
std::vector<Finding> rows_of(const SourceCurve& source);

}  // namespace mpm
