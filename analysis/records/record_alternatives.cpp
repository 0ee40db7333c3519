#include "analysis/records/record_alternatives.hpp"

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

#include "analysis/methods/ours/cv_errors.hpp"
#include "analysis/methods/ours/likely_mismatch.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/valve_stem.hpp"
#include "scenarios/loop/record_rows.hpp"

namespace mpm {
namespace {

/// The moves of the inputs of a CV behind their dead times, N x columns.
Columns moves_of(const Study& study, const AssessedLoop& loop, Eigen::Index cv) {
  constexpr Eigen::Index kLags = 6;
  const Eigen::Index N = loop.samples();
  std::vector<Eigen::VectorXd> all;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place) {
    const TransferFunction channel = study.assessed_channel(cv, place);
    if (channel.is_zero())
      continue;
    const Eigen::RowVectorXd u = input_of(study, loop, place);
    const auto dead = static_cast<Eigen::Index>(channel.dead_time() / study.controller.sample_time);
    for (Eigen::Index lag = dead + 1; lag <= dead + kLags; ++lag) {
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

/// Where a valve stands whose signal is u.
Eigen::RowVectorXd positions(ValveStem&& stem, const Eigen::RowVectorXd& u) {
  Eigen::RowVectorXd x(u.size());
  for (Eigen::Index k = 0; k < u.size(); ++k)
    x(k) = stem.follow(u(k));
  return x;
}

/// The hypotheses about one record.
class Comparison {
 public:
  Comparison(const Study& study, const AssessedLoop& loop, double delta,
             const std::optional<FaultOnset>& onset)
      : study_(study), loop_(loop), onset_(onset ? onset->sample : 0) {
    const ChannelErrorFits fits(study, delta);
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const ChannelErrorFit fit = fits.of(loop, cv);
      cvs_.emplace_back(loop, cv, fit.samples, fit.e, fit.X);
      cvs_.back().find_change(onset_);
      none_ += cvs_.back().none();
    }
  }

  RecordAlternatives all() {
    RecordAlternatives found{.disturbance = none_};
    mismatch(found);
    data(found);
    sensor(found);
    valve(found);
    const Columns nothing(loop_.samples(), 0);
    const auto none_of = [this](Eigen::Index) -> Eigen::RowVectorXd {
      return Eigen::RowVectorXd::Zero(loop_.samples());
    };
    const auto no_column = [&nothing](Eigen::Index) -> const Columns& { return nothing; };
    found.fit[RecordSource::disturbance] = dependence(none_of, no_column);
    found.fit[RecordSource::sensor] = dependence(none_of, [this, &found, &nothing](Eigen::Index cv) {
      return cv == found.sensor_cv ? Columns(drift_) : nothing;
    });
    found.fit[RecordSource::data] = dependence(
        [this, &found](Eigen::Index cv) -> Eigen::RowVectorXd {
          const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
          const bool is_late = found.data_cv < 0 || found.data_cv == cv;
          return late_by(y_sim, is_late ? found.late : 0.0) - y_sim;
        },
        no_column);
    if (found.valve_mv >= 0)
      found.fit[RecordSource::valve] = dependence(
          [this, &found](Eigen::Index cv) -> Eigen::RowVectorXd {
            const TransferFunction channel = study_.assessed_channel(cv, found.valve_mv);
            if (channel.is_zero())
              return Eigen::RowVectorXd::Zero(loop_.samples());
            return channel_response(discretise(channel, study_.controller.sample_time), off_, 0.0);
          },
          no_column);
    return found;
  }

  LateCvs common_lateness() const {
    constexpr double kSure = 6.0, kTells = 2.0;
    constexpr double kLate[] = {-2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0};
    const auto with_free_gains = [&](Eigen::Index cv, double late) {
      const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
      const Columns gains = responses(cv, late);
      return of(cv).without(late_by(y_sim, late) - y_sim, gains) -
             0.5 * static_cast<double>(gains.cols()) * of(cv).log_samples();
    };
    const Eigen::Index ny = loop_.y.rows();
    Eigen::VectorXd none(ny), wrong(ny);
    double samples = 0.0;
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      none(cv) = with_free_gains(cv, 0.0);
      wrong(cv) = of(cv).none() + std::max(0.0, mismatch(cv).gain);
      samples = std::max(samples, of(cv).log_samples());
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

 private:
  /// The largest input_dependence() of a CV, where h(cv) and free(cv) are in its errors.
  template <class H, class Free>
  double dependence(H h, Free free) const {
    double most = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv)
      if (const double found = of(cv).dependence(loop_, h(cv), free(cv), moves_of(study_, loop_, cv));
          found > most)
        most = found;
    return most;
  }

  /// N x channels of a CV, late.
  Columns responses(Eigen::Index cv, double late) const {
    std::vector<Eigen::RowVectorXd> all;
    for (Eigen::Index place = 0; place < study_.mv_count() + study_.md_count(); ++place)
      if (const TransferFunction channel = study_.assessed_channel(cv, place); !channel.is_zero())
        all.push_back(late_by(response_of(study_, channel, input_of(study_, loop_, place)), late));
    Columns columns(loop_.samples(), static_cast<Eigen::Index>(all.size()));
    for (std::size_t place = 0; place < all.size(); ++place)
      columns.col(static_cast<Eigen::Index>(place)) = all[place].transpose();
    return columns;
  }

  const CvErrors& of(Eigen::Index cv) const { return cvs_[static_cast<std::size_t>(cv)]; }

  LikelyMismatch mismatch(Eigen::Index cv) const {
    double channels = 0.0;
    for (Eigen::Index place = 0; place < study_.mv_count() + study_.md_count(); ++place)
      channels += study_.assessed_channel(cv, place).is_zero() ? 0.0 : 1.0;
    LikelyMismatch best = likely_mismatch(study_, loop_, of(cv), cv, onset_);
    best.gain -= std::log(std::max(1.0, channels));
    return best;
  }

  /// That of each CV for which there is one, and of one CV at least.
  void mismatch(RecordAlternatives& found) const {
    double sum = 0.0, most = -kInfinity;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
      const LikelyMismatch best = mismatch(cv);
      sum += std::max(0.0, best.gain);
      if (!(best.gain > most))
        continue;
      most = best.gain;
      found.named.reset();
      found.md = std::max<Eigen::Index>(-1, best.place - study_.mv_count());
      if (found.md < 0)
        found.named = {{cv, best.place}, best.parameter};
    }
    found.mismatch = none_ + (most > 0.0 ? sum : most);
  }

  void data(RecordAlternatives& found) const {
    constexpr double kLate[] = {-2.0, -1.5, -1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0};
    found.data = -kInfinity;
    const auto take = [&found](double likelihood, double late, Eigen::Index cv) {
      if (likelihood > found.data) {
        found.data = likelihood;
        found.late = late;
        found.data_cv = cv;
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

  void sensor(RecordAlternatives& found) {
    constexpr Eigen::Index kRamps = 12, kSteps = 24;
    found.sensor = -kInfinity;
    const Eigen::Index N = loop_.samples();
    const double members = std::log(2.0 * static_cast<double>(loop_.y.rows()));
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
      Eigen::Index at = 0;
      double most = -kInfinity;  // of a step of this CV, at this sample
      const auto take = [&](const Eigen::VectorXd& h, bool jumps) {
        const double here = none_ - of(cv).none() + of(cv).with(h) - of(cv).log_samples() - members;
        if (here > found.sensor) {
          found.sensor = here;
          found.sensor_cv = cv;
          found.sensor_jumps = jumps;
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

  /// L of a valve of this MV whose position is x.
  double of_valve(Eigen::Index mv, const Eigen::RowVectorXd& x) const {
    const Eigen::RowVectorXd off = x - loop_.u.row(mv);
    double sum = 0.0, samples = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
      const TransferFunction channel = study_.assessed_channel(cv, mv);
      sum += channel.is_zero() ? of(cv).none()
                               : of(cv).without(channel_response(
                                     discretise(channel, study_.controller.sample_time), off, 0.0));
      samples = std::max(samples, of(cv).log_samples());
    }
    return sum - samples;
  }

  void valve(RecordAlternatives& found) {
    constexpr double kBands[] = {0.02, 0.04, 0.07, 0.1, 0.14, 0.2, 0.28, 0.4};
    constexpr double kCloser[] = {0.84, 0.92, 1.08, 1.18};
    constexpr double kTriedJumps[] = {0.0, 0.3, 0.6, 1.0};
    found.valve = -kInfinity;
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
        if (best > found.valve) {
          found.valve = best;
          found.valve_mv = mv;
          off_ = valve(band) - u;
        }
      }
    }
  }

  const Study& study_;
  const AssessedLoop& loop_;
  Eigen::Index onset_;
  std::vector<CvErrors> cvs_;
  double none_ = 0.0;
  Eigen::RowVectorXd off_;  ///< x - u of the best valve
  Eigen::VectorXd drift_;   ///< of the most likely sensor, of any size
};

}  // namespace

RecordAlternatives record_alternatives(const Study& study, const AssessedLoop& loop, double delta,
                                       const std::optional<FaultOnset>& onset) {
  return Comparison(study, loop, delta, onset).all();
}

double input_dependence(const Study& study, const AssessedLoop& loop, const ChannelErrorFit& fit,
                        Eigen::Index cv) {
  return CvErrors(loop, cv, fit.samples, fit.e, fit.X)
      .dependence(loop, Eigen::RowVectorXd::Zero(loop.samples()), Columns(loop.samples(), 0),
                  moves_of(study, loop, cv));
}

LateCvs common_lateness(const Study& study, const AssessedLoop& loop, double delta) {
  return Comparison(study, loop, delta, {}).common_lateness();
}

}  // namespace mpm
