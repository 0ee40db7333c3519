#include "analysis/methods/ours/input_disturbance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Ends of the size of a disturbance: the standard deviation of the static response of the CV that moves
/// most, in those of its noise.
constexpr double kSmallestMove = 0.1, kLargestMove = 1000.0;
/// The points of the first look, as shares of the ranges of the logarithms of time constant and size.
constexpr std::array kFirstTimes{0.25, 0.5, 0.8};
constexpr std::array kFirstSizes{0.1, 0.3, 0.5, 0.7, 0.9};
constexpr double kFarBehind = 40.0;   // of log L at the first look
constexpr double kLookStep = 0.4;     // of the logarithms, in the quadratic model of log L
constexpr double kLongestMove = 1.5;  // of a step of the search
constexpr int kMostMoves = 4;
constexpr double kStays = 0.1;

using LogPoint = Eigen::Vector2d;  // logarithms of time constant and size

double noise_white(const BaseNoise& noise) {
  return noise.phi == 0.0 ? 1.0 : 0.0;
}

/// log L about a point, by differences.
struct Quadratic {
  double value;
  LogPoint slope;
  Eigen::Matrix2d curvature;  ///< -d2 log L
};

template <class LogLikelihood>
Quadratic quadratic_about(const LogLikelihood& log_likelihood, const LogPoint& at) {
  const auto off = [&](double x, double y) { return log_likelihood(at + kLookStep * LogPoint(x, y)); };
  const double middle = log_likelihood(at);
  const double right = off(1.0, 0.0), left = off(-1.0, 0.0), above = off(0.0, 1.0), below = off(0.0, -1.0);
  const double mixed = off(1.0, 1.0) - right - above + middle;
  Quadratic model{middle, LogPoint(right - left, above - below) / (2.0 * kLookStep), {}};
  model.curvature << 2.0 * middle - right - left, -mixed, -mixed, 2.0 * middle - above - below;
  model.curvature /= kLookStep * kLookStep;
  return model;
}

/// The curvature, with diagonal elements of at least one over the squared width of the prior.
Eigen::Matrix2d at_least(const Eigen::Matrix2d& curvature, const LogPoint& width) {
  Eigen::Matrix2d all = curvature;
  for (Eigen::Index i = 0; i < 2; ++i)
    all(i, i) = std::max(all(i, i), 1.0 / (width(i) * width(i)));
  const double most = 0.95 * std::sqrt(all(0, 0) * all(1, 1));
  all(0, 1) = all(1, 0) = std::clamp(all(0, 1), -most, most);
  return all;
}

}  // namespace

/// The likelihood of some CVs under a disturbance on an MV.
class InputLikelihood::OfCvs {
 public:
  OfCvs(const InputLikelihood& all, const std::vector<std::size_t>& cvs, Eigen::Index mv)
      : whitening_(outputs(all, cvs, mv)) {
    for (const std::size_t cv : cvs) {
      const Eigen::MatrixXd& series = all.series_[cv];
      const auto observed = (!series.row(0).array().isNaN()).count();
      likelihoods_.push_back({all.freedom_, static_cast<double>(observed)});
      directions_.push_back(series.rows() - 1);
    }
  }

  /// log L under x(k+1) = a x(k) + b w(k), with the directions of the models, or of e alone.
  double operator()(double a, double b, bool directions) const {
    const SharedProducts sums = whitening_.products(a, b, directions);
    const Eigen::Index q = sums.products.front().rows() - 1;
    Eigen::VectorXd z = Eigen::VectorXd::Zero(q);
    double sum = 0.0;
    if (q > 0) {
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(q + 1, q + 1);
      for (const Eigen::MatrixXd& lower : sums.products)
        all += lower;
      const Eigen::LLT<Eigen::MatrixXd> inner(all.bottomRightCorner(q, q) + Eigen::MatrixXd::Identity(q, q));
      z = inner.solve(all.bottomLeftCorner(q, 1));
      sum -= inner.matrixLLT().diagonal().array().log().sum();
    }
    Eigen::VectorXd weights(q + 1);
    weights << 1.0, -z;
    Eigen::Index own = 0;
    for (std::size_t i = 0; i < likelihoods_.size(); ++i) {
      const Eigen::Index count = q > 0 ? directions_[i] : 0;
      const Eigen::VectorXd weighted = sums.products[i].selfadjointView<Eigen::Lower>() * weights;
      const double squares = weights.dot(weighted) + z.segment(own, count).squaredNorm();
      sum += likelihoods_[i](sums.log_determinant(static_cast<Eigen::Index>(i)), squares);
      own += count;
    }
    return sum;
  }

 private:
  static std::vector<SharedOutput> outputs(const InputLikelihood& all, const std::vector<std::size_t>& cvs,
                                           Eigen::Index mv) {
    std::vector<SharedOutput> outputs;
    for (const std::size_t cv : cvs) {
      const ModelErrors& model = all.models_[cv];
      const BaseNoise& noise = model.noise();
      DiscreteChannel channel =
          discretise(model.model()(0, mv).without_step_coefficients(), all.sample_time_);
      channel.c /= noise.deviation;
      channel.d /= noise.deviation;
      const bool coloured = noise.phi != 0.0;
      outputs.push_back({channel, coloured ? noise.phi : noise.a,
                         coloured ? std::sqrt(1.0 - noise.phi * noise.phi) : noise.b, noise_white(noise),
                         &all.series_[cv]});
    }
    return outputs;
  }

  SharedWhitening whitening_;
  std::vector<ScaleLikelihood> likelihoods_;
  std::vector<Eigen::Index> directions_;
};

/// The search for a disturbance on one MV, over the CVs that it moves; log L of the others is the same for
/// every disturbance.
class InputLikelihood::OfMv {
 public:
  OfMv(const InputLikelihood& all, Eigen::Index mv) : sample_time_(all.sample_time_) {
    double most = 0.0;
    Eigen::Index samples = 0;
    std::vector<std::size_t> moved;
    for (std::size_t cv = 0; cv < all.models_.size(); ++cv) {
      const ModelErrors& model = all.models_[cv];
      const TransferFunction& channel = model.model()(0, mv);
      samples = std::max(samples, all.series_[cv].cols());
      if (channel.is_zero()) {
        of_others_.e += all.unmoved_[cv].e;
        of_others_.with_directions += all.unmoved_[cv].with_directions;
        continue;
      }
      const double gain = channel.is_integrating() ? 1.0 : channel.static_gain();
      most = std::max(most, std::abs(gain) / model.noise().deviation);
      moved.push_back(cv);
    }
    if (most > 0.0)
      of_moved_.emplace(all, moved, mv);
    low_ = {std::log(sample_time_), std::log(kSmallestMove / most)};
    high_ = {std::log(std::max(2.0, 0.5 * static_cast<double>(samples)) * sample_time_),
             std::log(kLargestMove / most)};
  }

  bool moves() const { return of_moved_.has_value(); }

  /// Takes the best of a few points by e alone as the start of the search, and returns log L there.
  double first_look() {
    double best = -kInfinity;
    for (const double time : kFirstTimes)
      for (const double size : kFirstSizes) {
        const LogPoint at = low_ + LogPoint(time, size).cwiseProduct(high_ - low_);
        const double found = log_likelihood(at, false);
        if (found > best) {
          best = found;
          start_ = at;
        }
      }
    return best;
  }

  InputEvidence evidence() const {
    const auto of = [&](const LogPoint& at) { return log_likelihood(at, true); };
    LogPoint at = start_;
    Quadratic model = quadratic_about(of, at);
    for (int step = 0; step < kMostMoves; ++step) {
      LogPoint move = at_least(model.curvature, high_ - low_).llt().solve(model.slope);
      move = move.cwiseMax(-kLongestMove).cwiseMin(kLongestMove);
      const LogPoint next = (at + move).cwiseMax(low_).cwiseMin(high_);
      if ((next - at).norm() < kStays)
        break;
      const Quadratic there = quadratic_about(of, next);
      if (there.value < model.value)
        break;
      at = next;
      model = there;
    }
    const LogPoint width = high_ - low_;
    const double volume = 2.0 * std::numbers::pi / std::sqrt(at_least(model.curvature, width).determinant());
    const auto [a, b] = parameters(at);
    return {model.value + std::log(std::min(1.0, volume / (width(0) * width(1)))), a, b};
  }

 private:
  std::pair<double, double> parameters(const LogPoint& at) const {
    const double a = std::exp(-sample_time_ / std::exp(at(0)));
    return {a, std::exp(at(1)) * std::sqrt(1.0 - a * a)};
  }

  double log_likelihood(const LogPoint& at, bool directions) const {
    const auto [a, b] = parameters(at);
    return (*of_moved_)(a, b, directions) + (directions ? of_others_.with_directions : of_others_.e);
  }

  double sample_time_;
  std::optional<OfCvs> of_moved_;
  LogLikelihood of_others_;
  LogPoint low_, high_, start_ = LogPoint::Zero();
};

InputLikelihood::InputLikelihood(const std::vector<ModelErrors>& models,
                                 const std::vector<Eigen::MatrixXd>& series, double sample_time,
                                 double noise_freedom)
    : models_(models),
      series_(series),
      sample_time_(sample_time),
      freedom_(noise_freedom),
      unmoved_(models.size()) {
  for (std::size_t cv = 0; cv < models.size(); ++cv)
    for (Eigen::Index mv = 0; mv < models[cv].model().cols(); ++mv)
      if (models[cv].model()(0, mv).is_zero()) {
        const OfCvs alone(*this, {cv}, mv);
        unmoved_[cv] = {alone(0.0, 0.0, false), alone(0.0, 0.0, true)};
        break;
      }
}

std::vector<InputEvidence> InputLikelihood::of_mvs(Eigen::Index mvs) const {
  std::vector<OfMv> each;
  std::vector<double> first;
  for (Eigen::Index mv = 0; mv < mvs; ++mv) {
    each.emplace_back(*this, mv);
    first.push_back(each.back().moves() ? each.back().first_look() : -kInfinity);
  }
  const double best = first.empty() ? -kInfinity : *std::max_element(first.begin(), first.end());
  std::vector<InputEvidence> found;
  for (std::size_t mv = 0; mv < each.size(); ++mv)
    found.push_back(first[mv] > -kInfinity && first[mv] >= best - kFarBehind
                        ? each[mv].evidence()
                        : InputEvidence{-kInfinity, kNaN, kNaN});
  return found;
}

}  // namespace mpm
