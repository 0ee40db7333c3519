#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "analysis/identification/polynomial_model.hpp"
#include "base/enum_words.hpp"

namespace mpm {

/// How an identification ended.
enum class IdentificationStatus : std::int8_t {
  ok = 0,
  rank_deficient = 1,      ///< the data do not determine the parameters: an input that is constant or depends
                           ///< on others, or orders that are too high
  not_converged = 2,       ///< the search ended where the gradient of the loss is not small
  at_stability_limit = 3,  ///< the search ended with a root of C, D or F at the largest radius allowed
  noise_free = 4,  ///< nothing above rounding is left for C and D to describe: they are 1. If the orders are
                   ///< above those of the data, the coefficients are not determined and there is no
                   ///< covariance, but the response to one input from rest is determined
};

/// Whether the response to the inputs can be used: yes for ok, noise_free and at_stability_limit. The last is
/// less certain, because the covariance does not hold at a limit.
bool is_usable(IdentificationStatus status);

template <>
inline constexpr auto kWords<IdentificationStatus> = word_list("ok", "rank deficient", "not converged",
                                                               "at the stability limit", "noise free");

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
};

/// Refuses data from which no model of these orders can be identified: other than nu rows, different lengths,
/// values that are not finite, no parameter, or no more samples from `first_sample` on than parameters.
/// @throws InputError naming what was found and what is allowed
void require_identification_data(const Eigen::Ref<const Eigen::VectorXd>& y,
                                 const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                                 Eigen::Index first_sample);

/// The best-fit index of an estimate of a measured output (3.32),
///
///   %Fit = 100 (1 - |y - y_est| / |y - mean y|)
///
/// 100 for an estimate that is right, 0 for one as good as the mean, without a lower bound. An output without
/// variance (to rounding) has no such index: NaN.
///
/// | symbol   | meaning                     | shape | unit      |
/// |----------|-----------------------------|-------|-----------|
/// | y, y_est | measured, estimated output  | N     | of the CV |
///
/// @throws InputError for fewer than 2 samples, different lengths, or measurements that are not finite. An
///   estimate that is not finite, of an unstable model, gives -infinity.
double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                   const Eigen::Ref<const Eigen::VectorXd>& y_est);
/// The same from |y - y_est|^2, if this is known.
double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y, double squared_error);

}  // namespace mpm
