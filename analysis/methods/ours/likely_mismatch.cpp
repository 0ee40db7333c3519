#include "analysis/methods/ours/likely_mismatch.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/methods/ours/mismatch_responses.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {
namespace {

/// One channel of a CV.
class SuspectedChannel {
 public:
  SuspectedChannel(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                   TransferFunction channel, Eigen::Index place)
      : study_(study),
        errors_(errors),
        channel_(std::move(channel)),
        place_(place),
        u_(input_of(study, loop, place)),
        nominal_(response_of(study, channel_, u_)) {}

  LikelyMismatch gain_since(Eigen::Index onset) const {
    constexpr double kLeast = 0.3, kMost = 1.0 / kLeast;
    const Eigen::RowVectorXd h = since(onset, nominal_);
    const double factor = std::clamp(1.0 + errors_.size_of(h), kLeast, kMost);
    return {place_, MismatchParameter::gain, onset, errors_.without((factor - 1.0) * h) - none(onset)};
  }

  LikelyMismatch best_since(Eigen::Index onset) const {
    constexpr double kTimes[] = {0.35, 0.5, 0.7, 1.4, 2.0, 2.8};
    constexpr double kShifts[] = {-3.0, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0};
    LikelyMismatch best = gain_since(onset);
    const auto take = [&](MismatchParameter parameter, double size) {
      const TransferFunction other =
          with_mismatches(TransferMatrix{{channel_}}, {{0, 0, parameter, size}})(0, 0);
      const double gain =
          errors_.without(since(onset, response_of(study_, other, u_) - nominal_)) - none(onset);
      if (gain > best.gain)
        best = {place_, parameter, onset, gain};
    };
    for (const double factor : kTimes)
      take(MismatchParameter::time_constant, factor);
    for (const double shift : kShifts)
      if (const double time = shift * study_.controller.sample_time; channel_.dead_time() + time >= 0.0)
        take(MismatchParameter::dead_time, time);
    return best;
  }

 private:
  static Eigen::RowVectorXd since(Eigen::Index onset, Eigen::RowVectorXd h) {
    h.head(onset).setZero();
    return h;
  }

  /// The L that a mismatch must exceed to gain anything.
  double none(Eigen::Index onset) const {
    const double parameters = onset > 0 ? 3.0 : 2.0;
    return errors_.none() + 0.5 * parameters * errors_.log_samples();
  }

  const Study& study_;
  const CvErrors& errors_;
  TransferFunction channel_;
  Eigen::Index place_;
  Eigen::RowVectorXd u_, nominal_;
};

}  // namespace

Eigen::RowVectorXd input_of(const Study& study, const AssessedLoop& loop, Eigen::Index place) {
  return place < study.mv_count() ? loop.u.row(place) : loop.d.row(place - study.mv_count());
}

Eigen::RowVectorXd response_of(const Study& study, const TransferFunction& channel,
                               const Eigen::RowVectorXd& x) {
  return channel_response(discretise(channel, study.controller.sample_time), x, x(0));
}

LikelyMismatch likely_mismatch(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                               Eigen::Index cv) {
  constexpr Eigen::Index kOnsets = 24, kFewestAfter = 3;  // parts of the loop
  std::vector<SuspectedChannel> channels;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place)
    if (const TransferFunction channel = study.assessed_channel(cv, place); !channel.is_zero())
      channels.emplace_back(study, loop, errors, channel, place);
  LikelyMismatch best, of_gains;
  const auto take = [](const LikelyMismatch& here, LikelyMismatch& largest) {
    if (here.gain > largest.gain)
      largest = here;
  };
  for (const SuspectedChannel& channel : channels) {
    take(channel.best_since(0), best);
    for (Eigen::Index part = 1; part <= kOnsets - kFewestAfter; ++part)
      take(channel.gain_since(part * loop.samples() / kOnsets), of_gains);
  }
  for (const SuspectedChannel& channel : channels)
    take(channel.best_since(of_gains.onset), best);
  return best;
}

}  // namespace mpm
