#include "analysis/records/record_alternatives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/coloured_noise.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/valve_stem.hpp"

namespace mpm {
namespace {

using Columns = Eigen::MatrixXd;

/// A_l' B_m of signals (n x .) that are l and m samples late, l, m <= kNoiseOrder, over the samples that have
/// a past of this length. The products of signals that an autoregression whitens follow from them without the
/// signals:
///
///   (A_0 - sum_l a_l A_l)' (B_0 - sum_m a_m B_m)
class LaggedProducts {
 public:
  LaggedProducts(const Columns& A, const Columns& B) {
    const Eigen::Index n = A.rows(), count = n - kNoiseOrder;
    const auto late = [count](const Columns& signals, Eigen::Index lag) {
      return signals.middleRows(kNoiseOrder - lag, count);
    };
    for (Eigen::Index m = 0; m < kLags; ++m)
      at(0, m) = late(A, 0).transpose() * late(B, m);
    for (Eigen::Index l = 1; l < kLags; ++l)
      at(l, 0) = &A == &B ? Columns(at(0, l).transpose()) : Columns(late(A, l).transpose() * late(B, 0));
    // One sample later a sample enters at the start, and one leaves at the end.
    for (Eigen::Index l = 0; l + 1 < kLags; ++l)
      for (Eigen::Index m = 0; m + 1 < kLags; ++m)
        at(l + 1, m + 1) = at(l, m) + A.row(kNoiseOrder - 1 - l).transpose() * B.row(kNoiseOrder - 1 - m) -
                           A.row(n - 1 - l).transpose() * B.row(n - 1 - m);
  }

  Columns whitened_by(const Eigen::VectorXd& a) const {
    Eigen::VectorXd factors(kLags);
    factors << 1.0, -a;
    Columns sum = Columns::Zero(products_.front().rows(), products_.front().cols());
    for (Eigen::Index l = 0; l < kLags; ++l)
      for (Eigen::Index m = 0; m < kLags; ++m)
        if (const double factor = factors(l) * factors(m); factor != 0.0)
          sum += factor * at(l, m);
    return sum;
  }

 private:
  static constexpr Eigen::Index kLags = kNoiseOrder + 1;

  Columns& at(Eigen::Index l, Eigen::Index m) { return products_[static_cast<std::size_t>(l * kLags + m)]; }
  const Columns& at(Eigen::Index l, Eigen::Index m) const {
    return products_[static_cast<std::size_t>(l * kLags + m)];
  }

  std::array<Columns, static_cast<std::size_t>(kLags* kLags)> products_;
};

/// One CV: its errors, and how likely they are under a hypothesis.
class CvErrors {
 public:
  CvErrors(const AssessedLoop& loop, const ChannelErrorFit& fit, Eigen::Index cv)
      : samples_(fit.samples), X_(fit.X.size() == 0 ? Columns(fit.e.size(), 0) : fit.X), XX_(X_, X_) {
    if (!loop.untold.empty()) {
      const Columns untold = loop.untold[static_cast<std::size_t>(cv)](Eigen::all, samples_).transpose();
      const Eigen::HouseholderQR<Columns> qr(untold);
      Q_ = qr.householderQ() * Columns::Identity(untold.rows(), untold.cols());
    }
    e_ = told(fit.e);
    none_ = log_likelihood(e_, Columns(e_.size(), 0));
  }

  double none() const { return none_; }
  double log_samples() const { return std::log(static_cast<double>(e_.size())); }

  /// With h (N of the loop) taken off.
  double without(const Eigen::RowVectorXd& h) const { return without(h, Columns(h.size(), 0)); }
  /// The same with these columns (N of the loop, each of any size) in it.
  double without(const Eigen::RowVectorXd& h, const Columns& free) const {
    return log_likelihood(e_ - told(h(samples_).transpose()), told_columns(free));
  }
  double with(const Columns& free) const { return log_likelihood(e_, told_columns(free)); }

  /// F of the regression of the innovations on `moves` (N of the loop), where h and `free` are in the errors.
  double dependence(const Eigen::RowVectorXd& h, const Columns& free, const Columns& moves) const {
    Eigen::VectorXd w;
    log_likelihood(e_ - told(h(samples_).transpose()), told_columns(free), &w);
    Columns M(w.size(), moves.cols());
    for (Eigen::Index column = 0; column < moves.cols(); ++column)
      M.col(column) = moves.col(column)(samples_).tail(w.size());
    M.rowwise() -= M.colwise().mean();
    w.array() -= w.mean();
    const Eigen::ColPivHouseholderQR<Columns> qr(M);
    const auto p = static_cast<double>(qr.rank()), n = static_cast<double>(w.size());
    const double left = (w - M * qr.solve(w)).squaredNorm();
    return p > 0.0 && n > p + 2.0 && left > 0.0 ? (w.squaredNorm() - left) / p / (left / (n - p)) : kNaN;
  }

 private:
  static constexpr int kPasses = 3;

  Eigen::VectorXd told(const Eigen::VectorXd& signal) const {
    return Q_.size() == 0 ? signal : Eigen::VectorXd(signal - Q_ * (Q_.transpose() * signal));
  }

  Columns told_columns(const Columns& free) const {
    Columns H(e_.size(), free.cols());
    for (Eigen::Index column = 0; column < free.cols(); ++column)
      H.col(column) = told(free.col(column)(samples_));
    return H;
  }

  double log_likelihood(const Eigen::VectorXd& e, const Columns& free,
                        Eigen::VectorXd* innovations = nullptr) const {
    const auto n = static_cast<double>(e.size());
    const Eigen::Index p = X_.cols(), q = free.cols();
    const LaggedProducts Xe(X_, e), FX(free, X_), FF(free, free), Fe(free, e);
    Eigen::VectorXd a = Eigen::VectorXd::Zero(kNoiseOrder), of_errors, w;
    double variance = std::max(1e-300, e.squaredNorm() / n);
    for (int pass = 0; pass < kPasses; ++pass) {
      Columns A(p + q, p + q);
      A << XX_.whitened_by(a), FX.whitened_by(a).transpose(), FX.whitened_by(a), FF.whitened_by(a);
      Eigen::VectorXd right(p + q);
      right << Xe.whitened_by(a), Fe.whitened_by(a);
      A /= variance;
      A.diagonal().head(p).array() += 1.0;
      A.diagonal().array() += 1e-12;
      of_errors = A.ldlt().solve(right / variance);
      const Eigen::VectorXd left = e - X_ * of_errors.head(p) - free * of_errors.tail(q);
      w = mpm::whitened_by(a, left);
      variance = std::max(1e-300, w.squaredNorm() / static_cast<double>(w.size()));
      if (pass + 1 < kPasses)
        a = autoregression_of(left);
    }
    if (innovations != nullptr)
      *innovations = w;
    return -0.5 * n * std::log(variance) - 0.5 * of_errors.head(p).squaredNorm();
  }

  std::vector<Eigen::Index> samples_;
  Columns X_, Q_;
  LaggedProducts XX_;
  Eigen::VectorXd e_;
  double none_ = 0.0;
};

/// The moves of the inputs of a CV behind their dead times, N x columns.
Columns moves_of(const Study& study, const AssessedLoop& loop, Eigen::Index cv) {
  constexpr Eigen::Index kLags = 6;
  const Eigen::Index N = loop.samples();
  std::vector<Eigen::VectorXd> all;
  for (Eigen::Index place = 0; place < study.mv_count() + study.md_count(); ++place) {
    const TransferFunction channel = study.assessed_channel(cv, place);
    if (channel.is_zero())
      continue;
    const Eigen::RowVectorXd u =
        place < study.mv_count() ? loop.u.row(place) : loop.d.row(place - study.mv_count());
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
      cvs_.emplace_back(loop, fit, cv);
      none_ += cvs_.back().none();
    }
  }

  RecordAlternatives all() {
    RecordAlternatives found{.disturbance = none_};
    found.mismatch = mismatch();
    data(found);
    sensor(found);
    valve(found);
    const Columns none(loop_.samples(), 0);
    const auto none_of = [this](Eigen::Index) -> Eigen::RowVectorXd {
      return Eigen::RowVectorXd::Zero(loop_.samples());
    };
    found.fit[RecordSource::disturbance] = dependence(none_of, none);
    found.fit[RecordSource::sensor] = found.fit[RecordSource::disturbance];
    found.fit[RecordSource::data] = dependence(
        [this, &found](Eigen::Index cv) -> Eigen::RowVectorXd {
          const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
          const bool is_late = found.data_cv < 0 || found.data_cv == cv;
          return late_by(y_sim, is_late ? found.late : 0.0) - y_sim;
        },
        none);
    if (found.valve_mv >= 0)
      found.fit[RecordSource::valve] = dependence(
          [this, &found](Eigen::Index cv) -> Eigen::RowVectorXd {
            const TransferFunction channel = study_.assessed_channel(cv, found.valve_mv);
            if (channel.is_zero())
              return Eigen::RowVectorXd::Zero(loop_.samples());
            return channel_response(discretise(channel, study_.controller.sample_time), off_, 0.0);
          },
          none);
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
      wrong(cv) = mismatch(cv);
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
  /// The largest F of a CV, where h(cv) and `free` are in its errors.
  template <class H>
  double dependence(H h, const Columns& free) const {
    double most = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv)
      if (const double F = of(cv).dependence(h(cv), free, moves_of(study_, loop_, cv)); F > most)
        most = F;
    return most;
  }

  /// N x channels of a CV, late.
  Columns responses(Eigen::Index cv, double late) const {
    std::vector<Eigen::RowVectorXd> all;
    for (Eigen::Index place = 0; place < study_.mv_count() + study_.md_count(); ++place)
      if (const TransferFunction channel = study_.assessed_channel(cv, place); !channel.is_zero())
        all.push_back(late_by(response(channel, input(place)), late));
    Columns columns(loop_.samples(), static_cast<Eigen::Index>(all.size()));
    for (std::size_t place = 0; place < all.size(); ++place)
      columns.col(static_cast<Eigen::Index>(place)) = all[place].transpose();
    return columns;
  }

  const CvErrors& of(Eigen::Index cv) const { return cvs_[static_cast<std::size_t>(cv)]; }
  /// N of the loop: the response of a channel to one input, from the onset on.
  Eigen::RowVectorXd response(const TransferFunction& channel, const Eigen::RowVectorXd& x) const {
    return channel_response(discretise(channel, study_.controller.sample_time), x, x(0));
  }
  Eigen::RowVectorXd input(Eigen::Index place) const {
    return place < study_.mv_count() ? loop_.u.row(place) : loop_.d.row(place - study_.mv_count());
  }

  /// The best single parameter of a channel of a CV.
  double mismatch(Eigen::Index cv) const {
    double best = of(cv).none();
    for (Eigen::Index place = 0; place < study_.mv_count() + study_.md_count(); ++place)
      best = std::max(best, of_channel(cv, place));
    return best;
  }

  /// That of each CV.
  double mismatch() const {
    double sum = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv)
      sum += mismatch(cv);
    return sum;
  }

  double of_channel(Eigen::Index cv, Eigen::Index place) const {
    constexpr double kTimes[] = {0.35, 0.5, 0.7, 1.4, 2.0, 2.8};
    constexpr double kShifts[] = {-3.0, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0};
    const TransferFunction channel = study_.assessed_channel(cv, place);
    if (channel.is_zero())
      return -kInfinity;
    const double parameters = onset_ > 0 ? 3.0 : 2.0;
    const double penalty = 0.5 * parameters * of(cv).log_samples();
    const Eigen::RowVectorXd u = input(place), nominal = response(channel, u);
    const auto masked = [this](Eigen::RowVectorXd h) {
      h.head(onset_).setZero();
      return h;
    };
    double best = of(cv).with(masked(nominal).transpose());
    const auto take = [&](MismatchParameter parameter, double size) {
      const TransferFunction other =
          with_mismatches(TransferMatrix{{channel}}, {{0, 0, parameter, size}})(0, 0);
      best = std::max(best, of(cv).without(masked(response(other, u) - nominal)));
    };
    for (const double factor : kTimes)
      take(MismatchParameter::time_constant, factor);
    for (const double shift : kShifts)
      if (const double time = shift * study_.controller.sample_time; channel.dead_time() + time >= 0.0)
        take(MismatchParameter::dead_time, time);
    return best - penalty;
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
    for (const double late : kLate) {
      double sum = 0.0, samples = 0.0;
      for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv) {
        const Eigen::RowVectorXd y_sim = loop_.y_sim.row(cv);
        const double here = of(cv).without(late_by(y_sim, late) - y_sim);
        sum += here;
        samples = std::max(samples, of(cv).log_samples());
        if (loop_.y.rows() > 1)
          take(none_ - of(cv).none() + here - of(cv).log_samples(), late, cv);
      }
      take(sum - 0.5 * samples, late, -1);
    }
  }

  void sensor(RecordAlternatives& found) const {
    constexpr Eigen::Index kStarts = 12;
    found.sensor = -kInfinity;
    const Eigen::Index N = loop_.samples();
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv)
      for (Eigen::Index start = 0; start < kStarts; ++start) {
        Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(N, 0.0, 1.0);
        ramp = (ramp.array() - static_cast<double>(start) / kStarts).max(0.0);
        const double here = none_ - of(cv).none() + of(cv).with(ramp) - of(cv).log_samples();
        if (here > found.sensor) {
          found.sensor = here;
          found.sensor_cv = cv;
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
          if (const double here = of_valve(mv, valve(size)); here > best) {
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
};

}  // namespace

Eigen::RowVectorXd late_by(const Eigen::RowVectorXd& y, double s) {
  Eigen::RowVectorXd late(y.size());
  const auto last = static_cast<double>(y.size() - 1);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double at = std::clamp(static_cast<double>(k) - s, 0.0, last);
    const auto before = static_cast<Eigen::Index>(std::min(at, last - 1.0));
    const double part = at - static_cast<double>(before);
    late(k) = (1.0 - part) * y(before) + part * y(before + 1);
  }
  return late;
}

RecordAlternatives record_alternatives(const Study& study, const AssessedLoop& loop, double delta,
                                       const std::optional<FaultOnset>& onset) {
  return Comparison(study, loop, delta, onset).all();
}

double input_dependence(const Study& study, const AssessedLoop& loop, const ChannelErrorFit& fit,
                        Eigen::Index cv) {
  return CvErrors(loop, fit, cv)
      .dependence(Eigen::RowVectorXd::Zero(loop.samples()), Columns(loop.samples(), 0),
                  moves_of(study, loop, cv));
}

LateCvs common_lateness(const Study& study, const AssessedLoop& loop, double delta) {
  return Comparison(study, loop, delta, {}).common_lateness();
}

}  // namespace mpm
