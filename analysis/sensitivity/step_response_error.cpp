#include "analysis/sensitivity/step_response_error.hpp"

#include <limits>

#include <fmt/format.h>

#include "analysis/identification/prediction_error.hpp"
#include "plants/error.hpp"

namespace mpm {

Eigen::MatrixXd step_response_errors(const Identification& identification, Eigen::Index samples) {
  if (samples < 1)
    throw InputError("samples of a step response", fmt::format("{}", samples), "1 or more");
  const PolynomialModel& model = identification.model;
  model.validate();
  const auto nu = static_cast<Eigen::Index>(model.inputs.size());
  Eigen::MatrixXd errors = Eigen::MatrixXd::Constant(nu, samples, std::numeric_limits<double>::quiet_NaN());
  if (identification.covariance.size() == 0)
    return errors;
  PolynomialModel noise_free = model;
  noise_free.C = noise_free.D = Eigen::VectorXd::Ones(1);
  const Eigen::Index of_response = noise_free.order().parameter_count();
  const Eigen::MatrixXd P = identification.covariance.topLeftCorner(of_response, of_response);
  for (Eigen::Index j = 0; j < nu; ++j) {
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(nu, samples + 1);
    u.row(j).setOnes();
    // With the step response itself as the output e = 0, and A de/dtheta is there what -A dh/dtheta is.
    const Eigen::VectorXd response = simulate(noise_free, u);
    const Eigen::MatrixXd gradient = prediction_error_gradient(noise_free, response, u);
    Eigen::MatrixXd g(samples, of_response);
    for (Eigen::Index i = 0; i < of_response; ++i)
      g.col(i) = filter(Eigen::VectorXd::Ones(1), model.A, gradient.col(i)).tail(samples);
    errors.row(j) = (g * P).cwiseProduct(g).rowwise().sum().cwiseMax(0.0).cwiseSqrt().transpose();
  }
  return errors;
}

}  // namespace mpm
