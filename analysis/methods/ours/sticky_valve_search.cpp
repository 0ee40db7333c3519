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
// in S, so the grid is fine. What a valve gains by being the best of so many stays below the price of its
// parameters: in 72 loops without a fault it was 10 of log L, which is 3 less than this price.
constexpr double kLargestBand = 1.2;                   ///< S or f_S, over the range of the MV
constexpr double kCloseStep = 1.072, kWideStep = 1.2;  ///< from a size to the next: above kCloseBand, below
constexpr double kCloseBand = 0.015, kSmallestBand = 0.001;
constexpr double kFaintMove = 0.1;  ///< static move of the CV that moves most, in deviations of the noise
constexpr std::array kJumps{0.0, 0.25, 0.5, 0.75, 1.0};  ///< J/S, or 1 - f_D/f_S
constexpr std::size_t kMostSearched = 6;
constexpr double kLastValveOnset = 0.85;  ///< of the record
constexpr double kFinestShare = 0.04;     ///< of a step of the search
constexpr double kValveParameters = 4.0;
constexpr double kValveFarBehind = 40.0;  ///< of log L, from the best start alone

/// log of S over the range of the MV, the jump over S, the onset over the record, and the position of the
/// stem at the onset.
using ValveNumbers = Eigen::Vector4d;

struct TriedValve {
  bool has_friction;  ///< a FrictionValve
  ValveNumbers numbers;
};

/// The search for the valve of one MV.
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
      if (!channels_.back())
        continue;
      samples_ += errors[i].samples();
      const double gain = channel.is_integrating() ? 1.0 : channel.static_gain();
      most_moved_ = std::max(most_moved_, std::abs(gain) / deviations_.back());
    }
  }

  /// Searches from the best valve of the grid. Returns what the valve found adds to log L; -infinity if there
  /// is none.
  double first_look() {
    if (samples_ == 0.0 || !(range_ > 0.0))
      return -kInfinity;
    starts_ = best_of_grid();
    search_from(starts_.front());
    return most_ - log_likelihood(Eigen::RowVectorXd::Zero(u_.size()));
  }

  ExplainedErrors best() {
    std::for_each(starts_.begin() + 1, starts_.end(),
                  [this](const TriedValve& start) { search_from(start); });
    ExplainedErrors explained{{}, 0.5 * kValveParameters * std::log(samples_)};
    const Eigen::RowVectorXd x = off(best_);
    for (std::size_t i = 0; i < errors_.size(); ++i)
      explained.of_cvs.push_back(channels_[i] ? response(i, x) : Eigen::RowVectorXd());
    return explained;
  }

 private:
  inline static const ValveNumbers kSteps{0.1, 0.25, 0.1, 0.5};

  /// Sizes of the band over the range of the MV, down to those that no CV shows. Small sizes are further
  /// apart: the response to them is small, too, so that the likelihood is wider in log S.
  std::vector<double> band_sizes() const {
    const double least = std::max(kSmallestBand, std::min(kCloseBand, kFaintMove / (most_moved_ * range_)));
    std::vector<double> sizes;
    for (double size = kLargestBand; size >= least; size /= size > kCloseBand ? kCloseStep : kWideStep)
      sizes.push_back(size);
    return sizes;
  }

  /// The valves that gain most, each with its best onset, best first.
  std::vector<TriedValve> best_of_grid() const {
    std::vector<std::pair<double, TriedValve>> all;
    const std::vector<double> sizes = band_sizes();
    for (const bool has_friction : {false, true})
      for (const double jump : kJumps) {
        if (has_friction && jump == 0.0)
          continue;  // both sorts of valve are a deadband then
        std::vector<TriedValve> valves;
        for (const double size : sizes)
          valves.push_back({has_friction, {std::log(size), jump, 0.0, 0.0}});
        all.push_back(best_from_some_onset(valves));
      }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<TriedValve> first;
    for (std::size_t i = 0; i < std::min(kMostSearched, all.size()); ++i)
      first.push_back(all[i].second);
    return first;
  }

  /// The valve that gains most, with the onset from which on its samples gain most, and this gain.
  std::pair<double, TriedValve> best_from_some_onset(const std::vector<TriedValve>& valves) const {
    const auto count = static_cast<Eigen::Index>(valves.size());
    Eigen::MatrixXd x(count, u_.size()), h = x, gains = Eigen::MatrixXd::Zero(count, u_.size());
    for (Eigen::Index place = 0; place < count; ++place)
      x.row(place) = off(valves[static_cast<std::size_t>(place)]);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      if (!channels_[i])
        continue;
      for (Eigen::Index place = 0; place < count; ++place)
        h.row(place) = response(i, x.row(place));
      gains += errors_[i].gains(h);
    }
    const auto last = static_cast<Eigen::Index>(kLastValveOnset * static_cast<double>(u_.size()));
    std::pair<double, TriedValve> best{-kInfinity, {}};
    for (Eigen::Index place = 0; place < count; ++place) {
      double sum = 0.0;
      for (Eigen::Index k = u_.size() - 1; k >= 0; --k) {
        sum += gains(place, k);
        if (k <= last && sum > best.first) {
          best = {sum, valves[static_cast<std::size_t>(place)]};
          best.second.numbers(2) = static_cast<double>(k) / static_cast<double>(u_.size());
        }
      }
    }
    return best;
  }

  /// A pattern search (Hooke and Jeeves 1961).
  void search_from(TriedValve best) {
    double most = log_likelihood(off(best));
    for (double share = 1.0; share > kFinestShare;) {
      bool better = false;
      for (Eigen::Index number = 0; number < best.numbers.size(); ++number)
        for (const double direction : {-1.0, 1.0}) {
          TriedValve trial = best;
          trial.numbers(number) += direction * share * kSteps(number);
          trial.numbers(1) = std::clamp(trial.numbers(1), 0.0, 1.0);
          trial.numbers(2) = std::clamp(trial.numbers(2), 0.0, kLastValveOnset);
          trial.numbers(3) = std::clamp(trial.numbers(3), -1.0, 1.0);
          if (trial.numbers == best.numbers)
            continue;
          if (const double found = log_likelihood(off(trial)); found > most) {
            most = found;
            best = trial;
            better = true;
          }
        }
      if (!better)
        share *= 0.5;
    }
    if (most > most_) {
      most_ = most;
      best_ = best;
    }
  }

  /// The position of the valve less what is asked for.
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

  /// log L of the CVs that the MV moves.
  double log_likelihood(const Eigen::RowVectorXd& x) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < errors_.size(); ++i)
      if (channels_[i])
        sum += errors_[i].log_likelihood(response(i, x));
    return sum;
  }

  const std::vector<WhitenedErrors>& errors_;
  Eigen::RowVectorXd u_;
  double initial_, range_, samples_ = 0.0;
  /// Move of the CV that moves most, in deviations of its noise for a unit of the MV.
  double most_moved_ = 0.0;
  std::vector<std::optional<DiscreteChannel>> channels_;
  std::vector<double> deviations_;
  std::vector<TriedValve> starts_;  ///< from the grid
  double most_ = -kInfinity;        ///< log L of the best one so far
  TriedValve best_{false, ValveNumbers::Zero()};
};

}  // namespace

std::vector<ExplainedErrors> best_sticky_valves(const std::vector<ModelErrors>& models,
                                                const std::vector<WhitenedErrors>& errors,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                const Eigen::Ref<const Eigen::VectorXd>& initial,
                                                Eigen::Index mvs, double sample_time) {
  std::vector<ValveSearch> searches;
  std::vector<double> gains;
  for (Eigen::Index mv = 0; mv < mvs; ++mv) {
    searches.emplace_back(models, errors, inputs.row(mv).head(errors.front().size()), initial(mv), mv,
                          sample_time);
    gains.push_back(searches.back().first_look());
  }
  const double least = gains.empty() ? 0.0 : *std::max_element(gains.begin(), gains.end()) - kValveFarBehind;
  std::vector<ExplainedErrors> found;
  for (std::size_t mv = 0; mv < searches.size(); ++mv)
    found.push_back(gains[mv] > -kInfinity && gains[mv] >= least ? searches[mv].best() : ExplainedErrors{});
  return found;
}

}  // namespace mpm
