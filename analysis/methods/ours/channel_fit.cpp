#include "analysis/methods/ours/channel_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include "analysis/identification/autoregression.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/chi_squared.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/transfer_matrix.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kLargestNoiseOrder = 12;
constexpr int kNoiseRounds =
    3;  ///< A and the channel in turn: the second round changes them by a few percent
constexpr double kLargestTimeFactor = 8.0;
/// The steps at which a search ends, as a share of its first steps.
constexpr double kFinestStep = 1.0 / 1024;
constexpr double kFinestEnd = 1.0 / 65536;  ///< of the end of an interval, as a share of its range
constexpr std::uintmax_t kMostEvaluations = 32;
/// The points of the grid, as shares of the ranges of the search. A share of a shift below 0 stands for no
/// shift.
constexpr std::array kTimesOfGrid{-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75};
constexpr std::array kShiftsOfGrid{0.0, 0.25, 0.5, 0.75, 1.0, -1.0};
constexpr std::array kOnsetsOfGrid{0.0, 0.25, 0.5, 0.75, 1.0};
constexpr std::array kGrowthsOfGrid{0.0, 0.5};

/// The logarithm of the time factor, the shift of the dead time, the sample at which the channel begins to
/// change, and the number of samples over which the change grows.
using Point = std::array<double, 4>;
using OfPoint = std::array<bool, 4>;
enum Number : std::size_t { kOfTime, kOfShift, kOfOnset, kOfGrowth };

/// Which numbers are searched for; the others stay those of the model.
struct Freedom {
  bool gain = true;
  OfPoint numbers{true, true, false, false};
};

Freedom freedom_of(const std::optional<MismatchParameter>& only, const FitSurroundings& beside) {
  Freedom freedom;
  if (only)
    freedom = {
        only == MismatchParameter::gain,
        {only == MismatchParameter::time_constant, only == MismatchParameter::dead_time, false, false}};
  if (beside.onset) {
    freedom.numbers[kOfOnset] = beside.onset->latest > beside.onset->earliest;
    freedom.numbers[kOfGrowth] = beside.onset->longest_growth > 0;
  }
  return freedom;
}

/// The columns about their means, which takes care of a constant.
Eigen::MatrixXd centred(Eigen::MatrixXd columns) {
  for (auto column : columns.colwise())
    column.array() -= column.mean();
  return columns;
}

class ChannelSearch {
 public:
  ChannelSearch(const TransferFunction& nominal, double sample_time, const Eigen::VectorXd& e,
                const Eigen::VectorXd& u, double u_start, const Freedom& freedom,
                const FitSurroundings& beside)
      : nominal_(nominal),
        sample_time_(sample_time),
        e_(e),
        u_(u),
        u_start_(u_start),
        freedom_(freedom),
        Z_(beside.unknown.transpose()) {
    const double record = sample_time * static_cast<double>(u.size());
    const double slowest = std::abs(nominal.residence_time());
    least_ = {-std::log(kLargestTimeFactor), -nominal.dead_time(), -1.0, 0.0};
    largest_ = {std::log(kLargestTimeFactor),
                std::min(0.25 * record, nominal.dead_time() + slowest + sample_time), -1.0, 0.0};
    if (beside.onset) {
      e_.head(beside.onset->earliest).setConstant(kNaN);
      least_[kOfOnset] = static_cast<double>(beside.onset->earliest);
      largest_[kOfOnset] = static_cast<double>(beside.onset->latest);
      largest_[kOfGrowth] = static_cast<double>(beside.onset->longest_growth);
    }
    of_model_ = response(of_model());
    take(fit_autoregression(e_ + of_model_, 0), deviation_of_steps(e_.transpose()));
  }

  /// The channel as the model has it, with its onset in the middle of the possible range.
  Point of_model() const { return {0.0, 0.0, 0.5 * (least_[kOfOnset] + largest_[kOfOnset]), 0.0}; }

  /// Fits the noise to what the channel at `point` leaves, all that is unknown beside it included. Without it
  /// the noise would lack the slow disturbances that the unknown part takes along: under the seeds 84 and 101
  /// of tests/reliability/records.py gains were closer to the truth, but only 80 % of the intervals held it.
  void fit_noise(const Point& point) {
    const Eigen::VectorXd n = target(point) - gain_at(point) * part(point).cwiseProduct(response(point));
    Autoregression noise = fit_autoregression(n, autoregression_order(n, kLargestNoiseOrder));
    const Eigen::VectorXd w = noise.whitened(n);
    take(std::move(noise), std::sqrt((w.array() - w.mean()).square().mean()));
  }

  /// Searches from the best point among a grid and `start`.
  Point best(const Point& start) const {
    Point best = start;
    double least = squares(best, {});
    const auto tried = [&](Number number, const auto& all, double otherwise) {
      return freedom_.numbers[number] ? std::vector<double>(all.begin(), all.end()) : std::vector{otherwise};
    };
    const auto within = [&](Number number, double share) {
      return least_[number] + share * (largest_[number] - least_[number]);
    };
    for (const double share_f : tried(kOfTime, kTimesOfGrid, 0.0))
      for (const double share_s : tried(kOfShift, kShiftsOfGrid, -1.0))
        for (const double share_o : tried(kOfOnset, kOnsetsOfGrid, 0.5))
          for (const double share_g : tried(kOfGrowth, kGrowthsOfGrid, 0.0)) {
            const Point point{share_f * largest_[kOfTime], share_s < 0.0 ? 0.0 : within(kOfShift, share_s),
                              within(kOfOnset, share_o), within(kOfGrowth, share_g)};
            if (const double found = squares(point, {}); found < least) {
              least = found;
              best = point;
            }
          }
    return searched(best, {}, {true, true, true, true});
  }

  /// Takes the channel to have been different since the start, unless an onset and a growth explain more by
  /// the BIC of two further numbers.
  void prefer_throughout(Point& point) {
    const Point start =
        searched({point[kOfTime], point[kOfShift], -1.0, 0.0}, {}, {true, true, false, false});
    const auto samples = static_cast<double>(whiteness_.rows.size());
    if (samples * std::log(squares(start, {}) / squares(point, {})) > 2.0 * std::log(samples))
      return;
    freedom_.numbers[kOfOnset] = freedom_.numbers[kOfGrowth] = false;
    point = start;
  }

  double gain_at(const Point& point) const { return gain_of(products_at(point)); }

  /// The sum of squares of the model without any change.
  double squares_of_model() const { return squares(of_model(), 1.0); }

  /// The least sum of squares at a point, with this factor of the gain or with the best one.
  double squares(const Point& point, std::optional<double> gain) const {
    const Eigen::Matrix2d products = products_at(point);
    const double g = gain.value_or(gain_of(products));
    return products(0, 0) - 2.0 * g * products(0, 1) + g * g * products(1, 1);
  }

  /// A pattern search (Hooke and Jeeves 1961) from `start` over those numbers that are free.
  Point searched(Point point, std::optional<double> gain, const OfPoint& is_free) const {
    Point step{0.125 * largest_[kOfTime], 0.0, 0.0, 0.0};
    for (const std::size_t number : {kOfShift, kOfOnset, kOfGrowth})
      step[number] = 0.125 * (largest_[number] - least_[number]);
    double least = squares(point, gain);
    for (double share = 1.0; share >= kFinestStep;) {
      bool better = false;
      for (std::size_t number = 0; number < point.size(); ++number)
        for (const double direction : {-1.0, 1.0}) {
          if (!is_free[number] || !freedom_.numbers[number])
            continue;
          Point trial = point;
          trial[number] =
              std::clamp(point[number] + direction * share * step[number], least_[number], largest_[number]);
          if (const double found = squares(trial, gain); found < least) {
            least = found;
            point = trial;
            better = true;
          }
        }
      if (!better)
        share *= 0.5;
    }
    return point;
  }

  const Point& least() const { return least_; }
  const Point& largest() const { return largest_; }
  const Autoregression& whiteness() const { return whiteness_; }

 private:
  double gain_of(const Eigen::Matrix2d& products) const {
    return freedom_.gain ? products(0, 1) / products(1, 1) : 1.0;
  }

  void take(Autoregression noise, double deviation) {
    whiteness_ = std::move(noise);
    deviation_ = deviation;
    if (Z_.cols() == 0)
      return;
    W_ = centred(whiteness_.whitened(Z_)) / deviation;
    inner_.compute(W_.transpose() * W_ + Eigen::MatrixXd::Identity(W_.cols(), W_.cols()));
  }

  /// r, the part of the channel that has changed.
  Eigen::VectorXd part(const Point& point) const {
    Eigen::VectorXd part(u_.size());
    for (Eigen::Index k = 0; k < part.size(); ++k)
      part(k) =
          std::clamp((static_cast<double>(k) - point[kOfOnset]) / std::max(point[kOfGrowth], 1.0), 0.0, 1.0);
    return part;
  }

  /// e + r (G0 u)
  Eigen::VectorXd target(const Point& point) const { return e_ + part(point).cwiseProduct(of_model_); }

  /// The response of the channel at a point. It is kept, since most points of a search differ in the onset
  /// only.
  const Eigen::VectorXd& response(const Point& point) const {
    if (response_.size() == 0 || responds_[kOfTime] != point[kOfTime] ||
        responds_[kOfShift] != point[kOfShift]) {
      const TransferFunction channel =
          nominal_.with_time_scaled(std::exp(point[kOfTime])).with_dead_time_shifted(point[kOfShift]);
      response_ =
          simulated_output(TransferMatrix{{channel}}, sample_time_, Eigen::VectorXd::Constant(1, u_start_),
                           u_.transpose(), Eigen::MatrixXd(0, u_.size()))
              .row(0);
      responds_ = point;
    }
    return response_;
  }

  /// Products of the target and the response with each other, both behind A(q) and about their means, under
  /// I + W W': with w such a signal, w' (I + W W')^-1 w = w' w - (W' w)' (I + W' W)^-1 W' w.
  Eigen::Matrix2d products_at(const Point& point) const {
    Eigen::MatrixXd both(u_.size(), 2);
    both << target(point), part(point).cwiseProduct(response(point));
    const Eigen::MatrixXd white = centred(whiteness_.whitened(both));
    Eigen::Matrix2d products = white.transpose() * white;
    if (Z_.cols() > 0) {
      const Eigen::MatrixXd Ww = W_.transpose() * white;
      products -= Ww.transpose() * inner_.solve(Ww);
    }
    return products;
  }

  const TransferFunction& nominal_;
  double sample_time_;
  Eigen::VectorXd e_;
  const Eigen::VectorXd& u_;
  double u_start_;
  Freedom freedom_;
  Eigen::MatrixXd Z_;         ///< N x q
  Eigen::VectorXd of_model_;  ///< G0 u
  Point least_{}, largest_{};
  Autoregression whiteness_;
  double deviation_ = 1.0;             ///< of w
  Eigen::MatrixXd W_;                  ///< Z behind A(q), about its mean, in deviations of w
  Eigen::LLT<Eigen::MatrixXd> inner_;  ///< I + W' W
  mutable Eigen::VectorXd response_;   ///< of the channel at `responds_`; empty: of none yet
  mutable Point responds_{};
};

/// The end of an interval, between `inside`, where `excess` is `of_inside` and below 0, and `bound`. It is
/// the bound if `excess` is not above 0 there either. Algorithm 748 of Alefeld, Potra and Shi (1995).
double interval_end(double inside, double of_inside, double bound,
                    const std::function<double(double)>& excess) {
  const double of_bound = excess(bound);
  if (of_bound <= 0.0)
    return bound;
  const bool rises = bound > inside;
  const double width = std::abs(bound - inside);
  std::uintmax_t steps = kMostEvaluations;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, rises ? inside : bound, rises ? bound : inside, rises ? of_inside : of_bound,
      rises ? of_bound : of_inside, [width](double a, double b) { return b - a <= kFinestEnd * width; },
      steps);
  return rises ? high : low;
}

/// A bound of the gain that lies outside of its interval.
double outer_gain(double gain, double direction, const std::function<double(double)>& excess) {
  double width = 0.01 * (1.0 + std::abs(gain));
  while (excess(gain + direction * width) <= 0.0 && width < 1e3)
    width *= 2.0;
  return gain + direction * width;
}

}  // namespace

bool is_fitted_alone(MismatchParameter parameter) {
  return parameter == MismatchParameter::gain || parameter == MismatchParameter::time_constant ||
         parameter == MismatchParameter::dead_time;
}

ChannelFit fit_channel(const TransferFunction& nominal, double sample_time,
                       const Eigen::Ref<const Eigen::VectorXd>& e, const Eigen::Ref<const Eigen::VectorXd>& u,
                       double u_start, double confidence, const std::optional<MismatchParameter>& only,
                       const FitSurroundings& beside) {
  require_confidence(confidence);
  if (nominal.is_zero())
    throw InputError("channel", "one that is zero in the model", "a channel of the model");
  if ((u.array() == u(0)).all())
    throw InputError("MV of the channel", "one that does not move", "an MV that moves");
  const Eigen::VectorXd errors = e, moves = u;
  const Freedom freedom = freedom_of(only, beside);
  ChannelSearch search(nominal, sample_time, errors, moves, u_start, freedom, beside);
  // The first search takes the noise to be white: an autoregression of all that the model leaves would take
  // the mismatch for noise, and the search would end close to the model.
  Point point = search.best(search.of_model());
  for (int round = 0; round < kNoiseRounds; ++round) {
    search.fit_noise(point);
    point = search.best(point);
  }
  if (beside.onset && beside.onset->earliest == 0)
    search.prefer_throughout(point);
  const double gain = search.gain_at(point);
  const double least = search.squares(point, gain);
  const auto samples = static_cast<double>(search.whiteness().rows.size());
  const double limit = chi_squared_quantile(confidence, 1.0) * beside.widening * beside.widening;
  const auto excess = [&](double squares) { return samples * std::log(squares / least) - limit; };
  const auto of_gain = [&](double value) {
    return excess(search.squares(search.searched(point, value, {true, true, true, true}), value));
  };
  const auto of_number = [&](std::size_t number) {
    return [&, number](double value) {
      Point fixed = point;
      fixed[number] = value;
      OfPoint others{true, true, true, true};
      others[number] = false;
      return excess(search.squares(search.searched(fixed, {}, others), {}));
    };
  };
  const auto end = [&](std::size_t number, double bound) {
    return freedom.numbers[number] && beside.asks_intervals
               ? interval_end(point[number], -limit, bound, of_number(number))
               : point[number];
  };
  const auto gain_end = [&](double direction) {
    return freedom.gain && beside.asks_intervals
               ? interval_end(gain, -limit, outer_gain(gain, direction, of_gain), of_gain)
               : gain;
  };
  const auto bound_of_number = [&](std::size_t number) {
    return bound_within(point[number], search.least()[number], search.largest()[number]);
  };
  // At its lower end the dead time is 0, and there is nothing beyond.
  const SizeBound bound_of_time = bound_of_number(kOfTime), bound_of_shift = bound_of_number(kOfShift);
  const FittedNumber gain_factor{gain, gain_end(-1.0), gain_end(1.0)};
  return {.gain_factor = gain_factor,
          .time_factor = {std::exp(point[kOfTime]), std::exp(end(kOfTime, search.least()[kOfTime])),
                          std::exp(end(kOfTime, search.largest()[kOfTime])), bound_of_time},
          .dead_time_shift = {point[kOfShift], end(kOfShift, search.least()[kOfShift]),
                              end(kOfShift, search.largest()[kOfShift]),
                              bound_of_shift == SizeBound::at_most ? SizeBound::none : bound_of_shift},
          .noise_order = search.whiteness().order(),
          .explained = std::max(0.0, 1.0 - least / search.squares_of_model()),
          .channel = nominal.with_gain_scaled(gain)
                         .with_time_scaled(std::exp(point[kOfTime]))
                         .with_dead_time_shifted(point[kOfShift])};
}

}  // namespace mpm
