#include "analysis/methods/literature/plant_model_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "analysis/methods/literature/channel_regressors.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

constexpr double kImpulseTimes = 30.0;  ///< residence times after which an impulse response has died down

/// sum_k h(k) e^(-jwkTs) for an impulse response h.
std::complex<double> sampled_response(const Eigen::VectorXd& impulse_response, double angle) {
  std::complex<double> sum = 0.0;
  for (Eigen::Index k = 0; k < impulse_response.size(); ++k)
    sum += impulse_response(k) * std::polar(1.0, -angle * static_cast<double>(k));
  return sum;
}

}  // namespace

Eigen::VectorXcd plant_model_ratio(const TransferFunction& channel, double sample_time,
                                   const Eigen::Ref<const Eigen::VectorXd>& coefficients,
                                   const Eigen::Ref<const Eigen::VectorXd>& frequencies) {
  if (channel.is_zero() || channel.is_integrating())
    throw InputError("channel of a plant-model ratio", "one without a static gain", "one that settles");
  if (coefficients.size() != kChannelFilters)
    throw InputError("coefficients of a plant-model ratio", fmt::format("{}", coefficients.size()),
                     fmt::format("{}", kChannelFilters));
  const double times = kImpulseTimes * std::max(channel.residence_time(), sample_time) + channel.dead_time();
  // Inputs count as deviations from their first sample, so the impulse is at the second sample, for all
  // responses.
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(2 + static_cast<Eigen::Index>(times / sample_time));
  impulse(1) = 1.0;
  const Eigen::VectorXd of_model = channel_response(channel, sample_time, impulse);
  const Eigen::VectorXd of_filters = channel_filters(channel, sample_time, impulse) * coefficients;
  Eigen::VectorXcd ratio(frequencies.size());
  for (Eigen::Index i = 0; i < frequencies.size(); ++i) {
    const double angle = frequencies(i) * sample_time;
    ratio(i) = 1.0 + sampled_response(of_filters, angle) / sampled_response(of_model, angle);
  }
  return ratio;
}

RatioSignature ratio_signature(const TransferFunction& channel, double sample_time,
                               const Eigen::Ref<const Eigen::VectorXd>& coefficients) {
  const double time = channel.is_integrating() ? sample_time : channel.residence_time() + channel.dead_time();
  const double fastest = 0.5 * std::numbers::pi / sample_time;
  const Eigen::Vector2d frequencies(std::min(kLowFrequency / std::max(time, sample_time), fastest),
                                    std::min(kHighFrequency / std::max(time, sample_time), fastest));
  const Eigen::VectorXcd ratio = plant_model_ratio(channel, sample_time, coefficients, frequencies);
  const double magnitude = std::abs(ratio(0));
  return {magnitude, std::abs(ratio(1)) / magnitude, -std::arg(ratio(1)) / frequencies(1)};
}

}  // namespace mpm
