#include "plants/analyser.hpp"

#include <algorithm>

#include "plants/non_finite.hpp"

namespace mpm {

Eigen::Index AnalyserTiming::taken(Eigen::Index k) const {
  const Eigen::Index since_first = k - delay - first;
  return since_first < 0 ? -1 : first + since_first / period * period;
}

bool has_analysers(const std::vector<AnalyserTiming>& timings) {
  return std::any_of(timings.begin(), timings.end(),
                     [](const AnalyserTiming& timing) { return timing.is_analyser(); });
}

AnalyserHold::AnalyserHold(const std::vector<AnalyserTiming>& timings) {
  for (std::size_t cv = 0; cv < timings.size(); ++cv)
    if (timings[cv].is_analyser())
      channels_.push_back(
          {static_cast<Eigen::Index>(cv), timings[cv], Eigen::VectorXd::Zero(timings[cv].delay + 1), 0.0});
}

void AnalyserHold::reset(const Eigen::Ref<const Eigen::VectorXd>& y) {
  sample_ = 0;
  for (Channel& channel : channels_)
    channel.shown = y(channel.cv);
}

void AnalyserHold::pass(Eigen::Ref<Eigen::VectorXd> y) {
  for (Channel& channel : channels_) {
    channel.past(sample_ % channel.past.size()) = y(channel.cv);
    if (const Eigen::Index taken = channel.timing.taken(sample_);
        taken >= 0 && taken == sample_ - channel.timing.delay)
      channel.shown = channel.past(taken % channel.past.size());
    y(channel.cv) = channel.shown;
  }
  ++sample_;
}

Eigen::RowVectorXd analyses(const AnalyserTiming& timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown) {
  Eigen::RowVectorXd at = Eigen::RowVectorXd::Constant(shown.size(), kNaN);
  for (Eigen::Index taken = timing.first; taken + timing.delay < shown.size(); taken += timing.period)
    at(taken) = shown(taken + timing.delay);
  return at;
}

AnalyserTiming with_first_of(AnalyserTiming timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown) {
  Eigen::VectorXi changes = Eigen::VectorXi::Zero(timing.period);
  for (Eigen::Index k = 1; k < shown.size(); ++k)
    if (shown(k) < shown(k - 1) || shown(k) > shown(k - 1))  // neither is true of NaN
      ++changes((k + timing.period - timing.delay % timing.period) % timing.period);
  Eigen::Index first = 0;
  changes.maxCoeff(&first);
  timing.first = static_cast<int>(first);
  return timing;
}

}  // namespace mpm
