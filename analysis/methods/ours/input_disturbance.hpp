#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/shared_whitening.hpp"
#include "analysis/methods/ours/disturbance_scan.hpp"
#include "analysis/methods/ours/model_errors.hpp"

namespace mpm {

/// The evidence for a disturbance on one MV.
struct InputEvidence {
  double log_evidence;  ///< in the measure of CvEvidence::healthy, summed over the CVs
  double a, b;          ///< of the likeliest disturbance, b in MV units
};

/// A disturbance x between controller and plant moves all CVs at once, each through its channel of the model,
///
///   e_i = G0_ij x + Z_i' z_i + n_i,   x(k+1) = a x(k) + b w(k),   z_i ~ N(0, I),
///
/// with the noise n_i and the directions Z_i of ModelErrors. The evidence is the integral over time constant
/// and standard deviation of x, both log-uniform, by Laplace's method about the likeliest point. The variance
/// of the innovations of each CV is known up to a factor of its own (ScaleLikelihood).
///
/// | symbol  | name      | shape        | unit                              |
/// |---------|-----------|--------------|-----------------------------------|
/// | e_i, Z_i | series   | (1 + q_i) x N | standard deviations of the noise |
/// | j       | mv        |              |                                   |
class InputLikelihood {
 public:
  /// `series` has one matrix for each CV, with NaN in its first row where there is no sample.
  InputLikelihood(const std::vector<ModelErrors>& models, const std::vector<Eigen::MatrixXd>& series,
                  double sample_time, double noise_freedom);

  /// The evidence for each MV; -infinity if it moves no CV, or if another MV explains so much more that it
  /// need not be evaluated closely.
  std::vector<InputEvidence> of_mvs(Eigen::Index mvs) const;

 private:
  class OfCvs;
  class OfMv;

  struct LogLikelihood {
    double e = 0.0, with_directions = 0.0;  ///< of e alone, and with the directions of the model
  };

  const std::vector<ModelErrors>& models_;
  const std::vector<Eigen::MatrixXd>& series_;
  double sample_time_, freedom_;
  std::vector<LogLikelihood> unmoved_;  ///< of each CV without a disturbance; 0 if all inputs move it
};

}  // namespace mpm
