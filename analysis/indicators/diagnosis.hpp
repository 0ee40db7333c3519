#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/indicators/acf_comparison.hpp"
#include "analysis/indicators/distribution_indicators.hpp"
#include "analysis/indicators/mpm_indicator.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/non_finite.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The options of [diagnosis] in a study that only the chain uses.
struct ChainOptions {
  double mpm_threshold = 0.1;  ///< I_MPM above it: model-plant mismatch

  bool operator==(const ChainOptions&) const = default;
};

/// That of a study.
inline double mpm_threshold(const Study& study) {
  return study.assessment.of<ChainOptions>().mpm_threshold;
}

/// What the chain says about one CV of a named scenario, in which several CVs may be affected.
struct CvDiagnosis {
  bool flagged = false;                    ///< Ivar_diag lies outside the band of impact
  FaultSource source = FaultSource::none;  ///< of a flagged CV: mpm when I_MPM exceeds its threshold
  /// Chapters 2, 5 and 6; `mpm` of it is (6.13) to (6.15). One window length is the prediction horizon.
  DistributionIndicators distribution;
  AcfComparison acf;  ///< M2 and M3: about the setpoint where the CV has one
  double sse = kNaN;  ///< (4.17), CV unit
};

/// Ivar_diag of the affected CV of an experiment with mismatch and disturbance when the loop is run with one
/// of them alone, and the dominance of the mismatch (6.23),
///
///   dominance_MPM = Ivar_diag^MPM / (Ivar_diag^MPM + Ivar_diag^UD)
///
/// NaN where there are no such loops.
struct FaultsAlone {
  double ivar_diag_mpm = kNaN;
  double ivar_diag_ud = kNaN;
  double dominance_mpm = kNaN;
};

/// What the chain of the thesis says about one closed loop (appendix A2).
///
/// | symbol     | member     | shape | definition                                            |
/// |------------|------------|-------|-------------------------------------------------------|
/// | Ivar       | ivar       | ny    | var y / var y0                           (3.24, 6.7)  |
/// | Ivar_diag  | ivar_diag  | ny    | var y / var y0_diag                      (4.14, 6.8)  |
///
/// The variances of a CV with a setpoint are taken about it, unless the study wants them about the mean.
struct Diagnosis {
  Eigen::VectorXd ivar, ivar_diag;
  bool impactful = false;          ///< some Ivar lies outside the band of impact
  Eigen::Index predicted_cv = -1;  ///< the CV whose Ivar_diag is farthest from 1
  double location_margin = std::numeric_limits<double>::quiet_NaN();  ///< location_margin() of ivar_diag
  MpmIndicator indicator;                            ///< of the predicted CV, (6.13) to (6.15)
  FaultSource predicted_source = FaultSource::none;  ///< DiagnosisChain::source_of() the indicator
  FaultsAlone alone;                                 ///< of an experiment with both faults
  /// Every CV on its own, for named scenarios; empty for random experiments, which look at one CV.
  std::vector<CvDiagnosis> cvs = {};
};

/// |ivar - 1|, or |log ivar|.
double distance_from_one(double ivar, LocationDistance distance);

/// Index of the CV that `ivar_diag` points at. Ties go to the first CV; a CV whose index is NaN is passed
/// over.
Eigen::Index farthest_from_one(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance);

/// How clearly `ivar_diag` points at a CV: how much farther from 1 its index is than the next one. 0 at a
/// tie; NaN with fewer than two indices.
double location_margin(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance);

/// Ivar_basis = var y / var y_basis (6.22) of every CV: what really became of the variance, a truth in which
/// no method has a part. y and y_basis are ny x N; variances as those of Ivar.
Eigen::VectorXd basis_variance_indices(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                       const Eigen::Ref<const Eigen::MatrixXd>& y_basis);

/// Centres of the variances of the samples `first` ... first + samples - 1 of a record: the setpoints of CVs
/// that have one; empty if the centre of all is the mean.
SetpointTrajectories variance_centres(const Study& study, Eigen::Index first, Eigen::Index samples);

/// Runs the chain on records y (ny x N); keeps the workspace of the indicators between calls, so each thread
/// needs its own.
class DiagnosisChain {
 public:
  explicit DiagnosisChain(const Study& study);
  /// Of records that are `samples` samples of a loop of the study, from sample `first` on.
  DiagnosisChain(const Study& study, Eigen::Index first, Eigen::Index samples);

  /// Of a study of named scenarios with every CV on its own.
  Diagnosis diagnose(const Eigen::Ref<const Eigen::MatrixXd>& y, const NominalOutputs& nominal);

  /// Every CV of the record y on its own; `ivar_diag` is that of diagnose().
  std::vector<CvDiagnosis> diagnose_each(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                         const NominalOutputs& nominal,
                                         const Eigen::Ref<const Eigen::VectorXd>& ivar_diag);

  /// I_MPM (6.15) of one CV of the record y.
  MpmIndicator indicator_of(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                            const NominalOutputs& nominal);

  /// mpm when I_MPM exceeds its threshold, ud when it does not, none when there is no I_MPM.
  FaultSource source_of(const MpmIndicator& indicator) const;

 private:
  /// The autocorrelation functions of one CV about the centre of its variances.
  AcfComparison compare(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                        const NominalOutputs& nominal) const;

  DiagnosisOptions options_;
  double mpm_threshold_;
  bool every_cv_;
  SetpointTrajectories y_set_;  ///< centres of the variances; empty: the means of all CVs
  WindowScan windows_;
  MpmScanner scanner_;
  int window_;  ///< of the ellipses, samples
  /// For named scenarios, which look at more than the two correlations.
  DistributionScanner distribution_scanner_;
};

}  // namespace mpm
