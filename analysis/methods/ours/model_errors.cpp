#include "analysis/methods/ours/model_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/disturbance_scan.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/statistics/chi_squared.hpp"
#include "analysis/statistics/standstill.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/record_rows.hpp"

namespace mpm {
namespace {

/// Size of a faint direction, over the whole record and in variances of the noise: a fainter one changes log
/// L by less than half of this.
constexpr double kFaintDirection = 0.05;
constexpr double kSmallestFactor = 0.05;
constexpr int kGaussNewtonSteps = 3;
/// Gains that wander: the sizes that are tried, the gain of log L that a size needs, and the corners of a
/// benchmark.
constexpr std::array kWanders{0.05, 0.1, 0.2, 0.02};
constexpr double kSpeaksForWander = 3.0;
constexpr Eigen::Index kCorners = 8;
/// Rounding of a standardised error that is held at its bound.
constexpr double kRoundingOfBound = 1e-6;
/// Smallest noise, relative to the size of the outputs: their rounding in a record without noise.
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

/// A channel with one error, as far as the channel can have it.
TransferFunction with_error(const TransferFunction& channel, const ChannelError& error, double value) {
  if (error.parameter == MismatchParameter::dead_time)
    value = std::max(value, -channel.dead_time());
  else
    value = std::max(1.0 + value, kSmallestFactor);
  return with_mismatches(TransferMatrix{{channel}}, {{0, 0, error.parameter, value}})(0, 0);
}

/// Rows with the same Z' Z except for faint directions: those along the axes of Z Z', of which few count.
Eigen::MatrixXd strong(const Eigen::MatrixXd& Z) {
  if (Z.rows() == 0)
    return Z;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Z * Z.transpose());
  const Eigen::Index faint = (eigen.eigenvalues().array() < kFaintDirection).count();
  return eigen.eigenvectors().rightCols(Z.rows() - faint).transpose() * Z;
}

/// The posterior of the coefficients z ~ N(0, I) in e = Z' z + noise. e is the first row of `series`, and Z
/// the rows below it.
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

/// The p-value of no errors, from the posterior of coefficients z ~ N(0, I). P = covariance^-1 - I is what
/// the record tells about z, and without errors b = covariance^-1 mean ~ N(0, P). Directions about which it
/// tells next to nothing have no degree of freedom.
double p_of_none(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  if (mean.size() == 0)
    return 1.0;
  const Eigen::MatrixXd precision = covariance.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> told(
      precision - Eigen::MatrixXd::Identity(mean.size(), mean.size()));
  const Eigen::VectorXd b = told.eigenvectors().transpose() * (precision * mean);
  double chi_squared = 0.0;
  int freedom = 0;
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (told.eigenvalues()(i) > kFaintDirection) {
      chi_squared += b(i) * b(i) / told.eigenvalues()(i);
      ++freedom;
    }
  return freedom > 0 && std::isfinite(chi_squared) ? chi_squared_upper_tail(chi_squared, freedom) : 1.0;
}

/// The mean of a normal vector that is nowhere below `least`: the elements that lie below are held there one
/// after the other, the lowest first.
Eigen::VectorXd bounded_mean(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                             const Eigen::VectorXd& least) {
  std::vector<Eigen::Index> held;
  Eigen::VectorXd bounded = mean;
  Eigen::Index lowest = 0;
  while (bounded.size() > 0 && (bounded - least).minCoeff(&lowest) < -kRoundingOfBound) {
    held.push_back(lowest);
    bounded =
        mean + covariance(Eigen::all, held) * covariance(held, held).llt().solve(least(held) - mean(held));
  }
  return bounded;
}

/// y of the window without bad values, from rows that are early by some samples.
Eigen::RowVectorXd y_at_samples(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index early) {
  if (early == 0)
    return without_standstills(loop.y.row(cv));
  const AssessedLoop& whole = loop.from_start();
  return without_standstills(
      rows_of({OutputSampling::snapshot, -static_cast<double>(early)}, whole.y.row(cv), whole.samples())
          .segment(loop.first, loop.samples()));
}

}  // namespace

ModelErrorPrior relative_errors(const Study& study, Eigen::Index cv, double share, double bias) {
  ModelErrorPrior prior{{}, bias};
  for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input) {
    const TransferFunction& channel = study.assessed_channel(cv, input);
    if (channel.is_zero())
      continue;
    add_error(prior.channels, input, MismatchParameter::gain, share);
    if (channel.has_time_constant())
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
    const TransferFunction& channel = study.assessed_channel(cv, input);
    if (channel.is_zero())
      continue;
    add_error(prior.channels, input, MismatchParameter::gain, std::sqrt(variance_of(drawn.gain_factor)));
    if (channel.has_time_constant())
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
                         const std::optional<BaseNoise>& known, double late)
    : ModelErrors(study, cv, known.value_or(BaseNoise{})) {
  for (Eigen::Index input = 0; late != 0.0 && input < nominal_.cols(); ++input)
    if (const TransferFunction& channel = nominal_(0, input); !channel.is_zero())
      late_(0, input) = with_error(channel, {input, MismatchParameter::dead_time, 1.0}, late);
  bias_ = prior.bias;
  errors_ = prior.channels;
  const auto p = static_cast<Eigen::Index>(errors_.size());
  Eigen::MatrixXd unknown(p + (bias_ > 0.0 ? 1 : 0), e.size());
  unknown.bottomRows(unknown.rows() - p).setConstant(bias_ * std::max(deviation_of_steps(e), least));
  Eigen::MatrixXd series;
  corner_ = std::max<Eigen::Index>(2, e.size() / kCorners);
  mean_ = Eigen::VectorXd::Zero(p);
  take(late_);
  Eigen::VectorXd least_errors = Eigen::VectorXd::Constant(p, -kInfinity);  // no dead time is negative
  for (Eigen::Index i = 0; i < p; ++i)
    if (const ChannelError& error = errors_[static_cast<std::size_t>(i)];
        error.parameter == MismatchParameter::dead_time)
      least_errors(i) = -late_(0, error.input).dead_time() / error.deviation;
  Eigen::MatrixXd covariance;
  // Gauss and Newton: if outputs move by a hundred times the noise, one slope is not enough.
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    unknown.topRows(p) = slopes(inputs, initial);
    const Eigen::RowVectorXd left = e - correction(inputs, initial) + mean_.transpose() * unknown.topRows(p);
    if (!known && step + 1 < kGaussNewtonSteps)
      noise_.best = {std::max(deviation_of_steps(left), least)};
    else if (!known)
      learn_noise(left, unknown, inputs, initial, least);
    const Eigen::MatrixXd wanders = wandering(model_, inputs, initial);
    series.resize(1 + unknown.rows() + wanders.rows(), e.size());
    series << left, unknown, wanders;
    const Coefficients known_errors = coefficients(noise_.best, series);
    covariance = known_errors.covariance.topLeftCorner(p, p);
    exact_p_ = p_of_none(known_errors.mean.head(p), covariance);
    mean_ = bounded_mean(known_errors.mean.head(p), covariance, least_errors);
    take(with_errors(mean_));
  }
  factor_ = covariance.llt().matrixL();
}

ModelErrors::ModelErrors(const Study& study, Eigen::Index cv, const BaseNoise& noise)
    : sample_time_(study.controller.sample_time), nominal_(1, study.plant.G.cols()), noise_{noise, {}} {
  for (Eigen::Index input = 0; input < nominal_.cols(); ++input)
    nominal_(0, input) = study.assessed_channel(cv, input);
  late_ = model_ = nominal_;
}

TransferMatrix ModelErrors::plant() const {
  TransferMatrix plant = model_;
  for (Eigen::Index input = 0; input < plant.cols(); ++input)
    if (const double late = late_(0, input).dead_time() - nominal_(0, input).dead_time(); late != 0.0)
      plant(0, input) = with_error(plant(0, input), {input, MismatchParameter::dead_time, 1.0}, -late);
  return plant;
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
  const auto p = static_cast<Eigen::Index>(slopes_.size());
  const Eigen::MatrixXd wanders = wandering(model_, inputs, initial);
  Eigen::MatrixXd rows(p + wanders.rows(), inputs.cols());
  for (Eigen::Index i = 0; i < p; ++i)
    rows.row(i) = slopes_[static_cast<std::size_t>(i)].response(inputs, initial);
  rows.bottomRows(wanders.rows()) = wanders;
  return rows;
}

void ModelErrors::learn_noise(const Eigen::Ref<const Eigen::RowVectorXd>& left,
                              const Eigen::MatrixXd& unknown, const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                              const Eigen::Ref<const Eigen::VectorXd>& initial, double least) {
  const double deviation = noise_.best.deviation;
  const auto under = [&](const Eigen::MatrixXd& rows) {
    return noise_posterior(left, deviation * strong(rows / deviation), least);
  };
  noise_ = under(unknown);
  const bool doubtful = are_doubtful();
  double best = noise_.log_evidence + kSpeaksForWander, wander = 0.0;
  for (const double tried : kWanders) {
    if (!doubtful)
      break;
    wander_ = tried;
    const Eigen::MatrixXd wanders = wandering(model_, inputs, initial);
    Eigen::MatrixXd rows(unknown.rows() + wanders.rows(), unknown.cols());
    rows << unknown, wanders;
    NoisePosterior noise = under(rows);
    if (noise.log_evidence > best) {
      best = noise.log_evidence;
      wander = tried;
      noise_ = std::move(noise);
    } else if (wander == 0.0) {
      break;
    }
  }
  wander_ = wander;
  add_unseen_backgrounds(noise_, left.size());
}

Eigen::MatrixXd ModelErrors::wandering(const TransferMatrix& model,
                                       const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                       const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  if (wander_ == 0.0)
    return Eigen::MatrixXd(0, inputs.cols());
  const Eigen::Index corners = (inputs.cols() + corner_ - 1) / corner_ + 1;
  std::vector<Eigen::RowVectorXd> rows;
  for (Eigen::Index input = 0; input < model.cols(); ++input) {
    if (model(0, input).is_zero())
      continue;
    const Eigen::RowVectorXd response =
        channel_response(discretise(model(0, input), sample_time_), inputs.row(input), initial(input));
    for (Eigen::Index corner = 0; corner < corners; ++corner) {
      Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(response.size());
      for (Eigen::Index k = std::max<Eigen::Index>(0, (corner - 1) * corner_ + 1);
           k < std::min((corner + 1) * corner_, response.size()); ++k)
        row(k) = wander_ * response(k) *
                 (1.0 - std::abs(static_cast<double>(k - corner * corner_)) / static_cast<double>(corner_));
      rows.push_back(std::move(row));
    }
  }
  Eigen::MatrixXd all(static_cast<Eigen::Index>(rows.size()), inputs.cols());
  for (Eigen::Index i = 0; i < all.rows(); ++i)
    all.row(i) = rows[static_cast<std::size_t>(i)];
  return all;
}

Eigen::MatrixXd ModelErrors::slopes(Eigen::MatrixXd without, const Mismatch& mismatch,
                                    const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                    const Eigen::Ref<const Eigen::VectorXd>& initial) const {
  Mismatch possible = mismatch;
  if (mismatch.parameter == MismatchParameter::dead_time)
    possible.value = std::max(mismatch.value, -model_(0, mismatch.input).dead_time());
  const TransferMatrix changed = with_mismatches(model_, {possible});
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(errors_.size()); ++i)
    if (const ChannelError& error = errors_[static_cast<std::size_t>(i)]; error.input == mismatch.input)
      without.row(i) = slope_of(changed, error).response(inputs, initial);
  if (wander_ > 0.0) {
    const Eigen::MatrixXd wanders = wandering(changed, inputs, initial);
    without.middleRows(static_cast<Eigen::Index>(errors_.size()), wanders.rows()) = wanders;
  }
  return without;
}

Eigen::MatrixXd ModelErrors::directions(const Eigen::Ref<const Eigen::MatrixXd>& slopes) const {
  const Eigen::Index p = factor_.rows();
  const Eigen::Index wanders = slopes.rows() - p;
  Eigen::MatrixXd Z(p + wanders + (bias_ > 0.0 ? 1 : 0), slopes.cols());
  Z.topRows(p) = factor_.transpose() * slopes.topRows(p) / noise_.best.deviation;
  Z.middleRows(p, wanders) = slopes.bottomRows(wanders) / noise_.best.deviation;
  Z.bottomRows(Z.rows() - p - wanders).setConstant(bias_);
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
  TransferMatrix model = late_;
  for (std::size_t i = 0; i < errors_.size(); ++i)
    model(0, errors_[i].input) = with_error(model(0, errors_[i].input), errors_[i],
                                            errors_[i].deviation * z(static_cast<Eigen::Index>(i)));
  return model;
}

TransferMatrix ModelErrors::drawn(const Eigen::Ref<const Eigen::VectorXd>& z) const {
  return with_errors(mean_ + factor_ * z);
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
    : share_(share), bias_(bias), initial_(Eigen::VectorXd::Zero(study.plant.G.cols())) {
  initial_.head(initial_u.size()) = initial_u;
  cvs_ = errors_of(study, benchmark, 0, 0.0);
  const auto evidence = [](const std::vector<ModelErrors>& cvs) {
    double sum = 0.0;
    for (const ModelErrors& cv : cvs)
      sum += cv.noises().log_evidence;
    return sum;
  };
  double most = evidence(cvs_) + kSpeaksForLate;
  for (const double samples : {-1.0, -0.5, 0.5, 1.0}) {
    const double early = std::max(0.0, std::ceil(-samples));
    std::vector<ModelErrors> tried = errors_of(study, benchmark, static_cast<Eigen::Index>(early),
                                               (samples + early) * study.controller.sample_time);
    if (const double found = evidence(tried); found > most) {
      most = found;
      late_ = samples * study.controller.sample_time;
      early_ = static_cast<Eigen::Index>(early);
      cvs_ = std::move(tried);
    }
  }
}

std::vector<ModelErrors> LearntModel::errors_of(const Study& study, const AssessedLoop& benchmark,
                                                Eigen::Index early, double late) const {
  // The inputs before a window are known, too.
  const AssessedLoop& whole = benchmark.from_start();
  std::vector<ModelErrors> cvs;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    cvs.emplace_back(study, cv, relative_errors(study, cv, share_, bias_),
                     errors_in_window(benchmark, cv, early), model_inputs(whole), initial_,
                     least_noise(benchmark.y_sim.row(cv)), std::optional<BaseNoise>(), late);
  return cvs;
}

std::optional<ModelErrors> LearntModel::of_part(const Study& study, const AssessedLoop& benchmark,
                                                Eigen::Index cv,
                                                const std::function<bool(Eigen::Index)>& uses) const {
  Eigen::RowVectorXd e = errors(benchmark, cv);
  for (Eigen::Index k = 0; k < e.size(); ++k)
    if (!uses(k))
      e(k) = kNaN;
  if ((!e.array().isNaN()).count() < kFewestNoiseSamples)
    return std::nullopt;
  return ModelErrors(study, cv, relative_errors(study, cv, share_, bias_), e,
                     model_inputs(benchmark.from_start()), initial_, least_noise(benchmark.y_sim.row(cv)), {},
                     late_ + static_cast<double>(early_) * study.controller.sample_time);
}

std::optional<Eigen::Index> LearntModel::rejects_exact_model() const {
  if (late_ != 0.0)
    return 0;
  const auto first =
      std::find_if(cvs_.begin(), cvs_.end(), [](const ModelErrors& cv) { return cv.rejects_exact_model(); });
  return first == cvs_.end() ? std::nullopt : std::optional<Eigen::Index>(first - cvs_.begin());
}

TransferMatrix LearntModel::plant() const {
  TransferMatrix plant(static_cast<Eigen::Index>(cvs_.size()), initial_.size());
  for (Eigen::Index cv = 0; cv < plant.rows(); ++cv) {
    const TransferMatrix of_cv = of(cv).plant();
    for (Eigen::Index input = 0; input < plant.cols(); ++input)
      plant(cv, input) = of_cv(0, input).without_washout();
  }
  return plant;
}

std::shared_ptr<const AssessedLoop> LearntModel::corrected(const AssessedLoop& loop) const {
  return loop.derived.of<const AssessedLoop>("corrected by the benchmark", [&] {
    AssessedLoop whole = loop.from_start();
    whole.y_sim += explained(loop);
    for (Eigen::Index cv = 0; early_ > 0 && cv < whole.y_sim.rows(); ++cv)
      whole.y_sim.row(cv) = rows_of({OutputSampling::snapshot, static_cast<double>(early_)},
                                    whole.y_sim.row(cv), whole.samples());
    return same_window(loop, std::move(whole));
  });
}

Eigen::RowVectorXd LearntModel::errors(const AssessedLoop& loop, Eigen::Index cv) const {
  return errors_in_window(loop, cv, early_);
}

Eigen::MatrixXd LearntModel::series(const AssessedLoop& loop, Eigen::Index cv) const {
  const AssessedLoop& whole = loop.from_start();
  const Eigen::MatrixXd inputs = model_inputs(whole);
  const ModelErrors& errors = of(cv);
  const Eigen::RowVectorXd correction = errors.correction(inputs, initial_);
  // Without the rows that wander: they are free in each record and would take a part of every mismatch.
  const Eigen::MatrixXd Z = errors.directions(errors.slopes(inputs, initial_).topRows(errors.count()));
  Eigen::MatrixXd series(1 + Z.rows(), whole.samples());
  series.row(0).setConstant(kNaN);
  series.block(0, loop.first, 1, loop.samples()) = without_outliers(
      y_at_samples(loop, cv, early_) - loop.y_sim.row(cv) - correction.segment(loop.first, loop.samples()));
  series.bottomRows(Z.rows()) = errors.noise().deviation * Z;
  return series;
}

/// The errors that the model explains, ny x N of the record. Only the samples of the window tell what is most
/// probable.
Eigen::MatrixXd LearntModel::explained(const AssessedLoop& loop) const {
  const AssessedLoop& whole = loop.from_start();
  const Eigen::MatrixXd inputs = model_inputs(whole);
  Eigen::MatrixXd sum(whole.y.rows(), whole.samples());
  for (Eigen::Index cv = 0; cv < sum.rows(); ++cv) {
    sum.row(cv) = of(cv).correction(inputs, initial_);
    const Eigen::MatrixXd own = series(loop, cv);
    const auto unknown = own.bottomRows(own.rows() - 1);
    if (unknown.rows() == 0 || (!own.row(0).array().isNaN()).count() < kFewestNoiseSamples)
      continue;
    // The noise is the one that this record shows, so that a disturbance is not taken for errors of the
    // model.
    const BaseNoise noise = noise_posterior(own.row(0), unknown, least_noise(whole.y_sim.row(cv))).best;
    sum.row(cv) += coefficients(noise, own).mean.transpose() * unknown;
  }
  return sum;
}

Eigen::RowVectorXd errors_in_window(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index early) {
  Eigen::RowVectorXd e = Eigen::RowVectorXd::Constant(loop.from_start().samples(), kNaN);
  e.segment(loop.first, loop.samples()) =
      without_outliers(y_at_samples(loop, cv, early) - loop.y_sim.row(cv));
  return e;
}

double least_noise(const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) {
  return kLeastNoise * (1.0 + y_sim.cwiseAbs().maxCoeff());
}

}  // namespace mpm
