#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "analysis/sensitivity/second_order_fit.hpp"
#include "scenarios/study/study.hpp"

// The effect of an error in S0 ("Sensitivity of S0" in 6.5.2, figures 6.25 to 6.29): the diagonal of S0 is
// modified in time constant or damping, and Ivar_diag (6.8) is computed again.

namespace mpm {

/// The model (6.24), fitted to the diagonal element of T0 of one active CV.
struct DiagonalFit {
  Eigen::Index cv;
  SecondOrderFit fit;
};

/// Returns the fits of all active CVs of T0, in their order.
std::vector<DiagonalFit> diagonal_fits(const NominalSensitivity& sensitivity, double sample_time);

/// Ivar_diag of the affected CV of one experiment, with one value for each multiplier of the study. Empty if
/// the experiment is not examined.
struct PerturbedIvar {
  Eigen::VectorXd time_constant;  ///< tau of (6.24) multiplied
  Eigen::VectorXd damping;        ///< xi of (6.24) multiplied
};

/// The modified models of a study. For the diagonal element T0 with the fit T of (6.24),
///
///   T0_modified = T0 + T(m tau, xi) - T(tau, xi)   or   T0 + T(tau, m xi) - T(tau, xi).
///
/// Thus the properties that a second-order model cannot describe (above all the dead time) stay as they are,
/// and a multiplier of 1 gives T0 itself, bit for bit.
class S0Perturbation {
 public:
  /// If the study has no multipliers, or if T0 cannot be fitted, there is no modified model.
  S0Perturbation(const Study& study, const NominalSensitivity& sensitivity);

  /// Returns Ivar_diag of `cv` (6.8) with each modified model, from its record y and model output y_sim (N
  /// samples each). Empty if the CV has no modified model. Throws InputError if the lengths differ.
  PerturbedIvar ivar_diag(Eigen::Index cv, const Eigen::Ref<const Eigen::RowVectorXd>& y,
                          const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) const;

 private:
  struct Models {
    Eigen::Index cv;
    std::vector<Eigen::RowVectorXd> time_constant, damping;  ///< step responses, one for each multiplier
  };
  std::vector<Models> models_;
};

}  // namespace mpm
