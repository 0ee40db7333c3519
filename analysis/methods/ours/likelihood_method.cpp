#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/ours/fault_posterior.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

OptionKeys keys(LikelihoodOptions& options) {
  return {
      key::choice(
          "priors", options.priors, {"wide", "study"},
          "faults before the record is seen. `\"wide\"`: of any size, on one CV or several. `\"study\"`: "
          "those that the study draws, as often and as large as it draws them. The default is `\"wide\"` "
          "because nobody knows the distribution of the faults of a real plant"),
      key::choice(
          "hypotheses", options.hypotheses, {"learnt", "basic", "all"},
          "`\"basic\"`: one parameter of a channel, a disturbance on a CV, or both. `\"all\"`: in a flagged "
          "loop also a mismatch that begins within the record and grows or a faulty sensor, for one CV, and "
          "a "
          "disturbance on an MV, a sticking valve or a wrong measurement of an MD, for all CVs at once. "
          "`\"learnt\"`: all if errors of the model are learnt, "
          "otherwise the basic ones. With `priors = \"study\"` always the basic ones"),
      key::number("fault_probability", options.fault_probability, NumberRule::inside(0, 1),
                  "probability of any fault in a loop before the record is seen, with wide priors. 0.5: "
                  "nothing is known"),
      key::number("flag_probability", options.flag_probability, NumberRule::inside(0, 1),
                  "a loop or a CV is flagged when a fault is more probable than this, given the record. 0.5: "
                  "the fewest wrong verdicts if a missed fault costs as much as a false alarm"),
      key::number(
          "source_probability", options.source_probability, NumberRule::below_one(),
          "the source of a CV is named when it is at least this probable, given that the CV has a fault. 0: "
          "the most probable source is always named, since a source that is not named counts as wrong"),
      key::choice("judged", options.judged,
                  "mismatches that are evaluated under every noise model that the benchmark leaves possible. "
                  "`\"nearest\"`: those nearest to the likeliest one; the others take the effect of these "
                  "noise models without a fault. `\"all\"`: all that might be the likeliest, which names the "
                  "channel better if two inputs move alike and the fault is large against the noise. The "
                  "default is `\"nearest\"` because the finished boards have it")};
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
          option_table<LikelihoodOptions>(keys, "options of the posterior of the faults")};
}

}  // namespace mpm
