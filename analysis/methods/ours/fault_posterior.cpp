#include "analysis/methods/ours/fault_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/input_disturbance.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/methods/ours/sensor_search.hpp"
#include "analysis/methods/ours/sticky_valve_search.hpp"
#include "analysis/methods/ours/whitened_errors.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "analysis/statistics/standstill.hpp"
#include "analysis/statistics/truncated_normal.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

double log_weight(double prior, double evidence, double healthy) {
  return prior > 0.0 ? std::log(prior) + evidence - healthy : -kInfinity;
}

/// The logarithm of the probability of a record without a fault.
double healthy_evidence(const std::vector<CvEvidence>& evidence) {
  double sum = 0.0;
  for (const CvEvidence& of_cv : evidence)
    sum += of_cv.healthy;
  return sum;
}

/// Logarithms of the weights of the faults of a CV against none.
struct CvWeights {
  double mpm, ud, both, sensor;

  double all() const { return log_sum(log_sum(log_sum(mpm, ud), both), sensor); }
};

CvWeights weights_of_cv(const CvPrior& prior, const CvEvidence& evidence) {
  return {log_weight(prior.mpm, evidence.mpm, evidence.healthy),
          log_weight(prior.ud, evidence.ud, evidence.healthy),
          log_weight(prior.both, evidence.both, evidence.healthy),
          log_weight(prior.sensor, evidence.sensor, evidence.healthy)};
}

std::vector<CvWeights> weights_of(const FaultPriorSet& priors, const std::vector<CvEvidence>& evidence) {
  std::vector<CvWeights> weights;
  for (std::size_t i = 0; i < evidence.size(); ++i)
    weights.push_back(weights_of_cv(priors.cvs[i], evidence[i]));
  return weights;
}

/// log(e^x - 1), x > 0.
double log_expm1(double x) {
  return x > 30.0 ? x + std::log1p(-std::exp(-x)) : std::log(std::expm1(x));
}

/// The probabilities of the faults of a CV. `log_total` is the logarithm of the weight of all faults and of
/// none together; `log_odds` is taken over.
FaultProbabilities::OfCv probabilities_of_cv(const CvWeights& cv, double log_total, double log_odds) {
  const double sensor = std::exp(cv.sensor - log_total);
  return {std::exp(cv.mpm - log_total),
          std::exp(cv.ud - log_total),
          std::exp(cv.both - log_total),
          log_odds,
          sensor,
          sensor};
}

FaultProbabilities of_one_fault(const std::vector<CvWeights>& weights) {
  double total = 0.0;  // log of the weight of nothing
  for (const CvWeights& cv : weights)
    total = log_sum(total, cv.all());
  FaultProbabilities probabilities{std::exp(-total), 0.0, 0.0, 0.0, -kInfinity, {}};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const CvWeights& cv = weights[i];
    double others = 0.0;
    for (std::size_t j = 0; j < weights.size(); ++j)
      if (j != i)
        others = log_sum(others, weights[j].all());
    probabilities.cvs.push_back(probabilities_of_cv(cv, total, cv.all() - others));
    probabilities.mpm += probabilities.cvs.back().mpm;
    probabilities.ud += probabilities.cvs.back().ud;
    probabilities.both += probabilities.cvs.back().both;
    probabilities.other += probabilities.cvs.back().other;
    probabilities.log_odds = log_sum(probabilities.log_odds, cv.all());
  }
  return probabilities;
}

FaultProbabilities of_several_faults(const std::vector<CvWeights>& weights) {
  FaultProbabilities probabilities{};
  double log_healthy = 0.0, log_no_disturbance = 0.0, log_no_mismatch = 0.0, log_neither = 0.0;
  for (const CvWeights& cv : weights) {
    const double total = log_sum(0.0, cv.all()), neither = log_sum(0.0, cv.sensor);
    probabilities.cvs.push_back(probabilities_of_cv(cv, total, cv.all()));
    log_healthy -= total;
    log_neither += neither - total;
    log_no_disturbance += log_sum(neither, cv.mpm) - total;
    log_no_mismatch += log_sum(neither, cv.ud) - total;
  }
  const double neither = std::exp(log_neither);
  probabilities.healthy = std::exp(log_healthy);
  probabilities.other = probabilities.sensor = neither - probabilities.healthy;
  probabilities.mpm = std::exp(log_no_disturbance) - neither;
  probabilities.ud = std::exp(log_no_mismatch) - neither;
  probabilities.both = std::max(0.0, 1.0 - neither - probabilities.mpm - probabilities.ud);
  probabilities.log_odds = log_healthy < 0.0 ? log_expm1(-log_healthy) : -kInfinity;
  return probabilities;
}

/// Returns whether the noise of the records of this study is known to be normal, of the size that the study
/// states, and kept as it was measured.
bool noise_is_known(const Study& study) {
  const RecordOptions& record = study.record;
  const bool kept = record.quantisation == 0.0 && record.compression == 0.0 &&
                    (record.missing_share == 0.0 || record.fill == GapFill::none);
  return kept && !study.nonlinear && !study.names_scenarios() &&
         study.simulation.noise.distribution == NoiseDistribution::normal &&
         (study.simulation.noise_standard_deviation.array() > 0.0).all();
}

/// The values at which the inputs of the model rest before a record that begins at the operating point.
Eigen::VectorXd initial_inputs(const AssessmentContext& context) {
  Eigen::VectorXd initial = Eigen::VectorXd::Zero(context.study.plant.G.cols());
  initial.head(context.basis.point.u.size()) = context.basis.point.u;
  return initial;
}

/// The model of each CV with its errors, as the benchmark shows them; the ceiling knows the distributions
/// that they are drawn from.
std::vector<ModelErrors> learnt_models(const AssessmentContext& context, FaultPriors priors) {
  const Study& study = context.study;
  const AssessedLoop& benchmark = *context.benchmark;
  const bool drawn = priors == FaultPriors::study;
  const std::shared_ptr<const LearntModel> learnt = drawn ? nullptr : learnt_model(context);
  std::vector<ModelErrors> models;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    std::optional<BaseNoise> known;
    if (drawn && noise_is_known(study))
      known = {study.simulation.noise_standard_deviation(cv), study.simulation.noise.autocorrelation};
    const double least = least_noise(benchmark.y_sim.row(cv));
    const Eigen::RowVectorXd e =
        without_outliers(without_standstills(benchmark.y.row(cv)) - benchmark.y_sim.row(cv));
    const ModelErrorPrior errors = drawn ? drawn_errors(study, cv) : ModelErrorPrior{};
    if (learnt)
      models.push_back(learnt->of(cv));
    else if (errors.channels.empty())
      models.emplace_back(study, cv, known ? *known : fitted_base_noise(e, least));
    else
      models.emplace_back(study, cv, errors, e, model_inputs(benchmark), initial_inputs(context), least,
                          known);
  }
  return models;
}

/// The standard deviation of the noise of each CV; `whole`: with its slow part.
Eigen::VectorXd deviations(const std::vector<ModelErrors>& models, bool whole) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(models.size()));
  for (std::size_t i = 0; i < models.size(); ++i) {
    const BaseNoise& noise = models[i].noise();
    all(static_cast<Eigen::Index>(i)) =
        whole ? std::hypot(noise.deviation, noise.deviation * noise.b / std::sqrt(1.0 - noise.a * noise.a))
              : noise.deviation;
  }
  return all;
}

FaultSource most_probable_source(const FaultProbabilities::OfCv& cv, double least) {
  const double largest = std::max({cv.mpm, cv.ud, cv.both, cv.other});
  if (!(largest > 0.0) || largest < least * cv.fault())
    return FaultSource::none;
  if (largest == cv.other)
    return FaultSource::other;
  return largest == cv.mpm ? FaultSource::mpm : largest == cv.ud ? FaultSource::ud : FaultSource::mpm_ud;
}

const std::vector<MismatchEvidence>& mismatches_of_source(const CvEvidence& evidence, FaultSource source) {
  return source == FaultSource::mpm ? evidence.mismatch_alone : evidence.mismatch_with_disturbance;
}

/// The same priors with all kinds of faults equally frequent, and loops with a fault as frequent as those
/// without. Scores come from these priors, since they are compared with the scores of calibration loops,
/// whose study is the same except for its kinds.
FaultPriorSet of_equal_kinds(const Study& study, FaultPriorSet priors) {
  const auto channels_of = [&study](Eigen::Index cv) {
    double count = 0.0;
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
      count += study.plant.G(cv, mv).is_zero() ? 0.0 : 1.0;
    return count;
  };
  double channels = 0.0;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    channels += channels_of(cv);
  constexpr double kThird = 1.0 / 3.0;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    CvPrior& prior = priors.cvs[static_cast<std::size_t>(cv)];
    prior.mpm = prior.both = channels > 0.0 ? kThird * channels_of(cv) / channels : 0.0;
    prior.ud = kThird / static_cast<double>(study.cv_count());
  }
  return priors;
}

/// Returns whether the study draws faults of the kinds that the likelihood knows.
bool draws_known_faults(const Study& study) {
  return study.experiments.mpm + study.experiments.ud + study.experiments.mpm_ud > 0;
}

/// What is known about the faults before a record is seen. It is the same for all loops of a benchmark
/// (AssessmentContext::of_benchmark).
class FaultKnowledge {
 public:
  FaultKnowledge(const AssessmentContext& context, FaultPriors priors)
      : learnt_(priors == FaultPriors::study ? nullptr : learnt_model(context)),
        models_(learnt_models(context, priors)),
        priors_(fault_priors(
            context.study, priors, context.study.assessment.of<LikelihoodOptions>().fault_probability,
            deviations(models_, context.correction != nullptr), context.correction != nullptr)) {
    const Study& study = context.study;
    const Eigen::MatrixXd& d = context.benchmark->d;
    md_noises_.resize(d.rows());
    for (Eigen::Index md = 0; md < d.rows(); ++md)
      md_noises_(md) =
          std::max(deviation_of_steps(d.row(md)), kUnseen * (d.row(md).maxCoeff() - d.row(md).minCoeff()));
    if (priors == FaultPriors::study && !noise_is_known(study))
      priors_.noise_freedom = std::min(priors_.noise_freedom, kUnknownNoise);
    if (learnt_)
      discount_false_faults(context, *learnt_);
    for_scores_ = priors == FaultPriors::study ? of_equal_kinds(study, priors_) : priors_;
    if (priors == FaultPriors::study && !draws_known_faults(study))
      priors_ = for_scores_;
    for (std::size_t cv = 0; cv < models_.size(); ++cv)
      likelihoods_.push_back(std::make_unique<const CvLikelihood>(
          models_[cv], study.controller.sample_time, priors_.cvs[cv], priors_.noise_freedom,
          priors_.starts_from_rest, study.assessment.of<LikelihoodOptions>().judged));
  }
  FaultKnowledge(const FaultKnowledge&) = delete;
  FaultKnowledge& operator=(const FaultKnowledge&) = delete;

  const std::vector<ModelErrors>& models() const { return models_; }
  const FaultPriorSet& priors() const { return priors_; }
  const FaultPriorSet& for_scores() const { return for_scores_; }
  const CvLikelihood& of(std::size_t cv) const { return *likelihoods_[cv]; }
  /// y - y_sim of the CV, at the samples of its model.
  Eigen::RowVectorXd errors(const AssessedLoop& loop, Eigen::Index cv) const {
    return learnt_ ? learnt_->errors(loop, cv) : errors_in_window(loop, cv);
  }
  /// The noise of an MD in the benchmark; at least what would not be seen (kUnseen).
  double md_noise(Eigen::Index md) const { return md_noises_(md); }

 private:
  /// Halves of the benchmark in a record; log L grows with the number of samples.
  static constexpr double kHalves = 2.0;
  /// Degrees of freedom of the variance of a noise that is taken from the benchmark.
  static constexpr double kUnknownNoise = 4.0;

  /// Lowers the priors of faults by the false faults that one half of the benchmark shows under the model
  /// learnt from the other half: in a record of the length of both, a fault must be more probable than they
  /// are. There are false faults if the model of the errors is wrong (a nonlinear plant). If it is right, the
  /// halves show none, and the priors stay.
  void discount_false_faults(const AssessmentContext& context, const LearntModel& learnt) {
    const Study& study = context.study;
    const AssessedLoop& benchmark = *context.benchmark;
    const Eigen::VectorXd initial = initial_inputs(context);
    const Eigen::MatrixXd inputs = model_inputs(benchmark.from_start());
    const Eigen::Index middle = benchmark.first + benchmark.samples() / 2;
    for (std::size_t i = 0; i < priors_.cvs.size(); ++i) {
      CvPrior& prior = priors_.cvs[i];
      const auto cv = static_cast<Eigen::Index>(i);
      if (!learnt.of(cv).are_doubtful())
        continue;
      double false_odds = 0.0;
      for (const bool first : {true, false}) {
        const auto learns = [&](Eigen::Index k) { return (k < middle) == first; };
        const std::optional<ModelErrors> half = learnt.of_part(study, benchmark, cv, learns);
        Eigen::RowVectorXd other = learnt.errors(benchmark, cv);
        for (Eigen::Index k = 0; k < other.size(); ++k)
          if (learns(k))
            other(k) = kNaN;
        if (!half || other.array().isNaN().all())
          continue;
        const CvLikelihood likelihood(*half, study.controller.sample_time, prior, priors_.noise_freedom,
                                      priors_.starts_from_rest);
        false_odds = std::max(
            false_odds,
            weights_of_cv(prior, likelihood.of(other, inputs, initial, Eigen::MatrixXd(0, other.size())))
                .all());
      }
      const double left = std::exp(-kHalves * false_odds);
      prior.mpm *= left;
      prior.ud *= left;
      prior.both *= left;
      prior.sensor *= left;
      priors_.input *= left;
      priors_.md *= left;
    }
  }

  static constexpr double kUnseen = 1e-3;  ///< least noise of an MD, over the range of its moves

  std::shared_ptr<const LearntModel> learnt_;
  std::vector<ModelErrors> models_;
  Eigen::VectorXd md_noises_;
  FaultPriorSet priors_, for_scores_;
  std::vector<std::unique_ptr<const CvLikelihood>> likelihoods_;
};

class FaultPosterior final : public AssessmentMethod {
 public:
  FaultPosterior(const AssessmentContext& context, FaultPriors priors)
      : study_(context.study),
        initial_(initial_inputs(context)),
        known_(context.of_benchmark->of<const FaultKnowledge>(
            fmt::format("priors {}", static_cast<int>(priors)),
            [&] { return std::make_shared<FaultKnowledge>(context, priors); })) {
    const FaultHypotheses asked = study_.assessment.of<LikelihoodOptions>().hypotheses;
    is_learnt_ = priors != FaultPriors::study && context.correction;
    asks_more_ = priors != FaultPriors::study &&
                 (asked == FaultHypotheses::all || (asked == FaultHypotheses::learnt && is_learnt_));
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd inputs = model_inputs(loop.from_start());
    std::vector<CvEvidence> evidence;
    std::vector<Eigen::RowVectorXd> errors;
    for (std::size_t i = 0; i < known_->models().size(); ++i) {
      const auto cv = static_cast<Eigen::Index>(i);
      // A window is taken as the record up to its end with no CV observed before the window: what the inputs
      // did there is known, and a disturbance may have been there.
      Eigen::RowVectorXd e = known_->errors(loop, cv).head(loop.first + loop.samples());
      if (e.array().isNaN().all())
        return Assessment::failed("a CV has no sample");
      evidence.push_back(
          known_->of(i).of(e, inputs.leftCols(e.size()), initial_, untold_of(loop, cv, e.size())));
      errors.push_back(std::move(e));
    }
    FaultProbabilities probabilities = fault_probabilities(known_->priors(), evidence);
    if (!asks_more_ || !is_flagged(probabilities))
      return answer(probabilities, fault_probabilities(known_->for_scores(), evidence), evidence);
    const std::vector<Eigen::MatrixXd> series = healthy_series(loop, errors, inputs);
    const std::vector<WhitenedErrors> whitened = whitened_errors(series);
    // If nobody knows the noise, FaultComparison tests sensors and valves instead.
    const bool asks_instruments = !loop.has_unknown_noise();
    const InputWeights of_inputs = input_weights(evidence, series, whitened, inputs, asks_instruments);
    for (std::size_t i = 0; i < known_->models().size(); ++i)
      if (is_suspect(probabilities.cvs[i])) {
        known_->of(i).add_growing(series[i], inputs.leftCols(series[i].cols()), initial_,
                                  untold_of(loop, static_cast<Eigen::Index>(i), series[i].cols()),
                                  kGrowingShare, evidence[i]);
        if (probabilities.cvs[i].mpm < 1.0 - kSuspect)
          known_->of(i).add_any_shape(series[i], inputs.leftCols(series[i].cols()), initial_, kAnyShapeShare,
                                      evidence[i]);
      }
    if (asks_instruments)
      ask_sensors(loop, probabilities, series, whitened, evidence);
    probabilities = with_sticky_valve(
        with_input_disturbance(fault_probabilities(known_->priors(), evidence), of_inputs.disturbance),
        of_inputs.valve);
    if (asks_instruments)
      probabilities =
          with_wrong_md(probabilities, md_weight(probabilities.log_odds, evidence, series, whitened, inputs));
    Assessment assessment = answer(probabilities, probabilities, evidence);
    if (probabilities.other > probabilities.sensor)
      assessment.numbers.push_back({"valve_mv", static_cast<double>(of_inputs.valve_mv)});
    return assessment;
  }

 private:
  bool is_flagged(const FaultProbabilities& probabilities) const {
    return 1.0 - probabilities.healthy > study_.assessment.of<LikelihoodOptions>().flag_probability;
  }

  /// Returns whether something is wrong in the CV that is not beyond doubt a disturbance.
  static bool is_suspect(const FaultProbabilities::OfCv& cv) {
    return cv.fault() > kSuspect && cv.ud < 1.0 - kSuspect;
  }

  /// AssessedLoop::untold up to the end of the window; 0 x N for a record of the bench.
  static Eigen::MatrixXd untold_of(const AssessedLoop& loop, Eigen::Index cv, Eigen::Index samples) {
    const std::vector<Eigen::MatrixXd>& untold = loop.from_start().untold;
    return untold.empty() ? Eigen::MatrixXd(0, samples)
                          : Eigen::MatrixXd(untold[static_cast<std::size_t>(cv)].leftCols(samples));
  }

  /// CvLikelihood::healthy_series() of each CV.
  std::vector<Eigen::MatrixXd> healthy_series(const AssessedLoop& loop,
                                              const std::vector<Eigen::RowVectorXd>& errors,
                                              const Eigen::MatrixXd& inputs) const {
    std::vector<Eigen::MatrixXd> series;
    for (std::size_t i = 0; i < errors.size(); ++i)
      series.push_back(
          known_->of(i).healthy_series(errors[i], inputs.leftCols(errors[i].size()), initial_,
                                       untold_of(loop, static_cast<Eigen::Index>(i), errors[i].size())));
    return series;
  }

  std::vector<WhitenedErrors> whitened_errors(const std::vector<Eigen::MatrixXd>& series) const {
    std::vector<WhitenedErrors> all;
    for (std::size_t i = 0; i < series.size(); ++i)
      all.emplace_back(known_->models()[i].noise(), series[i], known_->priors().noise_freedom);
    return all;
  }

  /// The evidence of what a fault around the model leaves of the CV in the place `cv`: it is as probable as
  /// in a healthy loop.
  double evidence_with(const ExplainedErrors& fault, std::size_t cv, Eigen::MatrixXd series) const {
    series.row(0) -= fault.of_cvs[cv];
    return known_->of(cv).healthy_evidence(series);
  }

  /// log of the weight of such a fault against nothing.
  double weight_of(const ExplainedErrors& fault, double prior, const std::vector<CvEvidence>& evidence,
                   const std::vector<Eigen::MatrixXd>& series) const {
    if (!fault.is_any())
      return -kInfinity;
    double gain = -fault.penalty;
    for (std::size_t i = 0; i < series.size(); ++i)
      if (fault.of_cvs[i].size() > 0)
        gain += evidence_with(fault, i, series[i]) - evidence[i].healthy;
    return log_weight(prior, gain, 0.0);
  }

  /// log of the weights of a disturbance on some MV, and of a valve that sticks, against nothing.
  struct InputWeights {
    double disturbance = -kInfinity, valve = -kInfinity;
    std::size_t valve_mv = 0;  ///< the MV whose valve most likely sticks
  };

  InputWeights input_weights(const std::vector<CvEvidence>& evidence,
                             const std::vector<Eigen::MatrixXd>& series,
                             const std::vector<WhitenedErrors>& whitened, const Eigen::MatrixXd& inputs,
                             bool asks_valves) const {
    const double healthy = healthy_evidence(evidence), prior = known_->priors().input;
    const InputLikelihood likelihood(known_->models(), series, study_.controller.sample_time,
                                     known_->priors().noise_freedom);
    const std::vector<InputEvidence> of_mvs = likelihood.of_mvs(study_.mv_count());
    InputWeights found;
    for (const InputEvidence& of_mv : of_mvs)
      found.disturbance = log_sum(found.disturbance, log_weight(prior, of_mv.log_evidence, healthy));
    if (!asks_valves)
      return found;
    const std::vector<ExplainedErrors> valves = best_sticky_valves(
        known_->models(), whitened, inputs, initial_, study_.mv_count(), study_.controller.sample_time);
    double most = -kInfinity;
    for (std::size_t mv = 0; mv < valves.size(); ++mv) {
      const double valve = weight_of(valves[mv], prior, evidence, series);
      found.valve = log_sum(found.valve, valve);
      if (valve > most) {
        most = valve;
        found.valve_mv = mv;
      }
    }
    return found;
  }

  /// log of the weight of a wrong measurement of some MD against nothing. The record of the MD itself shows
  /// that its measurement is noisy, whatever the errors of the CVs look like: this weighs kOfNoisyMd more
  /// than `log_odds`.
  double md_weight(double log_odds, const std::vector<CvEvidence>& evidence,
                   const std::vector<Eigen::MatrixXd>& series, const std::vector<WhitenedErrors>& whitened,
                   const Eigen::MatrixXd& inputs) const {
    const double sample_time = study_.controller.sample_time, prior = known_->priors().md;
    double sum = -kInfinity;
    for (Eigen::Index md = 0; md < study_.md_count(); ++md) {
      const Eigen::Index input = study_.mv_count() + md;
      sum = log_sum(sum, weight_of(best_md_gain(known_->models(), whitened, inputs, input, sample_time),
                                   prior, evidence, series));
      if (has_noisy_md(known_->models(), whitened, inputs, input, sample_time, known_->md_noise(md)))
        sum = log_sum(sum, log_weight(prior, log_odds + kOfNoisyMd, 0.0));
    }
    return sum;
  }

  /// Judges the sensors of the CVs in which something is wrong. A disturbance that steps or ramps looks like
  /// a bias or a drift (best_sensor_error()). If several CVs show one, it is taken for a disturbance that
  /// reaches them, since two sensors hardly go wrong in one record.
  void ask_sensors(const AssessedLoop& loop, const FaultProbabilities& probabilities,
                   const std::vector<Eigen::MatrixXd>& series, const std::vector<WhitenedErrors>& whitened,
                   std::vector<CvEvidence>& evidence) const {
    std::vector<double> of_errors(evidence.size(), -kInfinity);
    int telling = 0;
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      if (!is_suspect(probabilities.cvs[i]))
        continue;
      const ExplainedErrors fault = best_sensor_error(whitened, i);
      if (fault.is_any())
        of_errors[i] = evidence_with(fault, i, series[i]) - fault.penalty;
      evidence[i].sensor = stuck_evidence(loop, i, series[i]);
      telling += of_errors[i] > kTelling + std::max({evidence[i].healthy, evidence[i].mpm, evidence[i].ud,
                                                     evidence[i].both, evidence[i].sensor})
                     ? 1
                     : 0;
    }
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      double& shared = telling > 1 ? evidence[i].ud : evidence[i].sensor;
      shared = log_sum(shared, of_errors[i]);
    }
  }

  /// log of the probability of the errors of a CV whose sensor is stuck.
  double stuck_evidence(const AssessedLoop& loop, std::size_t cv, Eigen::MatrixXd series) const {
    const Standstill stretch = longest_standstill(loop.y.row(static_cast<Eigen::Index>(cv)));
    if (!is_frozen(stretch, loop.samples()))
      return -kInfinity;
    series.row(0).segment(loop.first + stretch.first, stretch.length()).setConstant(kNaN);
    if (series.row(0).array().isNaN().all())
      return -kInfinity;
    return known_->of(cv).healthy_evidence(series) + kOfStuckSample * static_cast<double>(stretch.length());
  }

  /// Weight of mismatches that grow, over that of those that do not.
  static constexpr double kGrowingShare = 0.5;
  /// The same for mismatches in which more than one parameter is wrong. With 0.1, and without the gains of
  /// all channels, `likelihood` named one source fewer of the 197 faults of `mixed` and `several` under the
  /// seeds 8 and 11.
  static constexpr double kAnyShapeShare = 0.3;
  static constexpr double kSuspect = 1e-3;  ///< probability from which a CV is looked at more closely
  /// A CV counts as showing an error of its sensor if the log likelihood of this error exceeds that of all
  /// else that may be wrong with the CV by so much; not tuned.
  static constexpr double kTelling = 5.0;
  /// log of the density of a sample of a stuck sensor, in deviations of the noise: it is known to a twentieth
  /// of one.
  static constexpr double kOfStuckSample = 3.0;
  /// log of the weight of a noisy measurement of an MD over all faults of CVs, if has_noisy_md() says so:
  /// large enough to decide, but not a likelihood.
  static constexpr double kOfNoisyMd = 10.0;

  Assessment answer(const FaultProbabilities& probabilities, const FaultProbabilities& scores,
                    const std::vector<CvEvidence>& evidence) const {
    const auto& options = study_.assessment.of<LikelihoodOptions>();
    Assessment assessment;
    assessment.flagged = is_flagged(probabilities);
    assessment.score = scores.log_odds;
    for (std::size_t i = 0; i < scores.cvs.size(); ++i)
      assessment.cvs.push_back({probabilities.cvs[i].fault() > options.flag_probability,
                                scores.cvs[i].log_odds, FaultSource::none});
    const std::optional<Eigen::Index> worst = assessment.worst_cv();
    for (std::size_t i = 0; i < assessment.cvs.size(); ++i) {
      CvAssessment& cv = assessment.cvs[i];
      if (cv.flagged == true || worst == static_cast<Eigen::Index>(i))
        cv.source = most_probable_source(probabilities.cvs[i], options.source_probability);
      if (cv.source == FaultSource::other)
        cv.about = probabilities.cvs[i].sensor > 0.5 * probabilities.cvs[i].other ? ToldSource::sensor
                                                                                  : ToldSource::valve;
      name_mismatch(i, cv.source, evidence[i], worst == static_cast<Eigen::Index>(i), assessment);
    }
    add_numbers(probabilities, evidence, worst, assessment);
    return assessment;
  }

  /// Names the most probable parameter of a CV with a mismatch: its channel and, for the worst CV, its size.
  void name_mismatch(std::size_t cv, FaultSource source, const CvEvidence& evidence, bool worst,
                     Assessment& assessment) const {
    if (!assessment.flagged || (source != FaultSource::mpm && source != FaultSource::mpm_ud))
      return;
    const auto& mismatches = mismatches_of_source(evidence, source);
    const auto likeliest = required_best_candidate("likelihoods of the mismatches of a CV", mismatches,
                                                   &MismatchEvidence::log_evidence);
    const SizePrior& named =
        known_->priors().cvs[cv].mismatches[static_cast<std::size_t>(likeliest - mismatches.begin())];
    assessment.flagged_channels.push_back(named.channel);
    if (!worst)
      return;
    const auto ends = support(named.size);
    const Interval sizes = up_to_ends(shortest_interval(likeliest->sizes, study_.aggregate.confidence), ends);
    // The likeliest size, not the median, tells whether larger sizes would be likelier: the median lies
    // within the range.
    assessment.named_mismatch = {
        named.channel, named.parameter, mixture_quantile(likeliest->sizes, 0.5),
        sizes.lower,   sizes.upper,     bound_within(likeliest->best_size, ends.first, ends.second)};
  }

  /// Moves an end of the interval to that of the possible sizes if both differ by rounding only. A size that
  /// a study scales to an effect often lies there.
  static Interval up_to_ends(Interval sizes, std::pair<double, double> ends) {
    const double rounding = 1e-9 * (ends.second - ends.first);
    if (sizes.lower < ends.first + rounding)
      sizes.lower = ends.first - rounding;
    if (sizes.upper > ends.second - rounding)
      sizes.upper = ends.second + rounding;
    return sizes;
  }

  /// The probabilities as they are stated. If errors of the model are learnt, they follow from what was true
  /// in loops in which the same was seen.
  SourceProbabilities stated_of(const FaultProbabilities& probabilities) const {
    const SourceProbabilities seen{probabilities.healthy, probabilities.mpm, probabilities.ud,
                                   probabilities.both, probabilities.other};
    if (!is_learnt_)
      return seen;
    SourceProbabilities stated{};
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (std::size_t truth = 0; truth < stated.size(); ++truth)
        stated[truth] += seen[i] * true_sources(static_cast<FaultSource>(i))[truth];
    return stated;
  }

  void add_numbers(const FaultProbabilities& probabilities, const std::vector<CvEvidence>& evidence,
                   std::optional<Eigen::Index> worst, Assessment& assessment) const {
    const SourceProbabilities stated = stated_of(probabilities);
    assessment.numbers.clear();
    for (std::size_t i = 0; i < stated.size(); ++i)
      assessment.numbers.push_back({source_probability_numbers()[i].name, stated[i]});
    const double of_sensors = probabilities.other > 0.0 ? probabilities.sensor / probabilities.other : 0.0;
    assessment.numbers.push_back(
        {"p_sensor", of_sensors * stated[static_cast<std::size_t>(FaultSource::other)]});
    for (std::size_t i = 0; i < probabilities.cvs.size(); ++i) {
      const auto cv = static_cast<Eigen::Index>(i);
      const FaultProbabilities::OfCv& of_cv = probabilities.cvs[i];
      assessment.numbers.push_back({"cv_p_mpm", of_cv.mpm, cv});
      assessment.numbers.push_back({"cv_p_ud", of_cv.ud, cv});
      assessment.numbers.push_back({"cv_p_both", of_cv.both, cv});
      assessment.numbers.push_back({"cv_p_other", of_cv.other, cv});
    }
    if (!worst)
      return;
    const CvEvidence& of_worst = evidence[static_cast<std::size_t>(*worst)];
    const double a = of_worst.disturbance_a;
    assessment.numbers.push_back(
        {"ud_gain", of_worst.disturbance_b / ((1.0 - a) * study_.disturbance.v_standard_deviation)});
    assessment.numbers.push_back({"ud_time_constant", -study_.controller.sample_time / std::log(a)});
  }

  const Study& study_;
  Eigen::VectorXd initial_;
  std::shared_ptr<const FaultKnowledge> known_;
  bool is_learnt_ = false;  ///< errors of the model are learnt
  bool asks_more_ = false;  ///< hypotheses are asked besides the basic ones
};

}  // namespace

FaultProbabilities fault_probabilities(const FaultPriorSet& priors, const std::vector<CvEvidence>& evidence) {
  const std::vector<CvWeights> weights = weights_of(priors, evidence);
  return priors.one_fault ? of_one_fault(weights) : of_several_faults(weights);
}

namespace {

using LoopShares = std::vector<double FaultProbabilities::*>;
using CvShares = std::vector<double FaultProbabilities::OfCv::*>;

/// Adds a further fault of the loop with this weight, which counts in `of_loop` and `of_cv`.
FaultProbabilities with_fault_of_input(FaultProbabilities probabilities, double log_weight,
                                       const LoopShares& of_loop, const CvShares& of_cv) {
  const double share = std::exp(log_weight - log_sum(log_sum(0.0, probabilities.log_odds), log_weight));
  for (double FaultProbabilities::*each :
       {&FaultProbabilities::healthy, &FaultProbabilities::mpm, &FaultProbabilities::ud,
        &FaultProbabilities::both, &FaultProbabilities::other, &FaultProbabilities::sensor})
    probabilities.*each *= 1.0 - share;
  for (double FaultProbabilities::*each : of_loop)
    probabilities.*each += share;
  probabilities.log_odds = log_sum(probabilities.log_odds, log_weight);
  for (FaultProbabilities::OfCv& cv : probabilities.cvs) {
    const double fault = cv.fault();
    for (double FaultProbabilities::OfCv::*each :
         {&FaultProbabilities::OfCv::mpm, &FaultProbabilities::OfCv::ud, &FaultProbabilities::OfCv::both,
          &FaultProbabilities::OfCv::other, &FaultProbabilities::OfCv::sensor})
      cv.*each *= 1.0 - share;
    for (double FaultProbabilities::OfCv::*each : of_cv)
      cv.*each += share * fault;
  }
  return probabilities;
}

}  // namespace

FaultProbabilities with_input_disturbance(FaultProbabilities probabilities, double log_weight) {
  return with_fault_of_input(std::move(probabilities), log_weight, {&FaultProbabilities::ud},
                             {&FaultProbabilities::OfCv::ud});
}

FaultProbabilities with_sticky_valve(FaultProbabilities probabilities, double log_weight) {
  return with_fault_of_input(std::move(probabilities), log_weight, {&FaultProbabilities::other},
                             {&FaultProbabilities::OfCv::other});
}

FaultProbabilities with_wrong_md(FaultProbabilities probabilities, double log_weight) {
  return with_fault_of_input(std::move(probabilities), log_weight,
                             {&FaultProbabilities::other, &FaultProbabilities::sensor},
                             {&FaultProbabilities::OfCv::other, &FaultProbabilities::OfCv::sensor});
}

const SourceProbabilities& true_sources(FaultSource seen) {
  // none, mpm, ud, mpm_ud, other
  static constexpr std::array<SourceProbabilities, kWords<FaultSource>.size()> kTrue{{
      {0.905, 0.060, 0.010, 0.005, 0.020},
      {0.030, 0.950, 0.005, 0.005, 0.010},
      {0.050, 0.010, 0.885, 0.010, 0.045},
      {0.010, 0.340, 0.250, 0.330, 0.070},
      {0.010, 0.005, 0.020, 0.005, 0.960},
  }};
  return kTrue[static_cast<std::size_t>(seen)];
}

std::unique_ptr<AssessmentMethod> make_fault_posterior(const AssessmentContext& context, FaultPriors priors) {
  return std::make_unique<FaultPosterior>(context, priors);
}

std::vector<AssessmentNumberInfo> fault_posterior_numbers() {
  std::vector<AssessmentNumberInfo> numbers = source_probability_numbers();
  const std::vector<AssessmentNumberInfo> further{
      {"p_sensor", NumberScope::loop,
       "part of `p_other` that belongs to sensors: of a CV (bias, drift, standstill) or of an MD"},
      {"valve_mv", NumberScope::loop, "position of the MV whose valve most probably sticks, from 0"},
      {"ud_gain", NumberScope::loop, "gain of G_d of the likeliest disturbance alone on the worst CV",
       "CV unit"},
      {"ud_time_constant", NumberScope::loop, "its time constant", "time unit of the plant"},
      {"cv_p_mpm", NumberScope::cv, "probability that the CV has a mismatch alone"},
      {"cv_p_ud", NumberScope::cv, "probability that it has a disturbance alone"},
      {"cv_p_both", NumberScope::cv, "probability that it has both"},
      {"cv_p_other", NumberScope::cv, "probability that a sticking valve or a sensor affects it"}};
  numbers.insert(numbers.end(), further.begin(), further.end());
  return numbers;
}

}  // namespace mpm
