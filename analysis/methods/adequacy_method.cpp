#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/indicators/loop_cost.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/base_noise.hpp"
#include "analysis/methods/mismatch_responses.hpp"
#include "analysis/methods/model_errors.hpp"
#include "analysis/statistics/washout.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct AdequacyOptions {
  double worth = 0.1;        ///< gain of a repair below which the model is adequate
  double probability = 0.5;  ///< of a gain above it, from which on it is not
  double deviation = 0.3;    ///< of the relative errors of the model before the record is seen
  int draws = 8;
  int channels = 4;

  bool operator==(const AdequacyOptions&) const = default;
};

OptionKeys keys(AdequacyOptions& options) {
  return {
      key::number("worth", options.worth, NumberRule::positive(),
                  "gain of a repair below which the model is adequate: the part of what the loop costs that "
                  "the repair of one channel takes away"),
      key::number("probability", options.probability, NumberRule::inside(0, 1),
                  "a loop, and a CV, is flagged when the repair of a channel is worth more than `worth` with "
                  "this probability"),
      key::number("deviation", options.deviation, NumberRule::positive(),
                  "standard deviation of the relative errors of gain, time constant and dead time of each "
                  "channel before the record is seen"),
      key::whole("draws", options.draws, 1, 1000, "plants out of the posterior on which loops are simulated"),
      key::whole("channels", options.channels, 1, 1000,
                 "channels whose repair is simulated: those whose error explains most of a CV")};
}

constexpr std::uint64_t kDrawSeed = 43;
/// Part of the mean square of a CV below which the error of a channel is not worth a simulation.
constexpr double kFaintShare = 1e-3;

/// Is the model still in the set of models with which this controller performs adequately (Mesbah, Bombois,
/// Ludlage and Van den Hof, "Experiment design for batch-to-batch model-based learning control" and
/// "Closed-loop performance diagnosis using prediction error identification", 2011 and 2012)? They bound the
/// set by a frequency-domain condition; here it is asked of the loop itself. The record gives the errors of
/// gain, time constant and dead time of every channel a posterior (ModelErrors, prior of `deviation`),
/// disturbances and noise integrated out. With P a plant drawn from it, n what P leaves of the record and J
/// the cost of a loop (LoopCost),
///
///   gain(i, j) = (J(G0) - J(G0 with channel (i, j) of the posterior mean)) / J(G0)
///
/// of the loops of plant P under n, with the controller on either model. The model is inadequate when
/// P(gain > worth) of some channel is above `probability`. It asks neither for a benchmark nor what is new.
class Adequacy final : public AssessmentMethod {
 public:
  explicit Adequacy(const AssessmentContext& context)
      : context_(context), study_(context.study), options_(study_.assessment.of<AdequacyOptions>()) {}

  Assessment assess(const AssessedLoop& loop) override {
    const AssessedLoop& whole = loop.from_start();
    inputs_ = model_inputs(whole);
    initial_ = Eigen::VectorXd::Zero(inputs_.rows());
    initial_.head(context_.basis.point.u.size()) = context_.basis.point.u;
    std::vector<ModelErrors> models;
    for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv) {
      const Eigen::RowVectorXd e = errors_in_window(loop, cv);
      if ((!e.array().isNaN()).count() < kFewestNoiseSamples)
        return Assessment::not_applicable("a CV has too few samples");
      models.emplace_back(study_, cv, relative_errors(study_, cv, options_.deviation, study_.assessment.bias),
                          e, inputs_, initial_, least_noise(whole.y_sim.row(cv)));
    }
    const std::vector<Channel> looked_at = largest_errors(whole, models);
    return answer(looked_at, gains(whole, models, looked_at));
  }

 private:
  /// Channels whose error explains most of their CV, at most as many as the options say.
  std::vector<Channel> largest_errors(const AssessedLoop& whole,
                                      const std::vector<ModelErrors>& models) const {
    struct Weighed {
      Channel channel;
      double share;
    };
    std::vector<Weighed> all;
    const Eigen::MatrixXd y = gaps_closed(whole.y);
    for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv)
      for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
        const TransferFunction model = study_.assessed_channel(cv, mv);
        const TransferFunction& found = models[static_cast<std::size_t>(cv)].model()(0, mv);
        if (model.is_zero() || model == found)
          continue;
        const double share =
            (response(found, mv) - response(model, mv)).squaredNorm() / y.row(cv).squaredNorm();
        if (share > kFaintShare)
          all.push_back({{cv, mv}, share});
      }
    std::stable_sort(all.begin(), all.end(),
                     [](const Weighed& a, const Weighed& b) { return a.share > b.share; });
    std::vector<Channel> channels;
    for (const Weighed& each : all)
      if (static_cast<int>(channels.size()) < options_.channels)
        channels.push_back(each.channel);
    return channels;
  }

  Eigen::RowVectorXd response(const TransferFunction& channel, Eigen::Index input) const {
    return channel_response(discretise(channel, study_.controller.sample_time), inputs_.row(input),
                            initial_(input));
  }

  /// Ascending over the draws in which both loops run to their end, of each channel.
  std::vector<std::vector<double>> gains(const AssessedLoop& whole, const std::vector<ModelErrors>& models,
                                         const std::vector<Channel>& channels) const {
    std::vector<std::vector<double>> all(channels.size());
    if (channels.empty())
      return all;
    RandomStream random(kDrawSeed, 0, StreamId::world);
    for (int draw = 0; draw < options_.draws; ++draw) {
      TransferMatrix plant = study_.plant.G;
      Eigen::MatrixXd left = whole.y;
      for (Eigen::Index cv = 0; cv < plant.rows(); ++cv) {
        const ModelErrors& model = models[static_cast<std::size_t>(cv)];
        Eigen::VectorXd z(model.count());
        for (double& each : z)
          each = random.normal();
        const TransferMatrix drawn = model.drawn(z);
        for (Eigen::Index input = 0; input < plant.cols(); ++input) {
          plant(cv, input) = drawn(0, input).without_washout();
          if (!drawn(0, input).is_zero())
            left.row(cv) -= response(drawn(0, input), input);
        }
      }
      left = from_washout(study_, left);
      const std::optional<double> now = cost(study_.plant.G, plant, whole.d, left);
      for (std::size_t i = 0; i < channels.size() && now; ++i) {
        TransferMatrix repaired = study_.plant.G;
        repaired(channels[i].cv, channels[i].mv) =
            models[static_cast<std::size_t>(channels[i].cv)].model()(0, channels[i].mv).without_washout();
        if (const std::optional<double> after = cost(repaired, plant, whole.d, left))
          all[i].push_back((*now - *after) / *now);
      }
    }
    for (std::vector<double>& each : all)
      std::sort(each.begin(), each.end());
    return all;
  }

  std::optional<double> cost(const TransferMatrix& model, const TransferMatrix& plant,
                             const Eigen::MatrixXd& d, const Eigen::MatrixXd& disturbance) const {
    Study study = study_;
    study.plant.G = model;
    const Trajectory loop =
        run_closed_loop(study, plant,
                        {.d = d,
                         .noise = Eigen::MatrixXd::Zero(disturbance.rows(), disturbance.cols()),
                         .y_d = disturbance,
                         .y_set = setpoints(study_),
                         .dither = dither(study_)},
                        context_.factory);
    if (loop.status != ControlStatus::ok)
      return std::nullopt;
    return loop_cost(study_, loop).total();
  }

  Assessment answer(const std::vector<Channel>& channels,
                    const std::vector<std::vector<double>>& gains) const {
    Assessment assessment;
    assessment.score = 0.0;
    assessment.cvs.assign(static_cast<std::size_t>(study_.cv_count()), {.flagged = false, .score = 0.0});
    std::optional<Channel> best;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const std::vector<double>& sorted = gains[i];
      if (sorted.empty())
        continue;
      const auto count = static_cast<double>(sorted.size());
      double mean = 0.0, above = 0.0;
      for (const double gain : sorted) {
        mean += gain / count;
        above += gain > options_.worth ? 1.0 / count : 0.0;
      }
      // The gain that the wanted share of the draws exceeds, over what it must be worth.
      const auto place = static_cast<std::size_t>((1.0 - options_.probability) * (count - 1.0));
      const double score = std::max(0.0, sorted[place] / options_.worth);
      CvAssessment& cv = assessment.cvs[static_cast<std::size_t>(channels[i].cv)];
      cv.score = std::max(cv.score, score);
      if (score > assessment.score) {
        assessment.score = score;
        best = channels[i];
      }
      assessment.numbers.push_back({"gain", mean, channels[i].cv, channels[i].mv});
      assessment.numbers.push_back({"p_worth", above, channels[i].cv, channels[i].mv});
    }
    for (CvAssessment& cv : assessment.cvs) {
      cv.flagged = cv.score > 1.0;
      if (cv.flagged == true)
        cv.source = FaultSource::mpm;
    }
    assessment.flagged = assessment.score > 1.0;
    if (assessment.flagged)
      assessment.flagged_channels.push_back(*best);
    return assessment;
  }

  const AssessmentContext& context_;
  const Study& study_;
  const AdequacyOptions& options_;
  Eigen::MatrixXd inputs_;  ///< of the record that is assessed
  Eigen::VectorXd initial_;
};

}  // namespace

AssessmentMethodInfo adequacy_method() {
  return {{.name = "adequacy",
           .title = "is the model adequate for this controller?",
           .verdict =
               "the repair of some channel is probably worth more than a stated part of what the loop costs",
           .requirements = {.moving_mvs = true, .nominal_loop = true, .complete_record = false},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = true,
           .numbers =
               {{"gain", NumberScope::channel,
                 "expected gain of the repair of this channel, in what the loop costs; none: not simulated"},
                {"p_worth", NumberScope::channel, "probability that it is above `worth`"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<Adequacy>(context); },
          option_table<AdequacyOptions>(keys, "of the test whether the model is adequate")};
}

}  // namespace mpm
