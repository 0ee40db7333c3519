#pragma once

#include <Eigen/Core>

#include "analysis/mpm_indicator.hpp"
#include "analysis/nominal_output.hpp"
#include "scenarios/study.hpp"

namespace mpm {

/// What the chain of the thesis says of one closed loop (appendix A2).
///
/// | symbol     | member     | shape | definition                                            |
/// |------------|------------|-------|-------------------------------------------------------|
/// | Ivar       | ivar       | ny    | var y / var y0                                 (6.7)  |
/// | Ivar_diag  | ivar_diag  | ny    | var y / var y0_diag                            (6.8)  |
/// | Ivar_basis | ivar_basis | ny    | var y / var y of the basis case                (6.22) |
struct Diagnosis {
  Eigen::VectorXd ivar, ivar_diag, ivar_basis;
  bool impactful = false;                                  ///< some Ivar lies outside the band of impact
  Eigen::Index predicted_cv = -1;                          ///< the CV whose Ivar_diag is farthest from 1
  MpmIndicator indicator;                                  ///< of the predicted CV, (6.13) to (6.15)
  ExperimentKind predicted_source = ExperimentKind::none;  ///< mpm when I_MPM exceeds its threshold, else ud
};

/// The window lengths of (6.13) for this study, in samples.
WindowScan window_scan(const Study& study);

/// Index of the CV that `ivar_diag` points at. Ties go to the first CV; a CV whose index is NaN is passed
/// over.
Eigen::Index farthest_from_one(const Eigen::Ref<const Eigen::VectorXd>& ivar_diag, LocationDistance distance);

/// Runs the chain on records y (ny x N); keeps the workspace of the indicators between calls. One a thread.
class DiagnosisChain {
 public:
  explicit DiagnosisChain(const Study& study);

  /// `y_basis` is the record of the basis case, of the same shape as y.
  Diagnosis diagnose(const Eigen::Ref<const Eigen::MatrixXd>& y, const NominalOutputs& nominal,
                     const Eigen::Ref<const Eigen::MatrixXd>& y_basis);

 private:
  DiagnosisOptions options_;
  WindowScan windows_;
  MpmScanner scanner_;
};

}  // namespace mpm
