#include "analysis/records/channel_error_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/statistics/sample_spacing.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The samples that are there, and half of the mean squared difference of those that follow each other as
/// closely as any two do: one sample apart, or a period of an analyser.
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

}  // namespace

ChannelErrorFits::ChannelErrorFits(const Study& study, double delta)
    : study_(study), settling_(slowest_settling(study)) {
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
  const std::vector<Eigen::Index> samples = samples_of(all, fit.noise);
  fit.noise += variance_floor(loop.y_sim.row(cv).transpose());
  const Eigen::VectorXd e = all(samples).transpose();
  const auto n = static_cast<double>(e.size());
  fit.left = e.squaredNorm() / n;
  if (errors_.empty())
    return fit;
  fit.errors = priors_[static_cast<std::size_t>(cv)].channels;
  const Eigen::MatrixXd inputs = model_inputs(loop.from_start());
  fit.X = errors_[static_cast<std::size_t>(cv)]
              .slopes(inputs, inputs.col(0))  // what moved the model before the record is not known
              .middleCols(loop.first, loop.samples())(Eigen::all, samples)
              .transpose();
  const Eigen::MatrixXd U = untold_columns(study_, cv, starts_after_unknown(loop.y, settling_),
                                           loop.samples())(samples, Eigen::all);
  if (e.size() > U.cols())
    fit.X -= U * U.completeOrthogonalDecomposition().solve(fit.X);
  // The noise of errors that no channel explains is larger than that of their differences.
  double noise = fit.noise;
  for (int pass = 0; pass < 2; ++pass) {
    Eigen::MatrixXd A = fit.X.transpose() * fit.X / noise;
    A.diagonal().array() += 1.0;
    fit.a = A.ldlt().solve(fit.X.transpose() * e / noise);
    fit.left = (e - fit.X * fit.a).squaredNorm() / n;
    noise = std::max(fit.noise, fit.left);
  }
  return fit;
}

}  // namespace mpm
