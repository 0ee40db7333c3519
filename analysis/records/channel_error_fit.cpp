#include "analysis/records/channel_error_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/coloured_noise.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/statistics/sample_spacing.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Returns the samples that are there. Sets `noise` to half of the mean squared difference of those that
/// follow each other at the smallest distance: one sample, or one period of an analyser.
std::vector<Eigen::Index> samples_of(const Eigen::RowVectorXd& e, double& noise) {
  std::vector<Eigen::Index> samples;
  for (Eigen::Index k = 0; k < e.size(); ++k)
    if (!std::isnan(e(k)))
      samples.push_back(k);
  const Eigen::Index closest = sample_spacing(e.transpose());
  double squares = 0.0, pairs = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (samples[i] - samples[i - 1] == closest) {
      squares += (e(samples[i]) - e(samples[i - 1])) * (e(samples[i]) - e(samples[i - 1]));
      pairs += 1.0;
    }
  if (pairs == 0.0)
    throw InputError("record of a CV", "fewer than two samples", "two or more");
  noise = 0.5 * squares / pairs;
  return samples;
}

/// Subtracts from e and X what the habit predicts of them, and keeps the samples whose past is known: the
/// samples before them follow each other at the smallest distance, `closest` samples.
void whiten(const NoiseHabit& habit, Eigen::Index closest, double least, ChannelErrorFit& fit) {
  fit.e -= fit.X * habit.errors;
  const Eigen::Index p = habit.autoregression.size();
  std::vector<Eigen::Index> kept, samples;  // places in the whitened signals, and in the loop
  for (std::size_t i = static_cast<std::size_t>(p); i < fit.samples.size(); ++i)
    if (fit.samples[i] - fit.samples[i - static_cast<std::size_t>(p)] == p * closest) {
      kept.push_back(static_cast<Eigen::Index>(i) - p);
      samples.push_back(fit.samples[i]);
    }
  if (std::ssize(kept) < 2)
    return;
  fit.e = Eigen::VectorXd(whitened_by(habit.autoregression, fit.e)(kept, 0));
  fit.X = Eigen::MatrixXd(whitened_by(habit.autoregression, fit.X)(kept, Eigen::all));
  fit.samples = std::move(samples);
  fit.noise = habit.variance + least;
}

}  // namespace

ChannelErrorSums& ChannelErrorSums::operator+=(const ChannelErrorSums& more) {
  XX += more.XX;
  Xe += more.Xe;
  ee += more.ee;
  n += more.n;
  return *this;
}

ChannelErrorSums& ChannelErrorSums::operator-=(const ChannelErrorSums& less) {
  XX -= less.XX;
  Xe -= less.Xe;
  ee -= less.ee;
  n -= less.n;
  return *this;
}

ChannelErrorSums sums_between(const ChannelErrorFit& fit, Eigen::Index first, Eigen::Index end) {
  const auto place = [&fit](Eigen::Index sample) {
    return std::lower_bound(fit.samples.begin(), fit.samples.end(), sample) - fit.samples.begin();
  };
  const Eigen::Index from = place(first), count = place(end) - from;
  constexpr double kConstant = 10.0;  // standard deviations of the noise
  Eigen::MatrixXd X(count, fit.X.cols() + 1);
  X << fit.X.middleRows(from, count), Eigen::VectorXd::Constant(count, kConstant * std::sqrt(fit.noise));
  const Eigen::VectorXd e = fit.e.segment(from, count);
  return {X.transpose() * X, X.transpose() * e, e.squaredNorm(), static_cast<double>(count)};
}

PartialErrorFit fit_of(const ChannelErrorSums& sums, double noise) {
  const Eigen::Index p = sums.Xe.size();
  PartialErrorFit fit;
  double variance = noise;
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LDLT<Eigen::MatrixXd> A(sums.XX / variance + Eigen::MatrixXd::Identity(p, p));
    fit.a = A.solve(sums.Xe / variance);
    fit.covariance = A.solve(Eigen::MatrixXd::Identity(p, p));
    fit.left = std::max(0.0, sums.ee - 2.0 * fit.a.dot(sums.Xe) + fit.a.dot(sums.XX * fit.a)) /
               std::max(1.0, sums.n);
    variance = std::max(noise, fit.left);
  }
  fit.a.conservativeResize(p - 1);
  return fit;
}

ChannelErrorFits::ChannelErrorFits(const Study& study, double delta, std::shared_ptr<const ModelHabit> habit)
    : study_(study), settling_(slowest_settling(study)), habit_(std::move(habit)) {
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(study.plant.G.cols(), 1);
  const Eigen::RowVectorXd nothing = Eigen::RowVectorXd::Constant(1, kNaN);
  for (Eigen::Index cv = 0; delta > 0.0 && cv < study.cv_count(); ++cv) {
    priors_.push_back(relative_errors(study, cv, delta, 0.0));
    errors_.emplace_back(study, cv, priors_.back(), nothing, inputs, inputs.col(0), 1.0, BaseNoise{1.0});
  }
}

ChannelErrorFit ChannelErrorFits::of(const AssessedLoop& loop, Eigen::Index cv) const {
  ChannelErrorFit fit;
  const Eigen::RowVectorXd all = loop.y.row(cv) - loop.y_sim.row(cv);
  fit.samples = samples_of(all, fit.noise);
  const std::vector<Eigen::Index> samples = fit.samples;
  const double least = variance_floor(loop.y_sim.row(cv).transpose());
  fit.noise += least;
  fit.e = all(samples).transpose();
  const Eigen::VectorXd& e = fit.e;
  fit.left = e.squaredNorm() / static_cast<double>(e.size());
  if (errors_.empty())
    return fit;
  fit.errors = priors_[static_cast<std::size_t>(cv)].channels;
  const Eigen::MatrixXd inputs = model_inputs(loop.from_start());
  fit.X = errors_[static_cast<std::size_t>(cv)]
              .slopes(inputs, inputs.col(0))  // the inputs before the record are not known
              .middleCols(loop.first, loop.samples())(Eigen::all, samples)
              .transpose();
  const Eigen::MatrixXd U = untold_columns(study_, cv, starts_after_unknown(loop.y, settling_),
                                           loop.samples())(samples, Eigen::all);
  if (e.size() > U.cols())
    fit.X -= U * U.completeOrthogonalDecomposition().solve(fit.X);
  if (habit_ && habit_->noise[static_cast<std::size_t>(cv)])
    whiten(*habit_->noise[static_cast<std::size_t>(cv)], sample_spacing(all.transpose()), least, fit);
  // The noise of errors that no channel explains is larger than that of their differences.
  double noise = fit.noise;
  for (int pass = 0; pass < 2; ++pass) {
    Eigen::MatrixXd A = fit.X.transpose() * fit.X / noise;
    A.diagonal().array() += 1.0;
    fit.a = A.ldlt().solve(fit.X.transpose() * e / noise);
    fit.left = (e - fit.X * fit.a).squaredNorm() / static_cast<double>(e.size());
    noise = std::max(fit.noise, fit.left);
  }
  return fit;
}

}  // namespace mpm
