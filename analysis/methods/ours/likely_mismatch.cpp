#include "analysis/methods/ours/likely_mismatch.hpp"

#include <algorithm>
#include <utility>

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

  /// Since a sample within the loop there may be another level, too: where neither setpoints nor inputs move,
  /// a step is no mismatch.
  LikelyMismatch best_since(Eigen::Index onset) const {
    constexpr double kLeast = 0.3, kMost = 1.0 / kLeast;  // of the gain
    constexpr double kTimes[] = {0.35, 0.5, 0.7, 1.4, 2.0, 2.8};
    constexpr double kShifts[] = {-3.0, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0};
    Columns level(nominal_.size(), onset > 0 ? 1 : 0);
    level.topRows(onset).setZero();
    level.bottomRows(level.rows() - onset).setOnes();
    const double parameters = onset > 0 ? 3.0 : 2.0,
                 none = errors_.with(level) + 0.5 * parameters * errors_.log_samples();
    LikelyMismatch best{.place = place_, .onset = onset};
    const auto take = [&](MismatchParameter parameter, Eigen::RowVectorXd h) {
      h.head(onset).setZero();
      if (const double gain = errors_.without(h, level) - none; gain > best.gain)
        best = {place_, parameter, onset, gain};
    };
    Eigen::RowVectorXd since = nominal_;
    since.head(onset).setZero();
    take(MismatchParameter::gain,
         (std::clamp(1.0 + errors_.size_of(since, level), kLeast, kMost) - 1.0) * nominal_);
    const auto take_other = [&](MismatchParameter parameter, double size) {
      const TransferFunction other =
          with_mismatches(TransferMatrix{{channel_}}, {{0, 0, parameter, size}})(0, 0);
      take(parameter, response_of(study_, other, u_) - nominal_);
    };
    for (const double factor : kTimes)
      take_other(MismatchParameter::time_constant, factor);
    for (const double shift : kShifts)
      if (const double time = shift * study_.controller.sample_time; channel_.dead_time() + time >= 0.0)
        take_other(MismatchParameter::dead_time, time);
    return best;
  }

 private:
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
  LikelyMismatch best;
  const auto take = [&best](const LikelyMismatch& here) {
    if (here.gain > best.gain)
      best = here;
  };
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place) {
    const TransferFunction channel = study.assessed_channel(cv, place);
    if (channel.is_zero())
      continue;
    const SuspectedChannel suspected(study, loop, errors, channel, place);
    take(suspected.best_since(0));
    if (errors.change() > 0)
      take(suspected.best_since(errors.change()));
  }
  return best;
}

}  // namespace mpm
