#include "analysis/methods/ours/channel_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "analysis/identification/autoregression.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
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
/// Steps at which a search ends, as shares of the first ones.
constexpr double kFinestStep = 1.0 / 1024;
constexpr int kBisections = 16;

/// The logarithm of the time factor, and the shift of the dead time.
using Point = std::array<double, 2>;

/// Which numbers of the channel are looked for; the others are those of the model.
struct Freedom {
  bool gain = true;
  std::array<bool, 2> numbers{true, true};  ///< of a Point
};

Freedom freedom_of(const std::optional<MismatchParameter>& only) {
  if (only == MismatchParameter::gain)
    return {true, {false, false}};
  if (only == MismatchParameter::time_constant)
    return {false, {true, false}};
  if (only == MismatchParameter::dead_time)
    return {false, {false, true}};
  return {};
}

class ChannelSearch {
 public:
  ChannelSearch(const TransferFunction& nominal, double sample_time, const Eigen::VectorXd& e,
                const Eigen::VectorXd& u, double u_start, const Freedom& freedom)
      : nominal_(nominal), sample_time_(sample_time), u_(u), u_start_(u_start), freedom_(freedom) {
    z_ = e + response({0.0, 0.0});
    whiteness_ = fit_autoregression(z_, 0);
    const double record = sample_time * static_cast<double>(u.size());
    const double slowest = std::abs(nominal.residence_time());
    least_ = {-std::log(kLargestTimeFactor), -nominal.dead_time()};
    largest_ = {std::log(kLargestTimeFactor),
                std::min(0.25 * record, nominal.dead_time() + slowest + sample_time)};
  }

  /// Fits the noise to what the channel at `point` leaves.
  void fit_noise(const Point& point) {
    const Eigen::VectorXd n = z_ - gain_at(point) * response(point);
    whiteness_ = fit_autoregression(n, autoregression_order(n, kLargestNoiseOrder));
  }

  /// The best point of a grid and `start`, and what a search finds from there.
  Point best(const Point& start) const {
    Point best = start;
    double least = squares(best, {});
    for (const double share_f : {-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75})
      for (const double share_s : {0.0, 0.25, 0.5, 0.75, 1.0, -1.0}) {
        const Point point{
            freedom_.numbers[0] ? share_f * largest_[0] : 0.0,
            share_s < 0.0 || !freedom_.numbers[1] ? 0.0 : least_[1] + share_s * (largest_[1] - least_[1])};
        if (const double found = squares(point, {}); found < least) {
          least = found;
          best = point;
        }
      }
    return searched(best, {}, {true, true});
  }

  double gain_at(const Point& point) const { return gain_of(whitened(point)); }

  /// The sum of squares of the model without any change.
  double squares_of_model() const { return squares({0.0, 0.0}, 1.0); }

  /// The least sum of squares at a point, with this factor of the gain or with the best one.
  double squares(const Point& point, std::optional<double> gain) const {
    const Whitened white = whitened(point);
    return (white.z - gain.value_or(gain_of(white)) * white.x).squaredNorm();
  }

  /// A pattern search (Hooke and Jeeves 1961) from `start` over those numbers that are free.
  Point searched(Point point, std::optional<double> gain, const std::array<bool, 2>& is_free) const {
    Point step{0.125 * largest_[0], 0.125 * (largest_[1] - least_[1])};
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
  struct Whitened {
    Eigen::VectorXd z, x;
  };

  double gain_of(const Whitened& white) const {
    return freedom_.gain ? white.x.dot(white.z) / white.x.squaredNorm() : 1.0;
  }

  Eigen::VectorXd response(const Point& point) const {
    const TransferFunction channel =
        nominal_.with_time_scaled(std::exp(point[0])).with_dead_time_shifted(point[1]);
    return simulated_output(TransferMatrix{{channel}}, sample_time_, Eigen::VectorXd::Constant(1, u_start_),
                            u_.transpose(), Eigen::MatrixXd(0, u_.size()))
        .row(0);
  }

  /// Both sides behind A(q), about their means, which takes care of c.
  Whitened whitened(const Point& point) const {
    Eigen::MatrixXd both(z_.size(), 2);
    both << z_, response(point);
    const Eigen::MatrixXd white = whiteness_.whitened(both);
    return {white.col(0).array() - white.col(0).mean(), white.col(1).array() - white.col(1).mean()};
  }

  const TransferFunction& nominal_;
  double sample_time_;
  const Eigen::VectorXd& u_;
  double u_start_;
  Freedom freedom_;
  Eigen::VectorXd z_;
  Point least_, largest_;
  Autoregression whiteness_;
};

/// The end of an interval: between `inside`, where `excess` is not above 0, and `bound`; the bound where it
/// is not above 0 there either.
double interval_end(double inside, double bound, const std::function<double(double)>& excess) {
  if (excess(bound) <= 0.0)
    return bound;
  double outside = bound;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (inside + outside);
    (excess(middle) <= 0.0 ? inside : outside) = middle;
  }
  return outside;
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
                       double u_start, double confidence, const std::optional<MismatchParameter>& only) {
  require_confidence(confidence);
  if (nominal.is_zero())
    throw InputError("channel", "one that is zero in the model", "a channel of the model");
  if ((u.array() == u(0)).all())
    throw InputError("MV of the channel", "one that does not move", "an MV that moves");
  const Eigen::VectorXd errors = e, moves = u;
  const Freedom freedom = freedom_of(only);
  ChannelSearch search(nominal, sample_time, errors, moves, u_start, freedom);
  // First as if the noise were white: an autoregression of all that the model leaves would take the mismatch
  // for noise, and the search would end where that is nearly true.
  Point point = search.best({0.0, 0.0});
  for (int round = 0; round < kNoiseRounds; ++round) {
    search.fit_noise(point);
    point = search.best(point);
  }
  const double gain = search.gain_at(point);
  const double least = search.squares(point, gain);
  const auto samples = static_cast<double>(search.whiteness().rows.size());
  const double limit = boost::math::quantile(boost::math::chi_squared_distribution<>(1.0), confidence);
  const auto excess = [&](double squares) { return samples * std::log(squares / least) - limit; };
  const auto of_gain = [&](double value) {
    return excess(search.squares(search.searched(point, value, {true, true}), value));
  };
  const auto of_number = [&](std::size_t number) {
    return [&, number](double value) {
      Point fixed = point;
      fixed[number] = value;
      return excess(search.squares(search.searched(fixed, {}, {number != 0, number != 1}), {}));
    };
  };
  const auto end = [&](std::size_t number, double bound) {
    return freedom.numbers[number] ? interval_end(point[number], bound, of_number(number)) : point[number];
  };
  const auto gain_end = [&](double direction) {
    return freedom.gain ? interval_end(gain, outer_gain(gain, direction, of_gain), of_gain) : gain;
  };
  const auto bound_of_number = [&](std::size_t number) {
    return bound_within(point[number], search.least()[number], search.largest()[number]);
  };
  // At its lower end the dead time is 0, and there is nothing beyond.
  const SizeBound bound_of_time = bound_of_number(0), bound_of_shift = bound_of_number(1);
  const FittedNumber gain_factor{gain, gain_end(-1.0), gain_end(1.0)};
  return {.gain_factor = gain_factor,
          .time_factor = {std::exp(point[0]), std::exp(end(0, search.least()[0])),
                          std::exp(end(0, search.largest()[0])), bound_of_time},
          .dead_time_shift = {point[1], end(1, search.least()[1]), end(1, search.largest()[1]),
                              bound_of_shift == SizeBound::at_most ? SizeBound::none : bound_of_shift},
          .noise_order = search.whiteness().order(),
          .explained = std::max(0.0, 1.0 - least / search.squares_of_model()),
          .channel = nominal.with_gain_scaled(gain)
                         .with_time_scaled(std::exp(point[0]))
                         .with_dead_time_shifted(point[1])};
}

}  // namespace mpm
