#include "analysis/records/model_habit.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/coloured_noise.hpp"
#include "analysis/records/channel_health.hpp"

namespace mpm {
namespace {

/// Fits by generalised least squares. Otherwise noise that is not white, and moves of the controller that
/// answer it, would look like errors of the channels.
NoiseHabit noise_habit(const ChannelErrorFit& fit) {
  constexpr int kPasses = 5;
  NoiseHabit habit{.autoregression = Eigen::VectorXd::Zero(kNoiseOrder), .differences = fit.noise};
  Eigen::VectorXd a = fit.a;
  double variance = std::max(fit.noise, fit.left);
  for (int pass = 0; pass < kPasses; ++pass) {
    const Eigen::MatrixXd X = whitened_by(habit.autoregression, fit.X);
    const Eigen::VectorXd e = whitened_by(habit.autoregression, fit.e);
    Eigen::MatrixXd A = X.transpose() * X / variance;
    A.diagonal().array() += 1.0;
    a = A.ldlt().solve(X.transpose() * e / variance);
    habit.autoregression = autoregression_of(fit.e - fit.X * a);
    variance = std::max(std::numeric_limits<double>::min(),
                        whitened_by(habit.autoregression, fit.e - fit.X * a).squaredNorm() /
                            static_cast<double>(fit.e.size() - kNoiseOrder));
  }
  habit.errors = a;
  habit.variance = variance;
  habit.channel_score = error_score(a, 0.0, 1.0);
  return habit;
}

}  // namespace

std::shared_ptr<const ModelHabit> habit_of(const Study& study, double delta, const AssessedLoop& benchmark) {
  auto habit = std::make_shared<ModelHabit>();
  habit->first = benchmark.first;
  habit->end = benchmark.first + benchmark.samples();
  const ChannelErrorFits fits(study, delta);
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const Eigen::RowVectorXd e = benchmark.y.row(cv) - benchmark.y_sim.row(cv);
    const bool tells = (!e.array().isNaN()).count() >= kFewestNoiseSamples;
    habit->noise.push_back(tells ? std::optional(noise_habit(fits.of(benchmark, cv))) : std::nullopt);
  }
  return habit;
}

}  // namespace mpm
