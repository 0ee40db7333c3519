#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/fault_posterior.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

OptionKeys keys(LikelihoodOptions& options) {
  return {
      key::choice("priors", options.priors, {"wide", "study"},
                  "faults before the record is seen: of any size, on one CV or several, or "
                  "those that the study draws, as often and as large as it draws them. "
                  "`\"wide\"` because nobody knows of a plant what its faults are drawn from"),
      key::choice(
          "hypotheses", options.hypotheses, {"learnt", "basic", "all"},
          "what may be wrong beside one parameter of a channel, a disturbance on a CV, and both: `\"all\"` "
          "asks of a flagged loop whether a mismatch that begins within the record and grows explains a CV, "
          "and a disturbance on an MV or a valve that sticks all CVs at once. `\"learnt\"`: "
          "all where errors of the model are learnt, else the basic ones. With `priors = \"study\"` "
          "always the basic ones"),
      key::number(
          "fault_probability", options.fault_probability, NumberRule::inside(0, 1),
          "of some fault in a loop, before the record is seen; of wide priors. 0.5: nothing is known"),
      key::number("flag_probability", options.flag_probability, NumberRule::inside(0, 1),
                  "a loop, and a CV, is flagged when a fault is more probable than this, given the record. "
                  "0.5: the fewest wrong verdicts when a missed fault costs what a false alarm does"),
      key::number(
          "source_probability", options.source_probability, NumberRule::below_one(),
          "the source of a CV is named when it is at least so probable, given that the CV has a fault. 0: "
          "the most probable one always, since a source that is not named counts as wrong"),
      key::choice("judged", options.judged,
                  "mismatches that are judged under every noise that the benchmark leaves possible: the "
                  "`\"nearest\"` to the likeliest one, the others with what these noises bring without a "
                  "fault; or `\"all\"` that might be the likeliest, which names the channel better where two "
                  "inputs move alike and a fault is large against the noise. `\"nearest\"` because the "
                  "finished boards have it")};
}

}  // namespace

AssessmentMethodInfo likelihood_method() {
  return {{.name = "likelihood",
           .title = "likelihood of the faults",
           .verdict = "a fault is more probable than none, given the record",
           .requirements = {.benchmark = true, .complete_record = false},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = true,
           .names_mismatches = true,
           .information = ModelInformation::learnt,
           .numbers = fault_posterior_numbers()},
          {},
          [](const AssessmentContext& context) {
            return make_fault_posterior(context, context.study.assessment.of<LikelihoodOptions>().priors);
          },
          option_table<LikelihoodOptions>(keys, "of the posterior of the faults")};
}

}  // namespace mpm
