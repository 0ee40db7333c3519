#include "analysis/methods/ours/fault_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "analysis/methods/ours/likely_mismatch.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/valve_stem.hpp"
#include "scenarios/loop/record_rows.hpp"

namespace mpm {
namespace {

/// The moves of the inputs of a CV behind their dead times, N x columns.
Columns moves_of(const Study& study, const AssessedLoop& loop, Eigen::Index cv) {
  constexpr Eigen::Index kMoves = 6;
  const Eigen::Index N = loop.samples();
  std::vector<Eigen::VectorXd> all;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place) {
    const TransferFunction channel = study.assessed_channel(cv, place);
    if (channel.is_zero())
      continue;
    const Eigen::RowVectorXd u = input_of(study, loop, place);
    const auto dead = static_cast<Eigen::Index>(channel.dead_time() / study.controller.sample_time);
    for (Eigen::Index lag = dead + 1; lag <= dead + kMoves; ++lag) {
      Eigen::VectorXd moves = Eigen::VectorXd::Zero(N);
      for (Eigen::Index k = lag + 1; k < N; ++k)
        moves(k) = u(k - lag) - u(k - lag - 1);
      all.push_back(std::move(moves));
    }
  }
  Columns columns(N, static_cast<Eigen::Index>(all.size()));
  for (std::size_t place = 0; place < all.size(); ++place)
    columns.col(static_cast<Eigen::Index>(place)) = all[place];
  return columns;
}

/// The positions of a valve whose signal is u.
Eigen::RowVectorXd positions(ValveStem&& stem, const Eigen::RowVectorXd& u) {
  Eigen::RowVectorXd x(u.size());
  for (Eigen::Index k = 0; k < u.size(); ++k)
    x(k) = stem.follow(u(k));
  return x;
}

/// The responses of the channels of a CV, `late` samples late, N x channels.
Columns responses(const Study& study, const AssessedLoop& loop, Eigen::Index cv, double late) {
  std::vector<Eigen::RowVectorXd> all;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place)
    if (const TransferFunction channel = study.assessed_channel(cv, place); !channel.is_zero())
      all.push_back(late_by(response_of(study, channel, input_of(study, loop, place)), late));
  Columns columns(loop.samples(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t place = 0; place < all.size(); ++place)
    columns.col(static_cast<Eigen::Index>(place)) = all[place].transpose();
  return columns;
}

/// The most likely mismatch of a CV. Its gain is less by log m, for the m channels.
LikelyMismatch mismatch_of(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                           Eigen::Index cv) {
  double channels = 0.0;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place)
    channels += study.assessed_channel(cv, place).is_zero() ? 0.0 : 1.0;
  LikelyMismatch best = likely_mismatch(study, loop, errors, cv);
  best.gain -= std::log(std::max(1.0, channels));
  return best;
}

}  // namespace

FaultComparison::FaultComparison(const Study& study, const AssessedLoop& loop, std::vector<CvErrors> errors)
    : study_(study), loop_(loop), errors_(std::move(errors)) {
  for (CvErrors& of_cv : errors_) {
    of_cv.find_change();
    none_ += of_cv.none();
  }
  found_.disturbance = none_;
  ask_mismatch();
  ask_data();
  ask_sensor();
  ask_valve();
}

double FaultComparison::dependence_beside(RecordSource source) const {
  const Columns nothing(loop_.samples(), 0);
  double most = 0.0;
  if (source == RecordSource::mismatch || source == RecordSource::both)
    return most;
  for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
    Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(loop_.samples());
    Columns free = nothing;
    if (source == RecordSource::sensor && cv == found_.sensor_cv) {
      free = drift_;
    } else if (source == RecordSource::data && (found_.data_cv < 0 || found_.data_cv == cv)) {
      const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
      h = late_by(y_sim, found_.late) - y_sim;
    } else if (source == RecordSource::valve && found_.valve_mv >= 0) {
      if (const TransferFunction channel = study_.assessed_channel(cv, found_.valve_mv); !channel.is_zero())
        h = channel_response(discretise(channel, study_.controller.sample_time), off_, 0.0);
    }
    if (const double found = of(cv).dependence(loop_, h, free, moves_of(study_, loop_, cv)); found > most)
      most = found;
  }
  return most;
}

/// Adds the mismatch of each CV that gains from one; if none gains, takes that of the CV that loses least.
void FaultComparison::ask_mismatch() {
  double sum = 0.0, most = -kInfinity;
  for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
    const LikelyMismatch best = mismatch_of(study_, loop_, of(cv), cv);
    sum += std::max(0.0, best.gain);
    if (!(best.gain > most))
      continue;
    most = best.gain;
    found_.named.reset();
    found_.md = std::max<Eigen::Index>(-1, best.place - study_.mv_count());
    if (found_.md < 0)
      found_.named = {{cv, best.place}, best.parameter};
  }
  found_.mismatch = none_ + (most > 0.0 ? sum : most);
}

void FaultComparison::ask_data() {
  constexpr double kLate[] = {-2.0, -1.5, -1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0};
  found_.data = -kInfinity;
  const auto take = [this](double likelihood, double late, Eigen::Index cv) {
    if (likelihood > found_.data) {
      found_.data = likelihood;
      found_.late = late;
      found_.data_cv = cv;
    }
  };
  const double members = std::log(1.0 + static_cast<double>(loop_.y.rows()));
  for (const double late : kLate) {
    double sum = -members, samples = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
      const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
      const double here = of(cv).without(late_by(y_sim, late) - y_sim);
      sum += here;
      samples = std::max(samples, of(cv).log_samples());
      if (loop_.y.rows() > 1)
        take(none_ - of(cv).none() + here - of(cv).log_samples() - members, late, cv);
    }
    take(sum - 0.5 * samples, late, -1);
  }
}

void FaultComparison::ask_sensor() {
  constexpr Eigen::Index kRamps = 12, kSteps = 24;
  found_.sensor = -kInfinity;
  const Eigen::Index N = loop_.samples();
  const double members = std::log(2.0 * static_cast<double>(loop_.y.rows()));
  for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
    Eigen::Index at = 0;
    double most = -kInfinity;  // of a step of this CV, at this sample
    const auto take = [&](const Eigen::VectorXd& h, bool jumps) {
      const double here = none_ - of(cv).none() + of(cv).with(h) - of(cv).log_samples() - members;
      if (here > found_.sensor) {
        found_.sensor = here;
        found_.sensor_cv = cv;
        found_.sensor_jumps = jumps;
        drift_ = h;
      }
      return here;
    };
    const auto take_step = [&](Eigen::Index sample) {
      if (sample < 1 || sample >= N)
        return;
      Eigen::VectorXd step = Eigen::VectorXd::Zero(N);
      step.tail(N - sample).setOnes();
      if (const double here = take(step, true); here > most) {
        most = here;
        at = sample;
      }
    };
    for (Eigen::Index ramp = 0; ramp < kRamps; ++ramp)
      take((Eigen::ArrayXd::LinSpaced(N, 0.0, 1.0) - static_cast<double>(ramp) / kRamps).max(0.0).matrix(),
           false);
    for (Eigen::Index step = 1; step < kSteps; ++step)
      take_step(step * N / kSteps);
    for (Eigen::Index reach = N / kSteps / 2; reach > 0; reach /= 2) {
      const Eigen::Index centre = at;
      take_step(centre - reach);
      take_step(centre + reach);
    }
  }
}

/// L if x is the position of the valve of this MV.
double FaultComparison::of_valve(Eigen::Index mv, const Eigen::RowVectorXd& x) const {
  const Eigen::RowVectorXd off = x - loop_.u.row(mv);
  double sum = 0.0, samples = 0.0;
  for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
    const TransferFunction channel = study_.assessed_channel(cv, mv);
    sum +=
        channel.is_zero()
            ? of(cv).none()
            : of(cv).without(channel_response(discretise(channel, study_.controller.sample_time), off, 0.0));
    samples = std::max(samples, of(cv).log_samples());
  }
  return sum - samples;
}

void FaultComparison::ask_valve() {
  constexpr double kBands[] = {0.02, 0.04, 0.07, 0.1, 0.14, 0.2, 0.28, 0.4};
  constexpr double kCloser[] = {0.84, 0.92, 1.08, 1.18};
  constexpr double kTriedJumps[] = {0.0, 0.3, 0.6, 1.0};
  found_.valve = -kInfinity;
  const double members = std::log(static_cast<double>((1 + std::ssize(kTriedJumps)) * study_.mv_count()));
  for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
    const Eigen::RowVectorXd u = loop_.u.row(mv);
    const double range = u.maxCoeff() - u.minCoeff();
    if (!(range > 0.0))
      continue;
    using ValveModel = std::function<Eigen::RowVectorXd(double)>;
    std::vector<ValveModel> valves{
        [&u](double band) { return positions(FrictionValve(band, 0.0, u(0)), u); }};
    for (const double jump : kTriedJumps)
      valves.emplace_back(
          [&u, jump](double band) { return positions(StickyValve(band, jump * band, u(0)), u); });
    for (const ValveModel& valve : valves) {
      double best = -kInfinity, band = 0.0;
      const auto take = [&](double size) {
        if (const double here = of_valve(mv, valve(size)) - members; here > best) {
          best = here;
          band = size;
        }
      };
      for (const double share : kBands)
        take(share * range);
      for (int pass = 0; pass < 2; ++pass) {
        const double centre = band;
        for (const double closer : kCloser)
          take(centre * (pass == 0 ? closer : 1.0 + 0.3 * (closer - 1.0)));
      }
      if (best > found_.valve) {
        found_.valve = best;
        found_.valve_mv = mv;
        off_ = valve(band) - u;
      }
    }
  }
}

double input_dependence(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                        Eigen::Index cv) {
  return errors.dependence(loop, Eigen::RowVectorXd::Zero(loop.samples()), Columns(loop.samples(), 0),
                           moves_of(study, loop, cv));
}

LateCvs common_lateness(const Study& study, const AssessedLoop& loop, const std::vector<CvErrors>& errors) {
  constexpr double kSure = 6.0, kTells = 2.0;
  constexpr double kLate[] = {-2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0};
  const auto with_free_gains = [&](Eigen::Index cv, double late) {
    const Eigen::RowVectorXd y_sim = loop.y_sim.row(cv);
    const Columns gains = responses(study, loop, cv, late);
    return errors[static_cast<std::size_t>(cv)].without(late_by(y_sim, late) - y_sim, gains) -
           0.5 * static_cast<double>(gains.cols()) * errors[static_cast<std::size_t>(cv)].log_samples();
  };
  const Eigen::Index ny = loop.y.rows();
  Eigen::VectorXd none(ny), wrong(ny);
  double samples = 0.0;
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    none(cv) = with_free_gains(cv, 0.0);
    wrong(cv) = errors[static_cast<std::size_t>(cv)].none() +
                std::max(0.0, mismatch_of(study, loop, errors[static_cast<std::size_t>(cv)], cv).gain);
    samples = std::max(samples, errors[static_cast<std::size_t>(cv)].log_samples());
  }
  LateCvs best;
  double most = 0.0;
  for (const double late : kLate) {
    LateCvs here{.samples = late};
    double sum = -0.5 * samples, than_wrong = sum;
    bool all = true;
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      const double with = with_free_gains(cv, late);
      all = all && with > none(cv) - kTells;
      if (with < none(cv) + kTells)
        continue;
      here.cvs.push_back(cv);
      sum += with - none(cv);
      than_wrong += with - wrong(cv);
    }
    const bool is_surer = than_wrong > (here.cvs.size() == 1 && ny > 1 ? kSure : 0.0);
    if (all)
      here.cvs.clear();
    if (sum > kSure && is_surer && sum > most) {
      most = sum;
      best = here;
    }
  }
  return best;
}

}  // namespace mpm
