#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"

namespace mpm {

/// How an identification ended.
enum class IdentificationStatus : std::int8_t {
  ok = 0,
  rank_deficient = 1,      ///< the data do not determine the parameters: an input that is constant or depends
                           ///< on others, or orders that are too high
  not_converged = 2,       ///< the search ended where the gradient of the loss is not small
  at_stability_limit = 3,  ///< the search ended with a root of C, D or F at the largest radius allowed
  noise_free = 4,          ///< nothing above rounding is left for C and D to describe: they are 1
};

/// Whether the response to the inputs is an answer: ok, noise_free, and at_stability_limit, which is one with
/// less certainty (the covariance does not hold at a limit).
bool is_usable(IdentificationStatus status);

/// "ok", "rank deficient", ...
std::string to_string(IdentificationStatus status);

/// A model found in data, with the uncertainty of its coefficients.
///
/// | symbol     | member           | shape | meaning                                                  |
/// |------------|------------------|-------|----------------------------------------------------------|
/// | theta      | model.parameters() | p   | free coefficients                                        |
/// | P          | covariance       | p x p | sigma^2 (J'J)^-1, J = de/dtheta; empty when rank deficient |
/// | sigma^2    | model.noise_variance | | sum e^2/(n - p), over n = samples                        |
/// | V          | loss             |       | sum e^2/n                                                |
struct Identification {
  IdentificationStatus status = IdentificationStatus::not_converged;
  PolynomialModel model;
  Eigen::MatrixXd covariance;
  double loss = 0.0;
  Eigen::Index samples = 0;       ///< n, prediction errors in the loss
  Eigen::Index first_sample = 0;  ///< the first of them
  int iterations = 0;             ///< of the search; 0 for a linear regression
};

}  // namespace mpm
