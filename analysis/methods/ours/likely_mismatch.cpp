#include "analysis/methods/ours/likely_mismatch.hpp"

#include <utility>

#include "analysis/methods/ours/mismatch_responses.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {
namespace {

LikelyMismatch of_channel(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                          const TransferFunction& channel, Eigen::Index place, Eigen::Index onset) {
  constexpr double kTimes[] = {0.35, 0.5, 0.7, 1.4, 2.0, 2.8};
  constexpr double kShifts[] = {-3.0, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0};
  LikelyMismatch best{.place = place};
  const double parameters = onset > 0 ? 3.0 : 2.0,
               none = errors.none() + 0.5 * parameters * errors.log_samples();
  const Eigen::RowVectorXd u = input_of(study, loop, place), nominal = response_of(study, channel, u);
  const auto masked = [onset](Eigen::RowVectorXd h) {
    h.head(onset).setZero();
    return h;
  };
  best.gain = errors.with(masked(nominal).transpose()) - none;
  const auto take = [&](MismatchParameter parameter, double size) {
    const TransferFunction other =
        with_mismatches(TransferMatrix{{channel}}, {{0, 0, parameter, size}})(0, 0);
    const double gain = errors.without(masked(response_of(study, other, u) - nominal)) - none;
    if (gain > best.gain)
      best = {place, parameter, gain};
  };
  for (const double factor : kTimes)
    take(MismatchParameter::time_constant, factor);
  for (const double shift : kShifts)
    if (const double time = shift * study.controller.sample_time; channel.dead_time() + time >= 0.0)
      take(MismatchParameter::dead_time, time);
  return best;
}

}  // namespace

Eigen::RowVectorXd input_of(const Study& study, const AssessedLoop& loop, Eigen::Index place) {
  return place < study.mv_count() ? loop.u.row(place) : loop.d.row(place - study.mv_count());
}

Eigen::RowVectorXd response_of(const Study& study, const TransferFunction& channel,
                               const Eigen::RowVectorXd& x) {
  return channel_response(discretise(channel, study.controller.sample_time), x, x(0));
}

LikelyMismatch likely_mismatch(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                               Eigen::Index cv, Eigen::Index onset) {
  LikelyMismatch best;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place)
    if (const TransferFunction channel = study.assessed_channel(cv, place); !channel.is_zero())
      if (const LikelyMismatch here = of_channel(study, loop, errors, channel, place, onset);
          here.gain > best.gain)
        best = here;
  return best;
}

}  // namespace mpm
