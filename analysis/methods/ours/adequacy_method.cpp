#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

OptionKeys keys(AdequacyOptions& options) {
  return {
      key::number("worth", options.worth, NumberRule::positive(),
                  "the model is adequate if no repair gains more than this: the share of the cost of the "
                  "loop that the repair of one channel saves"),
      key::number("probability", options.probability, NumberRule::inside(0, 1),
                  "a loop or a CV is flagged when, with at least this probability, the repair of a channel "
                  "gains more than `worth`"),
      key::number("deviation", options.deviation, NumberRule::positive(),
                  "standard deviation of the relative errors of gain, time constant and dead time of each "
                  "channel before the record is seen"),
      key::whole("draws", options.draws, 1, 1000,
                 "number of plants drawn from the posterior, on which loops are simulated"),
      key::whole("channels", options.channels, 1, 1000,
                 "number of channels whose repair is simulated: those whose error explains most of a CV")};
}

/// Tests whether the model is still in the set of models with which this controller performs adequately
/// (Mesbah, Bombois, Ludlage and Van den Hof, "Experiment design for batch-to-batch model-based learning
/// control" and "Closed-loop performance diagnosis using prediction error identification", 2011 and 2012).
/// They bound the set by a frequency-domain condition; here the simulated loop itself decides. The model is
/// inadequate if P(gain > worth) of some channel is above `probability` (RepairProspects). The method needs
/// no benchmark and does not ask what is new.
class Adequacy final : public AssessmentMethod {
 public:
  explicit Adequacy(const AssessmentContext& context)
      : study_(context.study),
        options_(study_.assessment.of<AdequacyOptions>()),
        prospects_(study_, context.basis.point, in_turn(context.factory)) {}

  Assessment assess(const AssessedLoop& loop) override {
    const auto prospects = prospects_.of(loop);
    return prospects ? answer(*prospects) : Assessment::not_applicable("a CV has too few samples");
  }

 private:
  Assessment answer(const std::vector<RepairProspect>& prospects) const {
    Assessment assessment;
    assessment.score = 0.0;
    assessment.cvs.assign(static_cast<std::size_t>(study_.cv_count()), {.flagged = false, .score = 0.0});
    std::optional<Channel> best;
    for (const RepairProspect& prospect : prospects) {
      const std::vector<double>& sorted = prospect.gains;
      const Channel& channel = prospect.repair.channel;
      if (sorted.empty())
        continue;
      // The gain that a share `probability` of the draws exceeds, over `worth`.
      const auto place =
          static_cast<std::size_t>((1.0 - options_.probability) * (static_cast<double>(sorted.size()) - 1.0));
      const double score = std::max(0.0, sorted[place] / options_.worth);
      CvAssessment& cv = assessment.cvs[static_cast<std::size_t>(channel.cv)];
      cv.score = std::max(cv.score, score);
      if (score > assessment.score) {
        assessment.score = score;
        best = channel;
      }
      assessment.numbers.push_back({"gain", prospect.gain(), channel.cv, channel.mv});
      assessment.numbers.push_back(
          {"p_worth", prospect.probability_above(options_.worth), channel.cv, channel.mv});
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

  const Study& study_;
  const AdequacyOptions& options_;
  RepairProspects prospects_;
};

}  // namespace

AssessmentMethodInfo adequacy_method() {
  return {
      {.name = "adequacy",
       .title = "is the model adequate for this controller?",
       .verdict = "the repair of some channel probably saves more than a set share of the cost of the loop",
       .requirements = {.moving_mvs = true, .nominal_loop = true, .complete_record = false},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .information = ModelInformation::unused,
       .numbers = {{"gain", NumberScope::channel,
                    "expected gain of the repair of this channel, as a share of the cost of the loop; "
                    "none: not simulated"},
                   {"p_worth", NumberScope::channel, "probability that this gain is above `worth`"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Adequacy>(context); },
      option_table<AdequacyOptions>(keys, "options of the test whether the model is adequate")};
}

}  // namespace mpm
