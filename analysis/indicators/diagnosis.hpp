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

/// The options in the section [diagnosis] of a study that only the chain uses.
struct ChainOptions {
  double mpm_threshold = 0.1;  ///< an I_MPM above it means model-plant mismatch

  bool operator==(const ChainOptions&) const = default;
};

/// Returns the threshold of I_MPM in a study.
inline double mpm_threshold(const Study& study) {
  return study.assessment.of<ChainOptions>().mpm_threshold;
}

/// The diagnosis of one CV of a named scenario, in which several CVs may be affected.
struct CvDiagnosis {
  bool flagged = false;                    ///< Ivar_diag lies outside the band of impact
  FaultSource source = FaultSource::none;  ///< of a flagged CV: mpm if I_MPM exceeds its threshold
  /// Chapters 2, 5 and 6; its member `mpm` is (6.13) to (6.15). The single window length is the prediction
  /// horizon.
  DistributionIndicators distribution;
  AcfComparison acf;  ///< M2 and M3: about the setpoint if the CV has one
  double sse = kNaN;  ///< (4.17), CV unit
};

/// For an experiment with mismatch and disturbance: Ivar_diag of the affected CV if the loop is run with only
/// one of the two, and the dominance of the mismatch (6.23),
///
///   dominance_MPM = Ivar_diag^MPM / (Ivar_diag^MPM + Ivar_diag^UD)
///
/// NaN if there are no such loops.
struct FaultsAlone {
  double ivar_diag_mpm = kNaN;
  double ivar_diag_ud = kNaN;
  double dominance_mpm = kNaN;
};

/// The diagnosis of one closed loop by the chain of the thesis (appendix A2).
///
/// | symbol     | member     | shape | definition                                            |
/// |------------|------------|-------|-------------------------------------------------------|
/// | Ivar       | ivar       | ny    | var y / var y0                           (3.24, 6.7)  |
/// | Ivar_diag  | ivar_diag  | ny    | var y / var y0_diag                      (4.14, 6.8)  |
///
/// The variances of a CV with a setpoint are taken about the setpoint, unless the study asks for the mean.
struct Diagnosis {
  Eigen::VectorXd ivar, ivar_diag;
  bool impactful = false;          ///< at least one Ivar lies outside the band of impact
  Eigen::Index predicted_cv = -1;  ///< the CV whose Ivar_diag is farthest from 1
  double location_margin = std::numeric_limits<double>::quiet_NaN();  ///< location_margin() of ivar_diag
  MpmIndicator indicator;                            ///< of the predicted CV, (6.13) to (6.15)
  FaultSource predicted_source = FaultSource::none;  ///< DiagnosisChain::source_of() of the indicator
  FaultsAlone alone;                                 ///< of an experiment with both faults
  /// The diagnosis of every CV on its own, for named scenarios; empty for random experiments, which look at
  /// one CV.
  std::vector<CvDiagnosis> cvs = {};
};

/// Returns |ivar - 1| or |log ivar|, as `distance` says.
double distance_from_one(double ivar, LocationDistance distance);

/// Returns the number of the CV whose Ivar_diag is farthest from 1; -1 if there is none. Of equal ones it is
/// the first. A CV whose Ivar_diag is NaN is passed over.
Eigen::Index farthest_from_one(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance);

/// Returns how clearly `ivar_diag` points at a CV: the distance from 1 of the farthest Ivar_diag less that of
/// the second farthest. 0 for a tie; NaN if fewer than two are not NaN.
double location_margin(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance);

/// Returns Ivar_basis = var y / var y_basis (6.22) of every CV. It is the true change of the variance and
/// does not depend on any method. y and y_basis are ny x N; the variances are taken as for Ivar.
Eigen::VectorXd basis_variance_indices(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                       const Eigen::Ref<const Eigen::MatrixXd>& y_basis);

/// Returns the centres of the variances for the samples `first` ... first + samples - 1 of a record: the
/// setpoint of each CV that has one. Empty if the variances of all CVs are taken about the mean.
SetpointTrajectories variance_centres(const Study& study, Eigen::Index first, Eigen::Index samples);

/// Runs the chain on records y (ny x N). It keeps the workspace of the indicators between calls, so each
/// thread needs its own.
class DiagnosisChain {
 public:
  explicit DiagnosisChain(const Study& study);
  /// For records of `samples` samples, cut from a loop of the study from sample `first` on.
  DiagnosisChain(const Study& study, Eigen::Index first, Eigen::Index samples);

  /// Diagnoses a record y; if the study has named scenarios, also every CV on its own.
  Diagnosis diagnose(const Eigen::Ref<const Eigen::MatrixXd>& y, const NominalOutputs& nominal);

  /// Diagnoses every CV of the record y on its own; `ivar_diag` is that of diagnose().
  std::vector<CvDiagnosis> diagnose_each(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                         const NominalOutputs& nominal,
                                         const Eigen::Ref<const Eigen::VectorXd>& ivar_diag);

  /// Returns I_MPM (6.15) of one CV of the record y.
  MpmIndicator indicator_of(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                            const NominalOutputs& nominal);

  /// Returns mpm if I_MPM exceeds its threshold, ud if it does not, and none if there is no I_MPM.
  FaultSource source_of(const MpmIndicator& indicator) const;

 private:
  /// Compares the autocorrelation functions of one CV about the centre of its variances.
  AcfComparison compare(Eigen::Index cv, const Eigen::Ref<const Eigen::MatrixXd>& y,
                        const NominalOutputs& nominal) const;

  DiagnosisOptions options_;
  double mpm_threshold_;
  bool every_cv_;
  SetpointTrajectories y_set_;  ///< centres of the variances; empty if they are the means
  WindowScan windows_;
  MpmScanner scanner_;
  int window_;  ///< of the ellipses, samples
  /// For named scenarios, which use more indicators than the two correlations.
  DistributionScanner distribution_scanner_;
};

}  // namespace mpm
