#include "analysis/methods/ours/sensor_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/statistics/quantile.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {
namespace {

// Chosen on the family `instruments` of the standard suite under the development seed 7.
constexpr Eigen::Index kFirstOnsets = 24;  ///< of the first look
constexpr double kLastSensorOnset = 0.85;  ///< of the record
constexpr double kSensorParameters = 2.0;
constexpr Eigen::Index kMedianReach = 4;  ///< samples to either side of which a median is taken
constexpr double kNoisier = 3.0;          ///< noise of an MD over that of the benchmark
constexpr double kProof = 15.0;           ///< log L that the noise of an MD brings
constexpr double kMostDeviations = 4.0;   ///< of noise from its median
constexpr double kLeastAmplitude = 0.1;   ///< part of this noise that y_sim must have; 1: all of it

/// The onset from which on `gain` is largest, and this gain.
struct BestOnset {
  Eigen::Index sample = 0;
  double gain = -kInfinity;
};

template <class Gain>
BestOnset best_onset(Eigen::Index samples, const Gain& gain) {
  const auto last = static_cast<Eigen::Index>(kLastSensorOnset * static_cast<double>(samples));
  BestOnset best;
  const auto take = [&](Eigen::Index sample) {
    if (sample < 0 || sample > last)
      return false;
    const double found = gain(sample);
    if (!(found > best.gain))
      return false;
    best = {sample, found};
    return true;
  };
  const Eigen::Index spacing = std::max<Eigen::Index>(1, last / kFirstOnsets);
  for (Eigen::Index sample = 0; sample <= last; sample += spacing)
    take(sample);
  for (Eigen::Index step = spacing / 2; step > 0;) {
    const Eigen::Index at = best.sample;
    const bool before = take(at - step), after = take(at + step);
    if (!before && !after)
      step /= 2;
  }
  return best;
}

Eigen::RowVectorXd bias_from(Eigen::Index onset, Eigen::Index samples) {
  Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(samples);
  h.tail(samples - onset).setOnes();
  return h;
}

Eigen::RowVectorXd drift_from(Eigen::Index onset, Eigen::Index samples) {
  Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(samples);
  h.tail(samples - onset).setLinSpaced(0.0, 1.0);
  return h;
}

/// By how much the SSE falls if h has its best size.
double sse_gain(const WhitenedErrors::Amplitude& amplitude) {
  return amplitude.squares > 0.0 ? amplitude.product * amplitude.product / amplitude.squares : 0.0;
}

/// d less its median over the samples about each one, cut to what noise of this deviation can be: a pulse is
/// not noise.
Eigen::RowVectorXd fast_part(const Eigen::RowVectorXd& d, double deviation) {
  Eigen::RowVectorXd fast(d.size());
  for (Eigen::Index k = 0; k < d.size(); ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(0, k - kMedianReach);
    const Eigen::Index count = std::min(d.size() - 1, k + kMedianReach) - first + 1;
    fast(k) = std::clamp(d(k) - upper_median({d.data() + first, d.data() + first + count}),
                         -kMostDeviations * deviation, kMostDeviations * deviation);
  }
  return fast;
}

/// The responses of all CVs to what the measurement of an MD adds to the MD.
class MdResponses {
 public:
  MdResponses(const std::vector<ModelErrors>& models, const std::vector<WhitenedErrors>& errors,
              Eigen::Index input, double sample_time)
      : errors_(errors) {
    for (std::size_t i = 0; i < models.size(); ++i) {
      const TransferFunction& channel = models[i].model()(0, input);
      channels_.push_back(channel.is_zero() ? std::optional<DiscreteChannel>()
                                            : discretise(channel, sample_time));
      deviations_.push_back(models[i].noise().deviation);
      samples_ += channels_.back() ? errors[i].samples() : 0.0;
    }
  }

  /// The number of samples of the CVs that the MD moves.
  double samples() const { return samples_; }

  std::vector<Eigen::RowVectorXd> to(const Eigen::RowVectorXd& x) const {
    std::vector<Eigen::RowVectorXd> all;
    for (std::size_t i = 0; i < channels_.size(); ++i)
      all.push_back(channels_[i]
                        ? Eigen::RowVectorXd(channel_response(*channels_[i], x, 0.0) / deviations_[i])
                        : Eigen::RowVectorXd());
    return all;
  }

  WhitenedErrors::Amplitude amplitude(const std::vector<Eigen::RowVectorXd>& h) const {
    WhitenedErrors::Amplitude sum{0.0, 0.0};
    for (std::size_t i = 0; i < h.size(); ++i)
      if (h[i].size() > 0) {
        const auto [product, squares] = errors_[i].amplitude(h[i]);
        sum.product += product;
        sum.squares += squares;
      }
    return sum;
  }

 private:
  const std::vector<WhitenedErrors>& errors_;
  std::vector<std::optional<DiscreteChannel>> channels_;
  std::vector<double> deviations_;
  double samples_ = 0.0;
};

Eigen::RowVectorXd from_onset(Eigen::RowVectorXd x, Eigen::Index onset) {
  x.head(onset).setZero();
  return x;
}

}  // namespace

ExplainedErrors best_sensor_error(const std::vector<WhitenedErrors>& errors, std::size_t cv) {
  const WhitenedErrors& of_cv = errors[cv];
  BestOnset best;
  Eigen::RowVectorXd h;
  for (const auto shape : {&bias_from, &drift_from}) {
    const BestOnset found = best_onset(of_cv.size(), [&](Eigen::Index onset) {
      return sse_gain(of_cv.amplitude(shape(onset, of_cv.size())));
    });
    if (found.gain > best.gain) {
      best = found;
      h = shape(found.sample, of_cv.size());
    }
  }
  const auto [product, squares] = of_cv.amplitude(h);
  if (!(squares > 0.0))
    return {};
  ExplainedErrors explained{std::vector<Eigen::RowVectorXd>(errors.size()),
                            0.5 * kSensorParameters * std::log(of_cv.samples())};
  explained.of_cvs[cv] = product / squares * h;
  return explained;
}

ExplainedErrors best_md_gain(const std::vector<ModelErrors>& models,
                             const std::vector<WhitenedErrors>& errors,
                             const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index input,
                             double sample_time) {
  const Eigen::RowVectorXd d = inputs.row(input).head(errors.front().size());
  const MdResponses responses(models, errors, input, sample_time);
  if (responses.samples() == 0.0 || !(d.maxCoeff() > d.minCoeff()))
    return {};
  const BestOnset best = best_onset(d.size(), [&](Eigen::Index onset) {
    return sse_gain(responses.amplitude(responses.to(from_onset(d, onset))));
  });
  std::vector<Eigen::RowVectorXd> h = responses.to(from_onset(d, best.sample));
  const auto [product, squares] = responses.amplitude(h);
  if (!(squares > 0.0))
    return {};
  for (Eigen::RowVectorXd& each : h)
    each *= product / squares;
  return {std::move(h), 0.5 * kSensorParameters * std::log(responses.samples())};
}

bool has_noisy_md(const std::vector<ModelErrors>& models, const std::vector<WhitenedErrors>& errors,
                  const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index input, double sample_time,
                  double healthy_noise) {
  const Eigen::RowVectorXd d = inputs.row(input).head(errors.front().size());
  const MdResponses responses(models, errors, input, sample_time);
  const double deviation = deviation_of_steps(d.tail(d.size() / 2));
  if (responses.samples() == 0.0 || !(deviation > kNoisier * healthy_noise))
    return false;
  const auto [product, squares] = responses.amplitude(responses.to(fast_part(d, deviation)));
  return product < -kLeastAmplitude * squares && product * product > 2.0 * kProof * squares;
}

}  // namespace mpm
