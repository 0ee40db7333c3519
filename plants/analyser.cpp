#include "plants/analyser.hpp"

#include <algorithm>

#include "base/non_finite.hpp"

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
  for (std::size_t i = 0; i < timings.size(); ++i)
    if (timings[i].is_analyser())
      channels_.push_back(
          {static_cast<Eigen::Index>(i), timings[i], Eigen::VectorXd::Zero(timings[i].delay + 1), 0.0});
}

void AnalyserHold::reset(const Eigen::Ref<const Eigen::VectorXd>& y) {
  sample_ = 0;
  for (Channel& channel : channels_)
    channel.shown = y(channel.variable);
}

void AnalyserHold::pass(Eigen::Ref<Eigen::VectorXd> y) {
  for (Channel& channel : channels_) {
    channel.past(sample_ % channel.past.size()) = y(channel.variable);
    if (const Eigen::Index taken = channel.timing.taken(sample_);
        taken >= 0 && taken == sample_ - channel.timing.delay)
      channel.shown = channel.past(taken % channel.past.size());
    y(channel.variable) = channel.shown;
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

Eigen::MatrixXd as_shown(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd signals,
                         const Eigen::Ref<const Eigen::VectorXd>& rest) {
  AnalyserHold analysers(timings);
  analysers.reset(rest);
  for (auto y : signals.colwise())
    analysers.pass(y);
  return signals;
}

Eigen::MatrixXd as_taken(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd shown) {
  for (std::size_t i = 0; i < timings.size(); ++i) {
    const AnalyserTiming& timing = timings[i];
    if (!timing.is_analyser())
      continue;
    auto signal = shown.row(static_cast<Eigen::Index>(i));
    const Eigen::RowVectorXd of_record = signal;
    const AnalyserTiming at_once{.period = timing.period, .delay = 0, .first = timing.first};
    const Eigen::Index last = timing.taken(signal.size() - 1);
    for (Eigen::Index k = 0; k < signal.size(); ++k) {
      const Eigen::Index taken = std::min(at_once.taken(k), last);
      signal(k) = of_record(taken < 0 ? 0 : taken + timing.delay);
    }
  }
  return shown;
}

Eigen::MatrixXd as_taken_in_record(std::vector<AnalyserTiming> timings, const Eigen::MatrixXd& shown) {
  for (std::size_t i = 0; i < timings.size(); ++i)
    timings[i] = with_first_of(timings[i], shown.row(static_cast<Eigen::Index>(i)));
  return as_taken(timings, shown);
}

}  // namespace mpm
