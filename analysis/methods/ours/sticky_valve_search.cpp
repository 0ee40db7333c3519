#include "analysis/methods/ours/sticky_valve_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "analysis/methods/ours/mismatch_responses.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/valve_stem.hpp"

namespace mpm {
namespace {

// Chosen on the standard suite under the development seed 7. The likelihood of a valve that jumps is narrow
// in S, so that the grid is close.
constexpr double kSmallestBand = 0.015, kLargestBand = 1.2;  ///< S or f_S, over what the MV moves
constexpr int kBandSizes = 64;
constexpr std::array kJumps{0.0, 0.25, 0.5, 0.75, 1.0};  ///< J/S, or 1 - f_D/f_S
constexpr std::size_t kMostSearched = 6;
constexpr double kLastValveOnset = 0.85;  ///< of the record
constexpr double kFinestShare = 0.04;     ///< of a step of the search
constexpr double kValveParameters = 4.0;

/// log S over what the MV moves, the jump over S, the onset over the record, and where the stem stands then.
using ValveNumbers = Eigen::Vector4d;

struct TriedValve {
  bool has_friction;  ///< a FrictionValve
  ValveNumbers numbers;
};

/// The valve of one MV.
class ValveSearch {
 public:
  ValveSearch(const std::vector<ModelErrors>& models, const std::vector<WhitenedErrors>& errors,
              Eigen::RowVectorXd u, double initial, Eigen::Index mv, double sample_time)
      : errors_(errors), u_(std::move(u)), initial_(initial), range_(u_.maxCoeff() - u_.minCoeff()) {
    for (std::size_t i = 0; i < models.size(); ++i) {
      const TransferFunction& channel = models[i].model()(0, mv);
      channels_.push_back(channel.is_zero() ? std::optional<DiscreteChannel>()
                                            : discretise(channel, sample_time));
      deviations_.push_back(models[i].noise().deviation);
      if (channels_.back())
        samples_ += errors[i].samples();
    }
  }

  ExplainedErrors best() const {
    if (samples_ == 0.0 || !(range_ > 0.0))
      return {};
    double most = -kInfinity;
    ValveNumbers numbers = ValveNumbers::Zero();
    TriedValve best{false, numbers};
    for (const TriedValve& start : first_look()) {
      const auto [found, log_likelihood] = searched(start);
      if (log_likelihood > most) {
        most = log_likelihood;
        best = found;
      }
    }
    ExplainedErrors explained{{}, 0.5 * kValveParameters * std::log(samples_)};
    const Eigen::RowVectorXd x = off(best);
    for (std::size_t i = 0; i < errors_.size(); ++i)
      explained.of_cvs.push_back(channels_[i] ? response(i, x) : Eigen::RowVectorXd());
    return explained;
  }

 private:
  inline static const ValveNumbers kStep{0.1, 0.25, 0.1, 0.5};

  /// The best of the grid, each with its best onset, best first.
  std::vector<TriedValve> first_look() const {
    std::vector<std::pair<double, TriedValve>> all;
    const double ratio = std::pow(kLargestBand / kSmallestBand, 1.0 / (kBandSizes - 1));
    for (const bool has_friction : {false, true})
      for (const double jump : kJumps) {
        if (has_friction && jump == 0.0)
          continue;  // a deadband, with both
        std::pair<double, TriedValve> best{-kInfinity, {}};
        for (int size = 0; size < kBandSizes; ++size) {
          TriedValve valve{has_friction, {std::log(kSmallestBand) + size * std::log(ratio), jump, 0.0, 0.0}};
          const double gain = gain_from_best_onset(valve);
          if (gain > best.first)
            best = {gain, valve};
        }
        all.push_back(best);
      }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<TriedValve> first;
    for (std::size_t i = 0; i < std::min(kMostSearched, all.size()); ++i)
      first.push_back(all[i].second);
    return first;
  }

  /// Takes the onset of `valve` from which on its samples gain most.
  double gain_from_best_onset(TriedValve& valve) const {
    const Eigen::RowVectorXd x = off(valve);
    Eigen::RowVectorXd gains = Eigen::RowVectorXd::Zero(u_.size());
    for (std::size_t i = 0; i < errors_.size(); ++i)
      if (channels_[i])
        gains += errors_[i].gains(response(i, x));
    const auto last = static_cast<Eigen::Index>(kLastValveOnset * static_cast<double>(u_.size()));
    double sum = 0.0, best = -kInfinity;
    for (Eigen::Index k = u_.size() - 1; k >= 0; --k) {
      sum += gains(k);
      if (k <= last && sum > best) {
        best = sum;
        valve.numbers(2) = static_cast<double>(k) / static_cast<double>(u_.size());
      }
    }
    return best;
  }

  /// A pattern search (Hooke and Jeeves 1961).
  std::pair<TriedValve, double> searched(TriedValve best) const {
    double most = log_likelihood(best);
    for (double share = 1.0; share > kFinestShare;) {
      bool better = false;
      for (Eigen::Index number = 0; number < best.numbers.size(); ++number)
        for (const double direction : {-1.0, 1.0}) {
          TriedValve trial = best;
          trial.numbers(number) += direction * share * kStep(number);
          trial.numbers(1) = std::clamp(trial.numbers(1), 0.0, 1.0);
          trial.numbers(2) = std::clamp(trial.numbers(2), 0.0, kLastValveOnset);
          trial.numbers(3) = std::clamp(trial.numbers(3), -1.0, 1.0);
          if (trial.numbers == best.numbers)
            continue;
          if (const double found = log_likelihood(trial); found > most) {
            most = found;
            best = trial;
            better = true;
          }
        }
      if (!better)
        share *= 0.5;
    }
    return {best, most};
  }

  /// What the valve does not do of what is asked for.
  Eigen::RowVectorXd off(const TriedValve& valve) const {
    const double size = range_ * std::exp(valve.numbers(0)), jump = valve.numbers(1) * size;
    const auto onset = static_cast<Eigen::Index>(valve.numbers(2) * static_cast<double>(u_.size()));
    const double u = onset > 0 ? u_(onset - 1) : initial_, start = valve.numbers(3);
    Eigen::RowVectorXd x = Eigen::RowVectorXd::Zero(u_.size());
    const auto follow = [&](ValveStem&& stem) {
      for (Eigen::Index k = onset; k < u_.size(); ++k)
        x(k) = stem.follow(u_(k)) - u_(k);
    };
    if (valve.has_friction)
      follow(FrictionValve(size, size - jump, u, start));
    else
      follow(StickyValve(size, jump, u, start));
    return x;
  }

  Eigen::RowVectorXd response(std::size_t cv, const Eigen::RowVectorXd& x) const {
    return channel_response(*channels_[cv], x, 0.0) / deviations_[cv];
  }

  /// Of the CVs that the MV moves.
  double log_likelihood(const TriedValve& valve) const {
    const Eigen::RowVectorXd x = off(valve);
    double sum = 0.0;
    for (std::size_t i = 0; i < errors_.size(); ++i)
      if (channels_[i])
        sum += errors_[i].log_likelihood(response(i, x));
    return sum;
  }

  const std::vector<WhitenedErrors>& errors_;
  Eigen::RowVectorXd u_;
  double initial_, range_, samples_ = 0.0;
  std::vector<std::optional<DiscreteChannel>> channels_;
  std::vector<double> deviations_;
};

}  // namespace

ExplainedErrors best_sticky_valve(const std::vector<ModelErrors>& models,
                                  const std::vector<WhitenedErrors>& errors,
                                  const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                  const Eigen::Ref<const Eigen::VectorXd>& initial, Eigen::Index mv,
                                  double sample_time) {
  return ValveSearch(models, errors, inputs.row(mv).head(errors.front().size()), initial(mv), mv, sample_time)
      .best();
}

}  // namespace mpm
