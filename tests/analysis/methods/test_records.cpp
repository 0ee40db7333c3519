#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/historian.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What methods make of records as a historian keeps them, and of loops that nothing excites.

namespace mpm {
namespace {

using Catch::Contains;

/// A shipped study with further keys of [simulation] and further tables, without its reported numbers.
Study changed_study(const std::string& name, const std::string& simulation, const std::string& tables) {
  std::string text = find_study(name).source;
  text = text.substr(0, text.find("[reference]"));
  const std::string heading = "[simulation]\n";
  text.insert(text.find(heading) + heading.size(), simulation);
  return parse_study(text + "\n" + tables, "s.toml");
}

std::string exchanged(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// The loops of wood-berry, which are cheap, without their steps; long enough to tell an impact from chance.
Study unexcited(const std::string& self_check) {
  std::string text = find_study("wood-berry").source;
  while (text.find("[[simulation.step]]") != std::string::npos) {
    const std::size_t from = text.find("[[simulation.step]]");
    text.erase(from, text.find("\n[", from + 1) - from);
  }
  if (const std::size_t from = text.find("[simulation.random_steps]"); from != std::string::npos)
    text.erase(from, text.find("\n[", from + 1) - from);
  text =
      exchanged(text, "[simulation]\nsamples = 400", "[simulation]\nexcitation = \"none\"\nsamples = 3000");
  const std::string key = "self_check = \"" + self_check + "\"\n";
  return parse_study(text.find("[diagnosis]") == std::string::npos
                         ? text + "\n[diagnosis]\n" + key
                         : exchanged(text, "[diagnosis]\n", "[diagnosis]\n" + key),
                     "s.toml");
}

ExperimentRecord experiment(const Study& study, const BasisCase& basis, std::int64_t index,
                            StorePolicy store) {
  return ExperimentRunner(study, basis, shipped_methods().names(), testing::kFactory).run(index, store);
}

TEST_CASE("every method sees every family of records, and one that needs every sample says so", "[records]") {
  // Experiment 0 has a mismatch; setpoint-methods is the study to whose loops all others apply.
  struct Family {
    std::string simulation, tables;
    bool has_gaps;
  };
  const std::vector<Family> families{
      {"", "[record]\noutliers = {share = 0.02}\nquantisation = 2\ncompression = 1.5\n", false},
      {"", "[record]\nmissing = {share = 0.1, length = 4, fill = \"linear\"}\n", false},
      {"", "[record]\nmissing = {share = 0.1, length = 4}\n", true},
      {"dither = [{mv = \"u1\", amplitude = 0.1, hold = 5}]\n", "", false},
      {"noise = {distribution = \"student\", autocorrelation = 0.7, factor = {constant = 2}}\n", "", false},
  };
  for (const Family& family : families) {
    INFO(family.simulation << family.tables);
    const Study study = changed_study("setpoint-methods", family.simulation,
                                      family.tables + "[record.candidates]\ncount = 2\n");
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const ExperimentRecord record = experiment(study, basis, 0, StorePolicy::all);
    REQUIRE(record.status == ExperimentStatus::ok);
    // The truth and the loop that is kept are those of the measurements.
    CHECK(record.ivar_basis == basis_variance_indices(study, record.loop->trajectory.y, basis.trajectory.y));
    for (const AssessmentRecord& said : record.assessments) {
      const AssessmentMethodInfo& method = assessment_method(said.form->method().name);
      INFO(method.name << ": " << said.reason);
      if (family.has_gaps && method.requirements.complete_record) {
        CHECK(said.status == AssessmentStatus::not_applicable);
        CHECK_THAT(said.reason, Contains("needs a complete record, and") && Contains("samples of"));
      } else if (method.name == "autocovariance") {  // setpoint steps take u1 to its limit
        CHECK(said.status == AssessmentStatus::not_applicable);
      } else {
        CHECK(said.answered());
      }
    }
    // A loop that was kept gives the answers of the loop in the run, and so does one that is run again.
    ExperimentRecord again = record;
    for (int i = 0; i < 2; ++i, again.loop.reset()) {
      const auto assessments = ExperimentRunner(study, basis, {"sse"}, testing::kFactory).assess(again);
      CHECK(assessments.front().score == record.by("sse")->score);
    }
  }
}

TEST_CASE("loops moved by limits and by disturbances that vary are assessed by whom they are for",
          "[records]") {
  const Study study = changed_study("chapter6",
                                    "md_noise = {standard_deviation = 0.05, time_constant = 20}\n"
                                    "limit_step = [{cv = \"y1\", sample = 100, soft = [-0.2, 0.4]}]\n",
                                    "");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK(basis.healthy);
  const ExperimentRecord record = experiment(study, basis, 0, StorePolicy::none);
  REQUIRE(record.status == ExperimentStatus::ok);
  for (const AssessmentRecord& said : record.assessments) {
    INFO(said.form->method().name << ": " << said.reason);
    CHECK((said.answered() || said.status == AssessmentStatus::not_applicable));
  }
  CHECK(record.by("botelho")->answered());
  CHECK(record.by("counterfactual")->answered());
}

TEST_CASE("sse: a gap is left out of the mean", "[records]") {
  const Study study = find_study("wood-berry");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  Assessor sse(assessment_method("sse"), context);
  AssessedLoop loop = *context.benchmark;
  loop.y.row(0).array() = loop.y_sim.row(0).array() + 0.1;  // an error of 0.1 wherever one looks
  const double whole = sse.assess(loop).number("ratio", 0);
  loop.y.row(0).segment(7, 100).setConstant(std::nan(""));
  CHECK(sse.assess(loop).number("ratio", 0) == Approx(whole).epsilon(1e-12));
  loop.y.row(0).setConstant(std::nan(""));
  CHECK_THAT(sse.assess(loop).reason, Contains("no sample at all"));
}

TEST_CASE("without excitation the chain does not apply, and the self-check is another one", "[records]") {
  const Study by_ivar = unexcited("ivar");
  CHECK_FALSE(by_ivar.simulation.is_excited());
  const BasisCase unhealthy = run_basis_case(by_ivar, testing::kFactory);
  CHECK_FALSE(unhealthy.healthy);
  CHECK_THAT(unhealthy.explanation, Contains("noise outweighs the excitation") && Contains("self_check"));

  const Study study = unexcited("repeat");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  INFO(basis.explanation);
  CHECK(basis.healthy);
  CHECK_THAT(basis.explanation, Contains("with other noise"));
  const ExperimentRecord record = experiment(study, basis, 0, StorePolicy::none);
  REQUIRE(record.status == ExperimentStatus::ok);
  CHECK(record.by("botelho")->status == AssessmentStatus::not_applicable);
  CHECK_THAT(record.by("botelho")->reason, Contains("it needs excitation that outweighs the noise"));
  CHECK(record.by("counterfactual")->answered());
  CHECK(run_basis_case(unexcited("none"), testing::kFactory).healthy);

  // Of a record that is too short the variance is chance.
  Study brief = study;
  brief.simulation.samples = 100;
  brief.diagnosis.longest_window = 1.0;
  brief.diagnosis.self_check_lower = 0.97;
  brief.diagnosis.self_check_upper = 1.03;
  const BasisCase chance = run_basis_case(brief, testing::kFactory);
  CHECK_FALSE(chance.healthy);
  CHECK_THAT(chance.explanation, Contains("too short to tell an impact from chance"));
}

TEST_CASE("records of 100 and of 5000 samples are assessed", "[records]") {
  for (const int samples : {100, 5000}) {
    Study study = find_study("wood-berry");
    study.simulation.samples = samples;
    study.diagnosis.longest_window = 1.0;  // of 60 samples, in 100 of them
    std::erase_if(study.simulation.steps, [&](const SignalStep& step) { return step.sample >= samples; });
    std::erase_if(study.simulation.setpoint_steps,
                  [&](const SignalStep& step) { return step.sample >= samples; });
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    REQUIRE(basis.trajectory.status == ControlStatus::ok);
    ExperimentRunner runner(study, basis, {"botelho", "sse", "counterfactual"}, testing::kFactory);
    const ExperimentRecord record = runner.run(1, StorePolicy::none);
    REQUIRE(record.status == ExperimentStatus::ok);
    for (const AssessmentRecord& said : record.assessments)
      CHECK(said.answered());
  }
}

}  // namespace
}  // namespace mpm
