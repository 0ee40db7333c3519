#include "analysis/methods/literature/channel_regressors.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/discrete_filter.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/transfer_matrix.hpp"

namespace mpm {
namespace {

constexpr double kLargestPole = 0.98;
constexpr double kIntegratingPole = 0.9;
constexpr double kTimeDifference = 0.05;  ///< share of the time constants

double filter_pole(const TransferFunction& channel, double sample_time) {
  if (channel.is_integrating())
    return kIntegratingPole;
  const double time = channel.washout() > 0.0 ? channel.washout() : channel.residence_time();
  return time > 0.0 ? std::min(kLargestPole, std::exp(-sample_time / time)) : 0.0;
}

}  // namespace

Eigen::MatrixXd channel_filters(const TransferFunction& channel, double sample_time,
                                const Eigen::Ref<const Eigen::VectorXd>& input) {
  if (channel.is_zero() || input.size() == 0)
    return Eigen::MatrixXd(input.size(), 0);
  const double a = filter_pole(channel, sample_time);
  const auto whole_samples = static_cast<Eigen::Index>(std::floor(channel.dead_time() / sample_time));
  const Eigen::Vector2d denominator(1.0, -a);
  const Eigen::VectorXd deviation = input.array() - input(0);
  Eigen::MatrixXd responses(input.size(), kChannelFilters);
  responses.col(0) = filter(Eigen::VectorXd::Constant(1, std::sqrt(1.0 - a * a)), denominator, deviation,
                            std::max<Eigen::Index>(1, whole_samples));
  for (Eigen::Index i = 1; i < kChannelFilters; ++i)
    responses.col(i) = filter(Eigen::Vector2d(-a, 1.0), denominator, responses.col(i - 1));
  return responses;
}

double channel_filter_gain(const TransferFunction& channel, double sample_time) {
  const double a = filter_pole(channel, sample_time);
  return std::sqrt((1.0 + a) / (1.0 - a));
}

Eigen::MatrixXd channel_gradients(const TransferFunction& channel, double sample_time,
                                  const Eigen::Ref<const Eigen::VectorXd>& input) {
  if (channel.is_zero() || input.size() == 0)
    return Eigen::MatrixXd(input.size(), 0);
  const auto response = [&](const TransferFunction& changed) {
    return channel_response(changed, sample_time, input);
  };
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(input.size(), kChannelGradients);
  gradients.col(0) = response(channel);
  if (channel.has_time_constant())
    gradients.col(1) = (response(channel.with_time_scaled(1.0 + kTimeDifference)) -
                        response(channel.with_time_scaled(1.0 - kTimeDifference))) /
                       (2.0 * kTimeDifference);
  const double later = 0.5 * sample_time;
  const double earlier = std::min(later, channel.dead_time());
  gradients.col(2) =
      (response(channel.with_dead_time_shifted(later)) - response(channel.with_dead_time_shifted(-earlier))) /
      (later + earlier);
  return gradients;
}

Eigen::VectorXd channel_response(const TransferFunction& channel, double sample_time,
                                 const Eigen::Ref<const Eigen::VectorXd>& input) {
  TransferMatrix G(1, 1);
  G(0, 0) = channel;
  const Eigen::RowVectorXd deviation = (input.array() - input(0)).matrix().transpose();
  return simulate(G, sample_time, deviation).transpose();
}

Eigen::MatrixXd inputs_until(const AssessedLoop& loop) {
  const AssessedLoop& whole = loop.from_start();
  const Eigen::Index end = loop.first + loop.samples();
  Eigen::MatrixXd inputs(whole.u.rows() + whole.d.rows(), end);
  inputs << whole.u.leftCols(end), whole.d.leftCols(end);
  return inputs;
}

}  // namespace mpm
