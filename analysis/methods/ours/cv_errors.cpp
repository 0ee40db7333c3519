#include "analysis/methods/ours/cv_errors.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "analysis/methods/ours/coloured_noise.hpp"
#include "analysis/statistics/chi_squared.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Lags of the errors of other CVs beside those of a CV, and of all CVs in input_dependence(). Chosen, as
/// what else of the noise is, on records of others' plants under the seeds 83 and 84
/// (tests/reliability/records.py).
constexpr Eigen::Index kOtherLags = 6, kOwnLags = 12;

constexpr int kFits = 3;
constexpr Eigen::Index kFewestInPart = 50;  ///< to either side of a change of the noise

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

/// What is known of a part, and the noise that it has.
struct NoisePart {
  LaggedProducts Xe, FX, FF, Fe;
  double variance;
  Eigen::VectorXd a = Eigen::VectorXd::Zero(kErrorOrder);
};

}  // namespace

CvErrors::CvErrors(const AssessedLoop& loop, Eigen::Index cv, std::vector<Eigen::Index> samples,
                   const Eigen::VectorXd& e, const Columns& X)
    : samples_(std::move(samples)) {
  const Columns others = others_errors(loop, cv, e.size());
  const Eigen::Index p = X.size() == 0 ? 0 : X.cols();
  X_.resize(e.size(), p + others.cols());
  if (p > 0)
    X_.leftCols(p) = X;
  X_.rightCols(others.cols()) = others(samples_, Eigen::all);
  prior_ = Eigen::VectorXd::Zero(X_.cols());
  prior_.head(p).setOnes();
  if (!loop.untold.empty()) {
    const Columns untold = loop.untold[static_cast<std::size_t>(cv)](Eigen::all, samples_).transpose();
    Q_ = basis_of(untold);
  }
  e_ = told(e);
  divide(e_.size());
}

void CvErrors::find_change(Eigen::Index onset) {
  constexpr Eigen::Index kTried = 12;
  const double penalty = 0.5 * (kErrorOrder + 2.0) * log_samples();
  Eigen::Index best = e_.size();
  double most = none_;
  const auto take = [&](Eigen::Index change) {
    if (change < kFewestInPart || e_.size() - change < kFewestInPart)
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

double CvErrors::dependence(const AssessedLoop& loop, const Eigen::RowVectorXd& h, const Columns& free,
                            const Columns& moves) const {
  constexpr double kChance = 0.01;  // over all CVs
  if (e_.size() <= kErrorOrder)
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

void CvErrors::divide(Eigen::Index change) {
  parts_ = {{0, change}};
  if (change < e_.size())
    parts_.push_back({change, e_.size() - change});
  XX_.clear();
  if (e_.size() <= kErrorOrder)
    return;
  for (const Part& part : parts_) {
    const Columns X = part.of(X_);
    XX_.emplace_back(X, X);
  }
  none_ = log_likelihood(e_, Columns(e_.size(), 0));
}

Columns CvErrors::told_columns(const Columns& free) const {
  Columns H(e_.size(), free.cols());
  for (Eigen::Index column = 0; column < free.cols(); ++column)
    H.col(column) = told(free.col(column)(samples_));
  return H;
}

double CvErrors::log_likelihood(const Eigen::VectorXd& e, const Columns& free, Eigen::VectorXd* left) const {
  if (e.size() <= kErrorOrder)
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
  for (int pass = 0; pass < kFits; ++pass) {
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
      if (pass + 1 < kFits)
        noises[i].a = autoregression_of(own, kErrorOrder);
    }
  }
  if (left != nullptr)
    *left = errors;
  double sum = -0.5 * prior_.dot(of_errors.head(p).cwiseAbs2());
  for (std::size_t i = 0; i < parts_.size(); ++i)
    sum -= 0.5 * static_cast<double>(parts_[i].count) * std::log(noises[i].variance);
  return sum;
}

}  // namespace mpm
