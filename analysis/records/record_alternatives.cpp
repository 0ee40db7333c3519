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
#include "analysis/statistics/chi_squared.hpp"
#include "base/non_finite.hpp"
#include "plants/linear/zero_order_hold.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/valve_stem.hpp"
#include "scenarios/loop/record_rows.hpp"

namespace mpm {
namespace {

using Columns = Eigen::MatrixXd;

/// Order of the autoregression of the noise: approximates a disturbance behind two lags beside white noise.
constexpr Eigen::Index kOrder = 6;
/// Lags of the errors of other CVs beside those of a CV, and of all CVs in input_dependence(). Chosen, as
/// what else of the noise is, on records of others' plants under the seeds 83 and 84
/// (tests/reliability/records.py).
constexpr Eigen::Index kOtherLags = 6, kOwnLags = 12;

/// A_l' B_m of signals (n x .) that are l and m samples late, l, m <= kOrder, over the samples that have
/// a past of this length. The products of signals that an autoregression whitens follow from them without the
/// signals:
///
///   (A_0 - sum_l a_l A_l)' (B_0 - sum_m a_m B_m)
class LaggedProducts {
 public:
  LaggedProducts(const Columns& A, const Columns& B) {
    const Eigen::Index n = A.rows(), count = n - kOrder;
    const auto late = [count](const Columns& signals, Eigen::Index lag) {
      return signals.middleRows(kOrder - lag, count);
    };
    for (Eigen::Index m = 0; m < kLags; ++m)
      at(0, m) = late(A, 0).transpose() * late(B, m);
    for (Eigen::Index l = 1; l < kLags; ++l)
      at(l, 0) = &A == &B ? Columns(at(0, l).transpose()) : Columns(late(A, l).transpose() * late(B, 0));
    // One sample later a sample enters at the start, and one leaves at the end.
    for (Eigen::Index l = 0; l + 1 < kLags; ++l)
      for (Eigen::Index m = 0; m + 1 < kLags; ++m)
        at(l + 1, m + 1) = at(l, m) + A.row(kOrder - 1 - l).transpose() * B.row(kOrder - 1 - m) -
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
  static constexpr Eigen::Index kLags = kOrder + 1;

  Columns& at(Eigen::Index l, Eigen::Index m) { return products_[static_cast<std::size_t>(l * kLags + m)]; }
  const Columns& at(Eigen::Index l, Eigen::Index m) const {
    return products_[static_cast<std::size_t>(l * kLags + m)];
  }

  std::array<Columns, static_cast<std::size_t>(kLags* kLags)> products_;
};

/// Q of A = Q R, n x m.
Columns basis_of(const Columns& A) {
  return Eigen::HouseholderQR<Columns>(A).householderQ() * Columns::Identity(A.rows(), A.cols());
}

/// Which errors of a CV in the same sample and in those before tell of a disturbance.
struct PastErrors {
  Eigen::Index cv, first, last;  ///< lags
};

/// Errors of CVs, N x columns. A sample that is missing counts as 0.
Columns past_errors(const AssessedLoop& loop, const std::vector<PastErrors>& asked) {
  const Eigen::Index N = loop.samples();
  Eigen::Index column = 0;
  for (const PastErrors& of : asked)
    column += of.last - of.first + 1;
  Columns past = Columns::Zero(N, column);
  column = 0;
  for (const PastErrors& of : asked) {
    const Eigen::VectorXd e = (loop.y.row(of.cv) - loop.y_sim.row(of.cv)).transpose();
    for (Eigen::Index lag = of.first; lag <= of.last; ++lag)
      past.col(column++).tail(N - lag) = e.array().isNaN().select(0.0, e).head(N - lag);
  }
  return past;
}

/// `lags`, or fewer: of `samples` there are ten times as many as columns.
Eigen::Index fitting_lags(const AssessedLoop& loop, Eigen::Index samples, Eigen::Index lags) {
  constexpr Eigen::Index kSamplesToColumn = 10;
  return std::clamp<Eigen::Index>(samples / (kSamplesToColumn * loop.y.rows()), 1,
                                  std::min(lags, loop.samples() - 1));
}

/// What a disturbance that reaches several CVs shows of this one, which has `samples`, in the others: their
/// errors before, and of those above it in the same sample, too, so that errors of one sample that are alike
/// count once.
Columns others_errors(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index samples) {
  const Eigen::Index lags = fitting_lags(loop, samples, kOtherLags);
  std::vector<PastErrors> asked;
  for (Eigen::Index other = 0; other < loop.y.rows(); ++other)
    if (other != cv)
      asked.push_back({other, other < cv ? 0 : 1, lags});
  return past_errors(loop, asked);
}

/// What the controller knows of a disturbance of any shape in a CV that has `samples`.
Columns known_errors(const AssessedLoop& loop, Eigen::Index samples) {
  const Eigen::Index lags = fitting_lags(loop, samples, kOwnLags);
  std::vector<PastErrors> asked;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    asked.push_back({cv, 1, lags});
  return past_errors(loop, asked);
}

/// Samples that follow each other.
struct Part {
  Eigen::Index first, count;

  Columns of(const Columns& signals) const { return signals.middleRows(first, count); }
};

/// One CV: its errors, and how likely they are under a hypothesis. From some sample on the noise may be
/// another one.
class CvErrors {
 public:
  CvErrors(const AssessedLoop& loop, const ChannelErrorFit& fit, Eigen::Index cv) : samples_(fit.samples) {
    const Columns others = others_errors(loop, cv, fit.e.size());
    const Eigen::Index p = fit.X.size() == 0 ? 0 : fit.X.cols();
    X_.resize(fit.e.size(), p + others.cols());
    if (p > 0)
      X_.leftCols(p) = fit.X;
    X_.rightCols(others.cols()) = others(samples_, Eigen::all);
    prior_ = Eigen::VectorXd::Zero(X_.cols());
    prior_.head(p).setOnes();
    if (!loop.untold.empty()) {
      const Columns untold = loop.untold[static_cast<std::size_t>(cv)](Eigen::all, samples_).transpose();
      Q_ = basis_of(untold);
    }
    e_ = told(fit.e);
    divide(e_.size());
  }

  /// Lets the noise be another one from the best of some samples on, or from `onset` on, where that explains
  /// the errors better.
  void find_change(Eigen::Index onset) {
    constexpr Eigen::Index kTried = 12;
    const double penalty = 0.5 * (kOrder + 2.0) * log_samples();
    Eigen::Index best = e_.size();
    double most = none_;
    const auto take = [&](Eigen::Index change) {
      if (change < kFewestSamples || e_.size() - change < kFewestSamples)
        return;
      divide(change);
      if (none_ - penalty > most) {
        most = none_ - penalty;
        best = change;
      }
    };
    take(std::lower_bound(samples_.begin(), samples_.end(), onset) - samples_.begin());
    for (Eigen::Index part = 1; part < kTried; ++part)
      take(part * e_.size() / kTried);
    divide(best);
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

  /// input_dependence() since the noise changed, where h and `free` are in the errors; `moves` of the inputs
  /// (N of the loop).
  double dependence(const AssessedLoop& loop, const Eigen::RowVectorXd& h, const Columns& free,
                    const Columns& moves) const {
    constexpr double kChance = 0.01;  // over all CVs
    if (e_.size() <= kOrder)
      return kNaN;
    const Columns past = known_errors(loop, e_.size());
    const double level = kChance / static_cast<double>(loop.y.rows());
    Eigen::VectorXd left;
    log_likelihood(e_ - told(h(samples_).transpose()), told_columns(free), &left);
    const Part& last = parts_.back();
    const auto since = [this, &last](const Columns& signals) -> Columns {
      return last.of(signals(samples_, Eigen::all));
    };
    Columns P(last.count, past.cols() + 1), M = since(moves);
    P << since(past), Eigen::VectorXd::Ones(last.count);
    const Columns known = basis_of(P);
    M -= known * (known.transpose() * M);
    Eigen::VectorXd w = last.of(left);
    w -= known * (known.transpose() * w);
    Eigen::ColPivHouseholderQR<Columns> qr(M);
    const Eigen::Index p = qr.rank();
    if (p == 0 || last.count <= known.cols() + p || w.isZero(0.0))
      return kNaN;
    const Columns Z = qr.householderQ() * Columns::Identity(last.count, p);
    const Eigen::VectorXd Zw = Z.transpose() * w;
    const Columns S = Z.transpose() * w.array().square().matrix().asDiagonal() * Z;
    return Zw.dot(S.ldlt().solve(Zw)) / chi_squared_upper_quantile(level, static_cast<double>(p));
  }

 private:
  static constexpr int kPasses = 3;
  static constexpr Eigen::Index kFewestSamples = 50;

  /// The noise changes after this many samples.
  void divide(Eigen::Index change) {
    parts_ = {{0, change}};
    if (change < e_.size())
      parts_.push_back({change, e_.size() - change});
    XX_.clear();
    if (e_.size() <= kOrder)
      return;
    for (const Part& part : parts_) {
      const Columns X = part.of(X_);
      XX_.emplace_back(X, X);
    }
    none_ = log_likelihood(e_, Columns(e_.size(), 0));
  }

  /// What is known of a part, and the noise that it has.
  struct NoisePart {
    LaggedProducts Xe, FX, FF, Fe;
    double variance;
    Eigen::VectorXd a = Eigen::VectorXd::Zero(kOrder);
  };

  Eigen::VectorXd told(const Eigen::VectorXd& signal) const {
    return Q_.size() == 0 ? signal : Eigen::VectorXd(signal - Q_ * (Q_.transpose() * signal));
  }

  Columns told_columns(const Columns& free) const {
    Columns H(e_.size(), free.cols());
    for (Eigen::Index column = 0; column < free.cols(); ++column)
      H.col(column) = told(free.col(column)(samples_));
    return H;
  }

  /// 0 of a CV that has too few samples to tell anything.
  double log_likelihood(const Eigen::VectorXd& e, const Columns& free,
                        Eigen::VectorXd* left = nullptr) const {
    if (e.size() <= kOrder)
      return 0.0;
    const Eigen::Index p = X_.cols(), q = free.cols();
    std::vector<NoisePart> noises;
    for (const Part& part : parts_) {
      const Columns X = part.of(X_), F = part.of(free), own = part.of(e);
      noises.push_back({{X, own},
                        {F, X},
                        {F, F},
                        {F, own},
                        std::max(1e-300, own.squaredNorm() / static_cast<double>(part.count))});
    }
    Eigen::VectorXd of_errors, errors = e;
    for (int pass = 0; pass < kPasses; ++pass) {
      Columns A = Columns::Zero(p + q, p + q);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(p + q);
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const NoisePart& noise = noises[i];
        const Columns FX = noise.FX.whitened_by(noise.a);
        A.topLeftCorner(p, p) += XX_[i].whitened_by(noise.a) / noise.variance;
        A.topRightCorner(p, q) += FX.transpose() / noise.variance;
        A.bottomLeftCorner(q, p) += FX / noise.variance;
        A.bottomRightCorner(q, q) += noise.FF.whitened_by(noise.a) / noise.variance;
        right.head(p) += noise.Xe.whitened_by(noise.a) / noise.variance;
        right.tail(q) += noise.Fe.whitened_by(noise.a) / noise.variance;
      }
      A.diagonal().head(p) += prior_;
      A.diagonal().array() += 1e-12;
      of_errors = A.ldlt().solve(right);
      errors = e - X_ * of_errors.head(p) - free * of_errors.tail(q);
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Eigen::VectorXd own = parts_[i].of(errors), w = mpm::whitened_by(noises[i].a, own);
        noises[i].variance = std::max(1e-300, w.squaredNorm() / static_cast<double>(w.size()));
        if (pass + 1 < kPasses)
          noises[i].a = autoregression_of(own, kOrder);
      }
    }
    if (left != nullptr)
      *left = errors;
    double sum = -0.5 * prior_.dot(of_errors.head(p).cwiseAbs2());
    for (std::size_t i = 0; i < parts_.size(); ++i)
      sum -= 0.5 * static_cast<double>(parts_[i].count) * std::log(noises[i].variance);
    return sum;
  }

  std::vector<Eigen::Index> samples_;
  Columns X_, Q_;
  Eigen::VectorXd prior_;  ///< precision of the coefficients of X
  std::vector<Part> parts_;
  std::vector<LaggedProducts> XX_;  ///< of each part
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
  /// The largest F of a CV, where h(cv) and free(cv) are in its errors.
  template <class H, class Free>
  double dependence(H h, Free free) const {
    double most = 0.0;
    for (Eigen::Index cv = 0; cv < loop_.y.rows(); ++cv)
      if (const double F = of(cv).dependence(loop_, h(cv), free(cv), moves_of(study_, loop_, cv)); F > most)
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

  /// A mismatch of one parameter of the channel of an input, and by how much it is likelier than none.
  struct LikelyMismatch {
    Eigen::Index place = -1;
    MismatchParameter parameter = MismatchParameter::gain;
    double gain = -kInfinity;
  };

  /// The best one of a CV.
  LikelyMismatch mismatch(Eigen::Index cv) const {
    LikelyMismatch best;
    for (Eigen::Index place = 0; place < study_.mv_count() + study_.md_count(); ++place)
      if (const LikelyMismatch here = of_channel(cv, place); here.gain > best.gain)
        best = here;
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
      if (best.place < study_.mv_count())
        found.named = {{cv, best.place}, best.parameter};
    }
    found.mismatch = none_ + (most > 0.0 ? sum : most);
  }

  LikelyMismatch of_channel(Eigen::Index cv, Eigen::Index place) const {
    constexpr double kTimes[] = {0.35, 0.5, 0.7, 1.4, 2.0, 2.8};
    constexpr double kShifts[] = {-3.0, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0};
    LikelyMismatch best{.place = place};
    const TransferFunction channel = study_.assessed_channel(cv, place);
    if (channel.is_zero())
      return best;
    const double parameters = onset_ > 0 ? 3.0 : 2.0,
                 none = of(cv).none() + 0.5 * parameters * of(cv).log_samples();
    const Eigen::RowVectorXd u = input(place), nominal = response(channel, u);
    const auto masked = [this](Eigen::RowVectorXd h) {
      h.head(onset_).setZero();
      return h;
    };
    best.gain = of(cv).with(masked(nominal).transpose()) - none;
    const auto take = [&](MismatchParameter parameter, double size) {
      const TransferFunction other =
          with_mismatches(TransferMatrix{{channel}}, {{0, 0, parameter, size}})(0, 0);
      const double gain = of(cv).without(masked(response(other, u) - nominal)) - none;
      if (gain > best.gain)
        best = {place, parameter, gain};
    };
    for (const double factor : kTimes)
      take(MismatchParameter::time_constant, factor);
    for (const double shift : kShifts)
      if (const double time = shift * study_.controller.sample_time; channel.dead_time() + time >= 0.0)
        take(MismatchParameter::dead_time, time);
    return best;
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

  void sensor(RecordAlternatives& found) {
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
          drift_ = ramp;
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
  Eigen::VectorXd drift_;   ///< of the most likely sensor, of any size
};

}  // namespace

Eigen::RowVectorXd late_by(const Eigen::RowVectorXd& y, double s) {
  return rows_of_line({OutputSampling::snapshot, -s}, y);
}

RecordAlternatives record_alternatives(const Study& study, const AssessedLoop& loop, double delta,
                                       const std::optional<FaultOnset>& onset) {
  return Comparison(study, loop, delta, onset).all();
}

double input_dependence(const Study& study, const AssessedLoop& loop, const ChannelErrorFit& fit,
                        Eigen::Index cv) {
  return CvErrors(loop, fit, cv)
      .dependence(loop, Eigen::RowVectorXd::Zero(loop.samples()), Columns(loop.samples(), 0),
                  moves_of(study, loop, cv));
}

LateCvs common_lateness(const Study& study, const AssessedLoop& loop, double delta) {
  return Comparison(study, loop, delta, {}).common_lateness();
}

}  // namespace mpm
