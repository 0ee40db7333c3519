#include "analysis/methods/ours/sticky_valve_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/disturbance_scan.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/valve_stem.hpp"

namespace mpm {
namespace {

/// S over what the MV moves, J over S, and the onset over the record, where the search begins. Without a jump
/// and with one of half or all of S the loops differ in kind.
constexpr std::array kStickbands{0.02, 0.05, 0.1, 0.2, 0.4};
constexpr std::array kJumps{0.0, 0.5, 1.0};
constexpr std::array kOnsets{0.0, 1.0 / 3.0, 2.0 / 3.0};
constexpr double kFinest = 0.02;   // of a step of the search
constexpr double kParameters = 3;  // S, J and the onset

/// log S over what the MV moves, J over S, onset over the record.
using Valve = Eigen::Vector3d;

/// The errors of one CV, whitened once.
class WhitenedErrors {
 public:
  WhitenedErrors(const ModelErrors& model, const Eigen::MatrixXd& series, double noise_freedom)
      : models_(base_models(model.noise(), false).models),
        e_(series.row(0)),
        likelihood_{noise_freedom, static_cast<double>((!e_.array().isNaN()).count())} {
    const Eigen::MatrixXd white = whitened(models_, series, log_determinant_);
    white_ = white.row(0);
    Z_ = white.bottomRows(white.rows() - 1);
    inner_.compute(Z_ * Z_.transpose() + Eigen::MatrixXd::Identity(Z_.rows(), Z_.rows()));
    log_determinant_ += 2.0 * inner_.matrixLLT().diagonal().array().log().sum();
  }

  double samples() const { return likelihood_.samples; }

  /// With this response, in standard deviations of the noise, taken out of the errors.
  double log_likelihood(const Eigen::RowVectorXd& response) const {
    Eigen::MatrixXd both(2, e_.size());
    both << e_, response;
    double unused = 0.0;
    const Eigen::RowVectorXd left = white_ - whitened(models_, both, unused).row(1);
    const Eigen::VectorXd with_Z = Z_ * left.transpose();
    const double squares = left.squaredNorm() - with_Z.dot(inner_.solve(with_Z));
    return likelihood_(log_determinant_, squares);
  }

 private:
  NoiseModels models_;
  Eigen::RowVectorXd e_, white_;
  ScaleLikelihood likelihood_;
  double log_determinant_ = 0.0;
  Eigen::MatrixXd Z_;
  Eigen::LLT<Eigen::MatrixXd> inner_;
};

/// The valve of one MV.
class ValveSearch {
 public:
  ValveSearch(const std::vector<ModelErrors>& models, const std::vector<WhitenedErrors>& errors,
              const Eigen::Ref<const Eigen::RowVectorXd>& u, double initial, Eigen::Index mv,
              double sample_time)
      : errors_(errors), u_(u), initial_(initial), range_(u.maxCoeff() - u.minCoeff()) {
    for (std::size_t i = 0; i < models.size(); ++i) {
      const TransferFunction& channel = models[i].model()(0, mv);
      channels_.push_back(channel.is_zero() ? std::optional<DiscreteChannel>()
                                            : discretise(channel, sample_time));
      deviations_.push_back(models[i].noise().deviation);
      if (channels_.back())
        samples_ += errors[i].samples();
      else
        unmoved_ += errors[i].log_likelihood(Eigen::RowVectorXd::Zero(u_.size()));
    }
  }

  double log_evidence() const {
    if (samples_ == 0.0 || !(range_ > 0.0))
      return -kInfinity;
    Valve best = Valve::Zero();
    double most = -kInfinity;
    const auto take = [&](const Valve& valve) {
      const double found = log_likelihood(valve);
      if (!(found > most))
        return false;
      most = found;
      best = valve;
      return true;
    };
    for (const double stickband : kStickbands)
      for (const double jump : kJumps)
        for (const double onset : kOnsets)
          take({std::log(stickband), jump, onset});
    // A pattern search (Hooke and Jeeves 1961).
    for (double share = 1.0; share > kFinest;) {
      bool better = false;
      for (Eigen::Index number = 0; number < best.size(); ++number)
        for (const double direction : {-1.0, 1.0}) {
          Valve trial = best;
          trial(number) += direction * share * kStep(number);
          trial(1) = std::clamp(trial(1), 0.0, 1.0);
          trial(2) = std::clamp(trial(2), 0.0, 1.0);
          better = take(trial) || better;
        }
      if (!better)
        share *= 0.5;
    }
    return most - 0.5 * kParameters * std::log(samples_);
  }

 private:
  inline static const Valve kStep{0.5, 0.25, 0.15};

  double log_likelihood(const Valve& valve) const {
    const double stickband = range_ * std::exp(valve(0));
    const auto onset = static_cast<Eigen::Index>(valve(2) * static_cast<double>(u_.size()));
    Eigen::RowVectorXd x = Eigen::RowVectorXd::Zero(u_.size());
    StickyValve stem(stickband, valve(1) * stickband, onset > 0 ? u_(onset - 1) : initial_);
    for (Eigen::Index k = onset; k < u_.size(); ++k)
      x(k) = stem.follow(u_(k)) - u_(k);
    double sum = unmoved_;
    for (std::size_t i = 0; i < errors_.size(); ++i)
      if (channels_[i])
        sum += errors_[i].log_likelihood(channel_response(*channels_[i], x, 0.0) / deviations_[i]);
    return sum;
  }

  const std::vector<WhitenedErrors>& errors_;
  Eigen::RowVectorXd u_;
  double initial_, range_, samples_ = 0.0;
  double unmoved_ = 0.0;  ///< log-likelihood of the CVs that the MV does not move
  std::vector<std::optional<DiscreteChannel>> channels_;
  std::vector<double> deviations_;
};

}  // namespace

std::vector<double> valve_log_evidence(const std::vector<ModelErrors>& models,
                                       const std::vector<Eigen::MatrixXd>& series,
                                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                       const Eigen::Ref<const Eigen::VectorXd>& initial, Eigen::Index mvs,
                                       double sample_time, double noise_freedom) {
  std::vector<WhitenedErrors> errors;
  for (std::size_t i = 0; i < models.size(); ++i)
    errors.emplace_back(models[i], series[i], noise_freedom);
  std::vector<double> found;
  for (Eigen::Index mv = 0; mv < mvs; ++mv)
    found.push_back(
        ValveSearch(models, errors, inputs.row(mv).head(series.front().cols()), initial(mv), mv, sample_time)
            .log_evidence());
  return found;
}

}  // namespace mpm
