#include "analysis/methods/model_errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "analysis/methods/base_noise.hpp"
#include "analysis/methods/mismatch_responses.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

/// Of a direction, over the whole record and in variances of the noise: what less has changes log L by less
/// than half of it.
constexpr double kFaintDirection = 0.05;
constexpr double kSmallestFactor = 0.05;
constexpr int kGaussNewtonSteps = 3;
/// Smallest noise against the size of the outputs: that of their rounding in a record without noise.
constexpr double kLeastNoise = 1e-6;

double variance_of(const Distribution& drawn) {
  switch (drawn.kind()) {
    case Distribution::Kind::constant:
      return 0.0;
    case Distribution::Kind::normal:
      return drawn.second() * drawn.second();
    case Distribution::Kind::uniform:
    case Distribution::Kind::log_uniform:
      break;
  }
  const double width = drawn.maximum() - drawn.minimum();
  return width * width / 12.0;
}

void add_error(std::vector<ChannelError>& errors, Eigen::Index input, MismatchParameter parameter,
               double deviation) {
  if (deviation > 0.0)
    errors.push_back({input, parameter, deviation});
}

/// A channel with one error, as far as it can have it.
TransferFunction with_error(const TransferFunction& channel, const ChannelError& error, double value) {
  if (error.parameter == MismatchParameter::dead_time)
    value = std::max(value, -channel.dead_time());
  else
    value = std::max(1.0 + value, kSmallestFactor);
  return with_mismatches(TransferMatrix{{channel}}, {{0, 0, error.parameter, value}})(0, 0);
}

/// Rows with the same Z' Z but for faint ones: along the axes of Z Z', of which few count.
Eigen::MatrixXd strong(const Eigen::MatrixXd& Z) {
  if (Z.rows() == 0)
    return Z;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Z * Z.transpose());
  const Eigen::Index faint = (eigen.eigenvalues().array() < kFaintDirection).count();
  return eigen.eigenvectors().rightCols(Z.rows() - faint).transpose() * Z;
}

/// Of the coefficients z ~ N(0, I) of the rows Z below the first one of `series`, e = Z' z + noise.
struct Coefficients {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Coefficients coefficients(const BaseNoise& noise, const Eigen::Ref<const Eigen::MatrixXd>& series) {
  double log_determinant = 0.0;
  const Eigen::MatrixXd white =
      whitened(base_models(noise, false).models, series / noise.deviation, log_determinant);
  const auto Z = white.bottomRows(white.rows() - 1);
  Eigen::MatrixXd covariance = (Z * Z.transpose() + Eigen::MatrixXd::Identity(Z.rows(), Z.rows())).inverse();
  return {covariance * (Z * white.row(0).transpose()), std::move(covariance)};
}

}  // namespace

ModelErrorPrior relative_errors(const Study& study, Eigen::Index cv, double share, double bias) {
  ModelErrorPrior prior{{}, bias};
  for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input) {
    const TransferFunction& channel = study.plant.G(cv, input);
    if (channel.is_zero())
      continue;
    add_error(prior.channels, input, MismatchParameter::gain, share);
    if (channel.order() > 0)
      add_error(prior.channels, input, MismatchParameter::time_constant, share);
    add_error(prior.channels, input, MismatchParameter::dead_time,
              share * std::max(channel.dead_time(), study.controller.sample_time));
  }
  return prior;
}

ModelErrorPrior drawn_errors(const Study& study, Eigen::Index cv) {
  ModelErrorPrior prior;
  if (!study.world)
    return prior;
  const WorldRanges& drawn = *study.world;
  for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input) {
    const TransferFunction& channel = study.plant.G(cv, input);
    if (channel.is_zero())
      continue;
    add_error(prior.channels, input, MismatchParameter::gain, std::sqrt(variance_of(drawn.gain_factor)));
    if (channel.order() > 0)
      add_error(prior.channels, input, MismatchParameter::time_constant,
                std::sqrt(variance_of(drawn.time_constant_factor)));
    add_error(prior.channels, input, MismatchParameter::dead_time,
              std::hypot(channel.dead_time() * std::sqrt(variance_of(drawn.dead_time_factor)),
                         std::sqrt(variance_of(drawn.dead_time_shift))));
  }
  return prior;
}

Eigen::MatrixXd model_inputs(const AssessedLoop& loop) {
  Eigen::MatrixXd inputs(loop.u.rows() + loop.d.rows(), loop.u.cols());
  inputs << loop.u, loop.d;
  return inputs;
}

ModelErrors::ModelErrors(const Study& study, Eigen::Index cv, const ModelErrorPrior& prior,
                         const Eigen::Ref<const Eigen::RowVectorXd>& e,
                         const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& initial, double least,
                         const std::optional<BaseNoise>& known)
    : ModelErrors(study, cv, known.value_or(BaseNoise{})) {
  bias_ = prior.bias;
  errors_ = prior.channels;
  const auto p = static_cast<Eigen::Index>(errors_.size());
  Eigen::MatrixXd unknown(p + (bias_ > 0.0 ? 1 : 0), e.size());
  unknown.bottomRows(unknown.rows() - p).setConstant(bias_ * std::max(deviation_of_steps(e), least));
  Eigen::MatrixXd series(1 + unknown.rows(), e.size());
  Coefficients known_errors{Eigen::VectorXd::Zero(unknown.rows()), {}};
  take(nominal_);
  // Gauss and Newton: where outputs move by a hundred times the noise, a slope is not enough.
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    unknown.topRows(p) = slopes(inputs, initial);
    const Eigen::RowVectorXd left =
        e - correction(inputs, initial) + known_errors.mean.head(p).transpose() * unknown.topRows(p);
    if (!known && step + 1 < kGaussNewtonSteps)
      noise_.best = {std::max(deviation_of_steps(left), least)};
    else if (!known)
      noise_ = noise_posterior(left, noise_.best.deviation * strong(unknown / noise_.best.deviation), least);
    series << left, unknown;
    known_errors = coefficients(noise_.best, series);
    take(with_errors(known_errors.mean.head(p)));
  }
  factor_ = known_errors.covariance.topLeftCorner(p, p).llt().matrixL();
}

ModelErrors::ModelErrors(const Study& study, Eigen::Index cv, const BaseNoise& noise)
    : sample_time_(study.controller.sample_time), nominal_(1, study.plant.G.cols()), noise_{noise, {}} {
  for (Eigen::Index input = 0; input < nominal_.cols(); ++input)
    nominal_(0, input) = study.plant.G(cv, input);
  model_ = nominal_;
}

Eigen::RowVectorXd ModelErrors::correction(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                           const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(inputs.cols());
  for (const Slope& change : corrected_)
    sum += change.response(inputs, initial);
  return sum;
}

Eigen::MatrixXd ModelErrors::slopes(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                    const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(slopes_.size()), inputs.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows.row(i) = slopes_[static_cast<std::size_t>(i)].response(inputs, initial);
  return rows;
}

Eigen::MatrixXd ModelErrors::slopes(Eigen::MatrixXd without, const Mismatch& mismatch,
                                    const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                    const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  Mismatch possible = mismatch;
  if (mismatch.parameter == MismatchParameter::dead_time)
    possible.value = std::max(mismatch.value, -model_(0, mismatch.input).dead_time());
  const TransferMatrix changed = with_mismatches(model_, {possible});
  for (Eigen::Index i = 0; i < without.rows(); ++i)
    if (const ChannelError& error = errors_[static_cast<std::size_t>(i)]; error.input == mismatch.input)
      without.row(i) = slope_of(changed, error).response(inputs, initial);
  return without;
}

Eigen::MatrixXd ModelErrors::directions(const Eigen::Ref<const Eigen::MatrixXd>& slopes) const {
  const Eigen::Index p = factor_.rows();
  Eigen::MatrixXd Z(p + (bias_ > 0.0 ? 1 : 0), slopes.cols());
  Z.topRows(p) = factor_.transpose() * slopes / noise_.best.deviation;
  Z.bottomRows(Z.rows() - p).setConstant(bias_);
  return strong(Z);
}

Eigen::RowVectorXd ModelErrors::Slope::response(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  return scale * (channel_response(above, inputs.row(input), initial(input)) -
                  channel_response(below, inputs.row(input), initial(input)));
}

ModelErrors::Slope ModelErrors::slope_of(const TransferMatrix& model, const ChannelError& error) const {
  const TransferFunction& channel = model(0, error.input);
  const TransferFunction above = with_error(channel, error, error.deviation);
  const TransferFunction below = with_error(channel, error, -error.deviation);
  const double below_by = error.parameter == MismatchParameter::dead_time
                              ? channel.dead_time() - below.dead_time()
                              : error.deviation;
  return {error.input, discretise(above, sample_time_), discretise(below, sample_time_),
          error.deviation / (error.deviation + below_by)};
}

TransferMatrix ModelErrors::with_errors(const Eigen::Ref<const Eigen::VectorXd>& z) const {
  TransferMatrix model = nominal_;
  for (std::size_t i = 0; i < errors_.size(); ++i)
    model(0, errors_[i].input) = with_error(model(0, errors_[i].input), errors_[i],
                                            errors_[i].deviation * z(static_cast<Eigen::Index>(i)));
  return model;
}

void ModelErrors::take(TransferMatrix model) {
  model_ = std::move(model);
  corrected_.clear();
  for (Eigen::Index input = 0; input < model_.cols(); ++input)
    if (!(model_(0, input) == nominal_(0, input)))
      corrected_.push_back({input, discretise(model_(0, input), sample_time_),
                            discretise(nominal_(0, input), sample_time_), 1.0});
  slopes_.clear();
  for (const ChannelError& error : errors_)
    slopes_.push_back(slope_of(model_, error));
}

LearntModel::LearntModel(const Study& study, const Eigen::Ref<const Eigen::VectorXd>& initial_u,
                         const AssessedLoop& benchmark, double share, double bias)
    : initial_(Eigen::VectorXd::Zero(study.plant.G.cols())) {
  initial_.head(initial_u.size()) = initial_u;
  // Of a window the inputs before it are known, too.
  const AssessedLoop& whole = benchmark.from_start();
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    Eigen::RowVectorXd e = Eigen::RowVectorXd::Constant(whole.samples(), kNaN);
    e.segment(benchmark.first, benchmark.samples()) =
        without_outliers(benchmark.y.row(cv) - benchmark.y_sim.row(cv));
    cvs_.emplace_back(study, cv, relative_errors(study, cv, share, bias), e, model_inputs(whole), initial_,
                      least_noise(benchmark.y_sim.row(cv)));
  }
}

TransferMatrix LearntModel::plant() const {
  TransferMatrix plant(static_cast<Eigen::Index>(cvs_.size()), initial_.size());
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv)
    for (Eigen::Index input = 0; input < plant.cols(); ++input)
      plant(cv, input) = of(cv).model()(0, input);
  return plant;
}

AssessedLoop LearntModel::corrected(const AssessedLoop& loop, AssessedLoop& whole) const {
  const Eigen::MatrixXd added = explained(loop);
  if (!loop.whole) {
    whole = loop;
    whole.y_sim += added;
    return whole;
  }
  whole = *loop.whole;
  whole.y_sim += added;
  return window_of(whole, loop.first, loop.samples());
}

/// ny x N of the record; the samples of the window alone say what is most probable.
Eigen::MatrixXd LearntModel::explained(const AssessedLoop& loop) const {
  const AssessedLoop& whole = loop.from_start();
  const Eigen::MatrixXd inputs = model_inputs(whole);
  Eigen::MatrixXd sum(whole.y.rows(), whole.samples());
  for (Eigen::Index cv = 0; cv < sum.rows(); ++cv) {
    const ModelErrors& errors = of(cv);
    sum.row(cv) = errors.correction(inputs, initial_);
    const Eigen::MatrixXd Z = errors.directions(errors.slopes(inputs, initial_));
    Eigen::MatrixXd series(1 + Z.rows(), whole.samples());
    series.row(0).setConstant(kNaN);
    series.block(0, loop.first, 1, loop.samples()) =
        without_outliers(loop.y.row(cv) - loop.y_sim.row(cv) - sum.block(cv, loop.first, 1, loop.samples()));
    series.bottomRows(Z.rows()) = errors.noise().deviation * Z;
    if (Z.rows() == 0 || (!series.row(0).array().isNaN()).count() < kFewestNoiseSamples)
      continue;
    // Under the noise that this record shows, so that a disturbance is not taken for errors of the model.
    const BaseNoise noise =
        noise_posterior(series.row(0), series.bottomRows(Z.rows()), least_noise(whole.y_sim.row(cv))).best;
    const Eigen::VectorXd z = coefficients(noise, series).mean;
    sum.row(cv) += z.transpose() * series.bottomRows(Z.rows());
  }
  return sum;
}

double least_noise(const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) {
  return kLeastNoise * (1.0 + y_sim.cwiseAbs().maxCoeff());
}

}  // namespace mpm
