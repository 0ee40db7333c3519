#include "analysis/methods/literature/model_quality.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

void require_shapes(const Matrix& y, const Matrix& y_sim, const Eigen::Ref<const Eigen::VectorXd>& weight,
                    const std::vector<NoiseModel>& G_d0) {
  if (y.rows() != y_sim.rows() || y.cols() != y_sim.cols())
    throw InputError("y_sim", fmt::format("{} x {}", y_sim.rows(), y_sim.cols()),
                     fmt::format("{} x {}, as y", y.rows(), y.cols()));
  if (!y_sim.allFinite())
    throw InputError("y_sim", "a value that is not finite", "finite values only");
  if (weight.size() != y.rows())
    throw InputError("weights of the CVs", fmt::format("{}", weight.size()), fmt::format("{}", y.rows()));
  if (!weight.allFinite() || (weight.array() < 0.0).any())
    throw InputError("weights of the CVs", "one below 0 or not finite", "0 or more");
  if (static_cast<Eigen::Index>(G_d0.size()) != y.rows())
    throw InputError("noise models", fmt::format("{}", G_d0.size()), fmt::format("{}", y.rows()));
}

double ratio(double numerator, double denominator) {
  return denominator > 0.0 ? numerator / denominator : kNaN;
}

}  // namespace

void ModelQualityOptions::validate() const {
  arx.validate();
}

ModelQuality model_quality(const Matrix& y, const Matrix& r, const Matrix& y_sim,
                           const Eigen::Ref<const Eigen::VectorXd>& weight,
                           const std::vector<NoiseModel>& G_d0, const ModelQualityOptions& options) {
  require_shapes(y, y_sim, weight, G_d0);
  const HighOrderArx arx = identify_high_order_arx(y, r, options.arx);
  const Eigen::Index n = arx.e_d.cols();
  ModelQuality result;
  result.first_sample = arx.first_sample;
  result.orders = arx.orders;
  result.parameters = arx.parameters;
  result.disturbance = arx.e_d.rowwise().squaredNorm();
  result.prediction.resize(y.rows());
  result.imqi.resize(y.rows());
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const auto cv = static_cast<std::size_t>(i);
    const Eigen::VectorXd measured = y.row(i).transpose();
    result.prediction(i) =
        one_step_errors(G_d0[cv], measured, y_sim.row(i).transpose()).tail(n).squaredNorm();
    if (result.prediction(i) <= static_cast<double>(n) * variance_floor(measured)) {
      result.prediction(i) = 0.0;
      result.status = ModelQualityStatus::error_free;
    }
    if (options.correct_for_parameters)
      result.disturbance(i) *= static_cast<double>(n) / static_cast<double>(n - arx.parameters[cv]);
    result.imqi(i) = std::sqrt(ratio(result.disturbance(i), result.prediction(i)));
  }
  result.mqi = ratio(weight.dot(result.disturbance), weight.dot(result.prediction));
  return result;
}

}  // namespace mpm
