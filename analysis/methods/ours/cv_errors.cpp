#include "analysis/methods/ours/cv_errors.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "analysis/statistics/chi_squared.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Largest lags of the errors of other CVs beside those of a CV, and of the errors of all CVs in
/// input_dependence(). Like the other constants of the noise, they were chosen on records of others' plants
/// under the seeds 83 and 84 (tests/reliability/records.py).
constexpr Eigen::Index kOtherLags = 6, kOwnLags = 12;

constexpr int kFits = 3;
constexpr Eigen::Index kFewestInPart = 50;  ///< samples on either side of a change of the noise
constexpr double kRounding = 1e-14;  ///< of the mean square of the errors: if less is left, it counts as this

constexpr Eigen::Index kLags = kErrorOrder + 1, kLagPairs = kLags * (kLags + 1) / 2;

/// The place of a pair of lags, l <= m, in LaggedProducts.
constexpr Eigen::Index pair_of(Eigen::Index l, Eigen::Index m) {
  return l * kLags - l * (l - 1) / 2 + m - l;
}

/// Q of A = Q R, n x m.
Columns basis_of(const Columns& A) {
  return Eigen::HouseholderQR<Columns>(A).householderQ() * Columns::Identity(A.rows(), A.cols());
}

/// The lags, from the same sample on, at which errors of a CV tell about a disturbance.
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

/// Returns `lags`, or fewer, so that there are ten times as many `samples` as columns.
Eigen::Index fitting_lags(const AssessedLoop& loop, Eigen::Index samples, Eigen::Index lags) {
  constexpr Eigen::Index kSamplesToColumn = 10;
  return std::clamp<Eigen::Index>(samples / (kSamplesToColumn * loop.y.rows()), 1,
                                  std::min(lags, loop.samples() - 1));
}

/// The errors of other CVs, which show a disturbance that reaches several CVs, for a CV that has `samples`:
/// their errors before, and for the CVs above it also those in the same sample, so that errors of one sample
/// that are alike count once.
Columns others_errors(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index samples) {
  const Eigen::Index lags = fitting_lags(loop, samples, kOtherLags);
  std::vector<PastErrors> asked;
  for (Eigen::Index other = 0; other < loop.y.rows(); ++other)
    if (other != cv)
      asked.push_back({other, other < cv ? 0 : 1, lags});
  return past_errors(loop, asked);
}

/// The past errors of all CVs: what the controller knows of a disturbance of any shape, for a CV that has
/// `samples`.
Columns known_errors(const AssessedLoop& loop, Eigen::Index samples) {
  const Eigen::Index lags = fitting_lags(loop, samples, kOwnLags);
  std::vector<PastErrors> asked;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    asked.push_back({cv, 1, lags});
  return past_errors(loop, asked);
}

/// A part of the record under a hypothesis T, and the noise in it: an autoregression a, and the mean square
/// of its innovations.
struct PartUnderHypothesis {
  const LaggedProducts& known;  ///< of Z = [X E_i e]
  LaggedProducts across, own;   ///< of Z and T, of T and T
  Eigen::VectorXd a;
  double count = 0.0, least = 0.0, variance = 0.0;

  /// Starts with Z x + T y as the noise, of the autoregression a.
  void start(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Part part) {
    count = static_cast<double>(part.first + part.count - std::max(part.first, kErrorOrder));
    least = std::max(1e-300, kRounding * lagged(x, y)(0, 0) / count);
    take(x, y, false);
  }

  /// Takes the variance of Z x + T y under a and then, if it `fits`, the a of Z x + T y.
  void take(const Eigen::VectorXd& x, const Eigen::VectorXd& y, bool fits) {
    const Eigen::MatrixXd R = lagged(x, y);
    Eigen::VectorXd factors(kLags);
    factors << 1.0, -a;
    variance = std::max(least, factors.dot(R * factors) / count);
    if (!fits)
      return;
    Eigen::MatrixXd past = R.bottomRightCorner(kErrorOrder, kErrorOrder);
    past.diagonal().array() += 1e-12 * past.trace() + 1e-300;
    a = past.ldlt().solve(R.col(0).tail(kErrorOrder));
  }

  /// The normal equations of the p columns of Z before e and the first q columns of T. If T has one more,
  /// that is h, and the right side (p + q) is that of e - h.
  Columns normal_equations(Eigen::Index p, Eigen::Index q, Eigen::VectorXd& right) const {
    const Columns of_known = known.whitened_by(a), of_both = across.whitened_by(a),
                  of_own = own.whitened_by(a);
    Columns A(p + q, p + q);
    A << of_known.topLeftCorner(p, p), of_both.topLeftCorner(p, q), of_both.topLeftCorner(p, q).transpose(),
        of_own.topLeftCorner(q, q);
    right.resize(p + q);
    right << of_known.col(p).head(p), of_both.row(p).head(q).transpose();
    if (of_own.cols() > q) {
      right.head(p) -= of_both.col(q).head(p);
      right.tail(q) -= of_own.col(q).head(q);
    }
    right /= variance;
    return A / variance;
  }

 private:
  /// Products of Z x + T y, one late by l samples and the other by m.
  Eigen::MatrixXd lagged(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
    Eigen::VectorXd pairs = known.of(x, x);
    if (y.size() > 0)
      pairs += 2.0 * across.of(x, y) + own.of(y, y);
    Eigen::MatrixXd R(kLags, kLags);
    for (Eigen::Index l = 0; l < kLags; ++l)
      for (Eigen::Index m = l; m < kLags; ++m)
        R(l, m) = R(m, l) = (l == m ? 1.0 : 0.5) * pairs(pair_of(l, m));
    return R;
  }
};

}  // namespace

LaggedProducts::LaggedProducts(const Columns& A, const Columns& B, Part part)
    : rows_(A.cols()), columns_(B.cols()), pairs_(rows_ * columns_, kLagPairs) {
  const Eigen::Index end = part.first + part.count, first = std::max(part.first, kErrorOrder);
  const Eigen::Index count = end - first, before = first - kErrorOrder;
  // `shifted` has B late by the lags -6 ... 6 beside the rows of A from `before` on: for A_0' B_m the samples
  // from `first` on, for A_l' B_0 those from `first` - l on.
  Columns shifted = Columns::Zero(count + kErrorOrder, (2 * kLags - 1) * columns_);
  for (Eigen::Index lag = 0; lag < kLags; ++lag) {
    shifted.middleCols((kErrorOrder + lag) * columns_, columns_).bottomRows(count) =
        B.middleRows(first - lag, count);
    shifted.middleCols((kErrorOrder - lag) * columns_, columns_).middleRows(kErrorOrder - lag, count) =
        B.middleRows(first, count);
  }
  const Columns sums = A.middleRows(before, count + kErrorOrder).transpose() * shifted;
  // Goes from A_l' B_m to the next pair of lags with the same difference m - l: one sample enters at the
  // start, and one leaves at the end. `below` has the difference with the other sign.
  const auto slid = [&](Columns& sum, Eigen::Index l, Eigen::Index m) {
    sum += A.row(first - 1 - l).transpose() * B.row(first - 1 - m) -
           A.row(end - 1 - l).transpose() * B.row(end - 1 - m);
  };
  for (Eigen::Index lag = 0; lag < kLags; ++lag) {
    Columns above = sums.middleCols((kErrorOrder + lag) * columns_, columns_);
    Columns below = sums.middleCols((kErrorOrder - lag) * columns_, columns_);
    for (Eigen::Index l = 0; l + lag < kLags; ++l) {
      pairs_.col(pair_of(l, l + lag)) = above.reshaped();
      if (lag > 0)
        pairs_.col(pair_of(l, l + lag)) += below.reshaped();
      if (l + lag + 1 == kLags)
        break;
      slid(above, l, l + lag);
      slid(below, l + lag, l);
    }
  }
}

LaggedProducts& LaggedProducts::operator+=(const LaggedProducts& more) {
  pairs_ += more.pairs_;
  return *this;
}

Columns LaggedProducts::whitened_by(const Eigen::VectorXd& a) const {
  Eigen::VectorXd factors(kLags), products(kLagPairs);
  factors << 1.0, -a;
  for (Eigen::Index l = 0; l < kLags; ++l)
    for (Eigen::Index m = l; m < kLags; ++m)
      products(pair_of(l, m)) = factors(l) * factors(m);
  const Eigen::VectorXd sum = pairs_ * products;
  return sum.reshaped(rows_, columns_);
}

Eigen::VectorXd LaggedProducts::of(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
  const Columns weights = x * y.transpose();
  return pairs_.transpose() * weights.reshaped();
}

CvErrors::CvErrors(const AssessedLoop& loop, Eigen::Index cv, std::vector<Eigen::Index> samples,
                   const Eigen::VectorXd& e, const Columns& X)
    : samples_(std::move(samples)) {
  const Columns others = others_errors(loop, cv, e.size());
  const Eigen::Index n = e.size(), p = X.size() == 0 ? 0 : X.cols();
  if (!loop.untold.empty()) {
    const Columns untold = loop.untold[static_cast<std::size_t>(cv)](Eigen::all, samples_).transpose();
    Q_ = basis_of(untold);
  }
  Xe_.resize(n, p + others.cols() + 1);
  if (p > 0)
    Xe_.leftCols(p) = told(X);
  Xe_.middleCols(p, others.cols()) = others(samples_, Eigen::all);
  errors_ = p;
  Xe_.rightCols(1) = told(e);
  if (is_too_short())
    return;
  parts_ = {{{0, n}, {Xe_, Xe_, {0, n}}, Eigen::VectorXd::Zero(kErrorOrder)}};
  none_ = settled(parts_);
}

void CvErrors::find_change() {
  constexpr Eigen::Index kTried = 24;
  const Eigen::Index n = Xe_.rows();
  if (is_too_short())
    return;
  std::vector<NoisePart> between;  // the changes
  Eigen::Index first = 0;
  for (Eigen::Index part = 1; part <= kTried; ++part) {
    const Eigen::Index change = part * n / kTried;
    if (change < n && (change < kFewestInPart || n - change < kFewestInPart))
      continue;
    const Part here{first, change - first};
    between.push_back({here, {Xe_, Xe_, here}, parts_.front().a});
    first = change;
  }
  if (between.size() < 2)
    return;
  const auto joined = [&between](std::size_t from, std::size_t to) {
    NoisePart all = between[from];
    for (std::size_t i = from + 1; i < to; ++i) {
      all.part.count += between[i].part.count;
      all.known += between[i].known;
    }
    return all;
  };
  const double penalty =
      0.5 * static_cast<double>(kErrorOrder + 2 + Xe_.cols() - 1 - errors_) * log_samples();
  double most = none_;
  for (std::size_t change = 1; change < between.size(); ++change) {
    std::vector<NoisePart> parts{joined(0, change), joined(change, between.size())};
    const double here = settled(parts);
    if (here - penalty > most) {
      most = here - penalty;
      none_ = here;
      parts_ = std::move(parts);
    }
  }
}

double CvErrors::dependence(const AssessedLoop& loop, const Eigen::RowVectorXd& h, const Columns& free,
                            const Columns& moves) const {
  constexpr double kChance = 0.01;  // over all CVs
  constexpr double kSame = 1e-10;   // eigenvalues of what the past leaves of the moves
  if (is_too_short())
    return kNaN;
  const Columns past = known_errors(loop, Xe_.rows());
  const double level = kChance / static_cast<double>(loop.y.rows());
  const Columns hypothesis = told_columns(free, &h);
  const Fit best = fit(parts_, hypothesis, free.cols());
  const Part last = parts_.back().part;
  const auto since = [this, &last](const Columns& signals) -> Columns {
    return signals(std::vector<Eigen::Index>(samples_.end() - last.count, samples_.end()), Eigen::all);
  };
  Eigen::VectorXd w =
      Xe_.bottomRows(last.count) * best.of_known + hypothesis.bottomRows(last.count) * best.of_hypothesis;
  Columns P(last.count, past.cols() + 1), M = since(moves);
  P << since(past), Eigen::VectorXd::Ones(last.count);
  const Eigen::VectorXd sizes = M.colwise().norm().transpose().cwiseMax(1e-300);
  M = M * sizes.cwiseInverse().asDiagonal();
  Columns PP = P.transpose() * P;
  PP.diagonal() *= 1.0 + 1e-13;
  const Eigen::LDLT<Columns> known(PP);
  M -= P * known.solve(P.transpose() * M);
  w -= P * known.solve(P.transpose() * w);
  const Eigen::SelfAdjointEigenSolver<Columns> of_moves(M.transpose() * M);
  const Eigen::VectorXd& values = of_moves.eigenvalues();
  const Eigen::Index p = (values.array() > kSame).count();
  if (p == 0 || last.count <= P.cols() + p || w.isZero(0.0))
    return kNaN;
  const Columns V = of_moves.eigenvectors().rightCols(p);
  const Eigen::VectorXd Mw = V.transpose() * (M.transpose() * w);
  const Columns wM = w.asDiagonal() * M;
  const Columns S = V.transpose() * (wM.transpose() * wM) * V;
  return Mw.dot(S.ldlt().solve(Mw)) / chi_squared_upper_quantile(level, static_cast<double>(p));
}

Columns CvErrors::told_columns(const Columns& free, const Eigen::RowVectorXd* h) const {
  const Eigen::Index q = free.cols();
  Columns H(Xe_.rows(), q + (h != nullptr ? 1 : 0));
  H.leftCols(q) = free(samples_, Eigen::all);
  if (h != nullptr)
    H.col(q) = (*h)(samples_).transpose();
  return told(std::move(H));
}

Columns CvErrors::told(Columns signals) const {
  if (Q_.size() > 0)
    signals -= Q_ * (Q_.transpose() * signals);
  return signals;
}

double CvErrors::settled(std::vector<NoisePart>& parts) const {
  constexpr int kMostRounds = 10;
  constexpr double kNext = 0.05;  // of L: a round that gains less is the last
  double most = -kInfinity;
  for (int round = 0; round < kMostRounds; ++round) {
    const Fit best = fit(parts, Columns(Xe_.rows(), 0), 0);
    if (best.log_likelihood < most + kNext)
      break;
    most = best.log_likelihood;
    for (std::size_t i = 0; i < parts.size(); ++i)
      parts[i].a = best.noises[i];
  }
  return most;
}

CvErrors::Fit CvErrors::fit(const std::vector<NoisePart>& parts, const Columns& hypothesis,
                            Eigen::Index free) const {
  Fit best{0.0, Eigen::VectorXd::Zero(Xe_.cols()), Eigen::VectorXd::Zero(hypothesis.cols())};
  if (is_too_short())
    return best;
  const Eigen::Index p = Xe_.cols() - 1, own = p - errors_, q = free, all_own = std::ssize(parts) * own,
                     unknown = errors_ + all_own + q;
  // What is left is [X E_i e] x + [F h] y, at first e - h. The unknowns are a, the b of each part, and the
  // coefficients of F.
  Eigen::VectorXd x = Eigen::VectorXd::Unit(p + 1, p), y = Eigen::VectorXd::Zero(hypothesis.cols());
  y.tail(hypothesis.cols() - q).setConstant(-1.0);
  std::vector<PartUnderHypothesis> all;
  for (const NoisePart& part : parts) {
    all.push_back({part.known, {Xe_, hypothesis, part.part}, {hypothesis, hypothesis, part.part}, part.a});
    all.back().start(x, y, part.part);
  }
  const auto places_of = [&](Eigen::Index part) {
    std::vector<Eigen::Index> places;
    for (Eigen::Index column = 0; column < p + q; ++column)
      places.push_back(column < errors_ ? column
                       : column < p     ? column + part * own
                                        : column - p + unknown - q);
    return places;
  };
  for (int pass = 0; pass < kFits; ++pass) {
    Columns A = Columns::Zero(unknown, unknown);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknown);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<Eigen::Index> places = places_of(static_cast<Eigen::Index>(i));
      Eigen::VectorXd r;
      A(places, places) += all[i].normal_equations(p, q, r);
      right(places) += r;
    }
    A.diagonal().head(errors_).array() += 1.0;
    A.diagonal().array() += 1e-12;
    const Eigen::VectorXd sizes = A.ldlt().solve(right);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<Eigen::Index> places = places_of(static_cast<Eigen::Index>(i));
      const Eigen::VectorXd of_part = sizes(places);
      x.head(p) = -of_part.head(p);
      y.head(q) = -of_part.tail(q);
      all[i].take(x, y, pass + 1 < kFits);
    }
    best.log_likelihood = -0.5 * sizes.head(errors_).squaredNorm();
  }
  for (const PartUnderHypothesis& part : all)
    best.noises.push_back(part.a);
  best.of_known = std::move(x);
  best.of_hypothesis = std::move(y);
  for (std::size_t i = 0; i < parts.size(); ++i)
    best.log_likelihood -= 0.5 * static_cast<double>(parts[i].part.count) * std::log(all[i].variance);
  return best;
}

}  // namespace mpm
