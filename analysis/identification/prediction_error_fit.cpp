#include "analysis/identification/prediction_error_fit.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/prediction_error.hpp"
#include "analysis/identification/prediction_error_search.hpp"
#include "analysis/identification/prediction_error_start.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

constexpr double kConverged = 1e-8;    // squared relative offset
constexpr double kNoiseFree = 1e-18;   // of the sum of squares of the output
constexpr double kNearlyExact = 1e-8;  // of it: below, a search without a noise model comes first

/// The data of one identification.
struct Data {
  const Eigen::Ref<const Eigen::VectorXd>& y;
  const Eigen::Ref<const Eigen::MatrixXd>& u;
  const PredictionErrorOptions& options;

  Eigen::Index samples() const { return y.size() - options.first_sample; }
  Eigen::VectorXd errors(const PolynomialModel& model) const {
    return prediction_errors(model, y, u, options.start).tail(samples());
  }
  Eigen::MatrixXd gradient(const PolynomialModel& model) const {
    return prediction_error_gradient(model, y, u, options.start).bottomRows(samples());
  }
  double size() const { return y.tail(samples()).squaredNorm(); }
  bool is_exact(double sum) const { return sum <= kNoiseFree * size(); }
  /// Whether only one response explains the output without an error. The difference h of two such responses
  /// has sum_l h(l) u(k - l) = 0 at every sample k, from rest on. From the first move of the input on, all
  /// h(l) must then be 0, as far as the record reaches. Several inputs could compensate each other.
  bool determines_response() const {
    return u.rows() == 1 && options.start == StartState::rest && options.first_sample == 0 && !u.isZero(0.0);
  }
};

PolynomialModel without_noise_model(PolynomialModel model) {
  model.C = model.D = Eigen::VectorXd::Ones(1);
  return model;
}

/// Status, loss and covariance of a model at which a search ended.
Identification assess(const Data& data, const PolynomialModel& model) {
  Identification result;
  result.model = model;
  result.samples = data.samples();
  result.first_sample = data.options.first_sample;
  const Eigen::VectorXd e = data.errors(model);
  const Eigen::Index p = model.order().parameter_count();
  const double sum = e.squaredNorm();
  result.loss = sum / static_cast<double>(result.samples);
  result.model.noise_variance = sum / static_cast<double>(result.samples - p);

  const LeastSquares step = least_squares(data.gradient(model), e, data.options.rank_tolerance);
  if (step.rank < p) {
    // With orders above those of the data, the coefficients of common factors are free, but the response can
    // still be determined.
    const bool has_noise_model = model.C.size() + model.D.size() > 2;
    result.status = !has_noise_model && data.is_exact(sum) && data.determines_response()
                        ? IdentificationStatus::noise_free
                        : IdentificationStatus::rank_deficient;
    return result;
  }
  result.covariance = result.model.noise_variance * step.inverse;
  const double border = 1.0 - 2.0 * (1.0 - data.options.largest_radius);
  if (search_radius(model) > border)
    result.status = IdentificationStatus::at_stability_limit;
  else if (data.is_exact(sum) || sum - step.residual_sum <= kConverged * sum)
    result.status = IdentificationStatus::ok;
  return result;
}

/// The answer for data without noise: a model without C and D, put into the wanted order.
Identification noise_free_result(const Identification& exact, const ModelOrder& order) {
  Identification result = exact;
  const Eigen::Index p = order.parameter_count();
  const Eigen::Index of_inputs = p - order.nc - order.nd;
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(p);
  theta.head(of_inputs) = exact.model.parameters();
  const double variance = exact.model.noise_variance;
  result.model = model_from_parameters(order, theta);
  result.model.noise_variance = variance;
  if (exact.covariance.size() > 0) {
    result.covariance = Eigen::MatrixXd::Zero(p, p);
    result.covariance.topLeftCorner(of_inputs, of_inputs) = exact.covariance;
  }
  result.status = IdentificationStatus::noise_free;
  return result;
}

bool leaves_at_most(const Data& data, const PolynomialModel& model, double share) {
  return data.errors(model).squaredNorm() <= share * data.size();
}

bool is_minimum(IdentificationStatus status) {
  return status == IdentificationStatus::ok || status == IdentificationStatus::noise_free;
}

Identification search_from(const Data& data, const PolynomialModel& start) {
  const ModelOrder order = start.order();
  if (order.nc + order.nd > 0 && leaves_at_most(data, without_noise_model(start), kNearlyExact)) {
    const PolynomialModel plain =
        search_prediction_error(without_noise_model(start), data.y, data.u, data.options);
    const Identification exact = assess(data, plain);
    if (leaves_at_most(data, plain, kNoiseFree) && is_minimum(exact.status))
      return noise_free_result(exact, order);
  }
  return assess(data, search_prediction_error(start, data.y, data.u, data.options));
}

}  // namespace

Identification identify_prediction_error(const Eigen::Ref<const Eigen::VectorXd>& y,
                                         const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                                         const PredictionErrorOptions& options) {
  options.validate();
  require_identification_data(y, u, order, options.first_sample);
  if (order.na > 0)
    throw InputError("orders of an output-error or Box-Jenkins model", order.to_string(), "na 0");
  const Data data{y, u, options};
  Identification best;
  best.model = model_from_parameters(order, Eigen::VectorXd::Zero(order.parameter_count()));
  bool found = false;
  int searches = 0;
  for (const PolynomialModel& start : prediction_error_starts(y, u, order, options)) {
    if (++searches > options.max_starts)
      break;
    Identification result = search_from(data, start);
    const bool minimum = is_minimum(result.status);
    if (!found || minimum || result.loss < best.loss)
      best = result;
    found = true;
    if (minimum)
      break;
  }
  return best;
}

Identification identify(const Eigen::Ref<const Eigen::VectorXd>& y,
                        const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                        const PredictionErrorOptions& options) {
  bool regression = order.nc == 0 && order.nd == 0;
  for (const PathOrder& path : order.inputs)
    regression = regression && path.nf == 0;
  if (!regression)
    return identify_prediction_error(y, u, order, options);
  options.validate();
  return identify_arx(y, u, order, {std::max(options.first_sample, order.memory()), options.rank_tolerance});
}

}  // namespace mpm
