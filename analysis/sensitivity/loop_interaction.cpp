#include "analysis/sensitivity/loop_interaction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

#include "analysis/sensitivity/relative_gain.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// Returns the MVs that are not held at a limit.
std::vector<Eigen::Index> available_mvs(const Study& study, const OperatingPoint& point) {
  std::vector<Eigen::Index> mvs;
  for (Eigen::Index j = 0; j < study.mv_count(); ++j)
    if (std::find(point.fixed_mvs.begin(), point.fixed_mvs.end(), j) == point.fixed_mvs.end())
      mvs.push_back(j);
  return mvs;
}

Eigen::VectorXd logarithmic_grid(double lower, double upper, Eigen::Index count) {
  return Eigen::ArrayXd::LinSpaced(count, std::log(lower), std::log(upper)).exp();
}

Eigen::MatrixXd relative_gain_magnitudes(const TransferMatrix& G, const LoopInteraction& of,
                                         double frequency) {
  const Eigen::MatrixXcd response = G.frequency_response({0.0, frequency});
  return relative_gains(response(of.cvs, of.mvs)).cwiseAbs();
}

/// Returns the places of the values above their neighbours; of equal values, the first. There is at least
/// one.
std::vector<Eigen::Index> local_maxima(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const bool rises = i == 0 || values(i) > values(i - 1);
    const bool falls = i + 1 == values.size() || values(i) >= values(i + 1);
    if (rises && falls)
      found.push_back(i);
  }
  return found;
}

/// Returns the w near entry `at` of the grid at which `weight` is largest.
double refined_maximum(const Eigen::VectorXd& grid, Eigen::Index at, const auto& weight) {
  const double lower = std::log(grid(std::max<Eigen::Index>(at - 1, 0)));
  const double upper = std::log(grid(std::min(at + 1, grid.size() - 1)));
  constexpr int kBits = 20;  // of log w: six digits are enough, as a maximum is flat
  const auto negative = [&](double log_frequency) { return -weight(std::exp(log_frequency)); };
  const double refined = std::exp(boost::math::tools::brent_find_minima(negative, lower, upper, kBits).first);
  return weight(refined) > weight(grid(at)) ? refined : grid(at);
}

/// Returns whether the numbers of T0 are so small that their sums and products are finite. An archive may
/// hold other numbers, and its remaining content must still be reported.
bool has_weight(const NominalSensitivity& sensitivity) {
  const double largest = 1e100;
  return std::all_of(sensitivity.step_response.begin(), sensitivity.step_response.end(),
                     [largest](const Eigen::MatrixXd& response) {
                       return (response.array().abs() < largest).all();  // false for NaN
                     });
}

}  // namespace

Eigen::MatrixXcd active_frequency_response(const NominalSensitivity& sensitivity, double frequency,
                                           double sample_time) {
  if (!(frequency >= 0.0))
    throw InputError("frequency", fmt::format("{}", frequency), "0 or more");
  if (!(sample_time > 0.0))
    throw InputError("sample time", fmt::format("{}", sample_time), "above 0");
  const auto m = static_cast<Eigen::Index>(sensitivity.active.size());
  Eigen::MatrixXcd T0 = Eigen::MatrixXcd::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Eigen::MatrixXd& step = sensitivity.step_response[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index cv = sensitivity.active[static_cast<std::size_t>(i)].cv;
      double before = 0.0;
      for (Eigen::Index l = 0; l < step.cols(); ++l) {
        const double angle = -frequency * sample_time * static_cast<double>(l + 1);
        T0(i, j) += std::polar(1.0, angle) * (step(cv, l) - before);
        before = step(cv, l);
      }
    }
  }
  return T0;
}

LoopInteraction loop_interaction(const Study& study, const OperatingPoint& point,
                                 const NominalSensitivity& sensitivity, Eigen::Index count) {
  if (count < 2)
    throw InputError("number of frequencies", fmt::format("{}", count), "2 or more");
  LoopInteraction result;
  for (const ActiveConstraint& reference : sensitivity.active)
    result.cvs.push_back(reference.cv);
  if (result.cvs.empty() || sensitivity.step_response.front().cols() == 0 || !has_weight(sensitivity))
    return result;
  const double sample_time = study.controller.sample_time;
  const auto samples = static_cast<double>(sensitivity.step_response.front().cols());
  const auto weight = [&](double frequency) {
    return rpn_weight(active_frequency_response(sensitivity, frequency, sample_time));
  };
  result.frequency = logarithmic_grid(0.2 * std::numbers::pi / (samples * sample_time),
                                      std::numbers::pi / sample_time, count);
  result.rpn = result.frequency.unaryExpr(weight);
  for (const Eigen::Index at : local_maxima(result.rpn)) {
    const double frequency = refined_maximum(result.frequency, at, weight);
    result.peaks.push_back({frequency, weight(frequency)});
  }
  const auto largest = best_candidate(result.peaks, &LoopInteraction::Peak::rpn);
  if (largest == result.peaks.end())
    return {};
  result.rpn_frequency = largest->frequency;
  result.rpn_maximum = largest->rpn;

  const std::vector<Eigen::Index> mvs = available_mvs(study, point);
  if (mvs.size() != result.cvs.size())
    return result;
  result.mvs = mvs;
  result.relative_gain_at_maximum = relative_gain_magnitudes(study.plant.G, result, result.rpn_frequency);
  if (!result.relative_gain_at_maximum.allFinite()) {
    result.mvs.clear();
    result.relative_gain_at_maximum.resize(0, 0);
    return result;
  }
  for (const double frequency : result.frequency)
    result.relative_gain.push_back(relative_gain_magnitudes(study.plant.G, result, frequency));
  return result;
}

}  // namespace mpm
