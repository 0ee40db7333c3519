#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What several methods derive from a loop is made once, and their answers are those of each of them alone.

namespace mpm {
namespace {

/// What the methods of the tests have done.
struct Count {
  int made = 0, asked = 0;
  std::vector<const double*> y_sim = {};            ///< of each record that was seen
  std::vector<std::weak_ptr<const int>> kept = {};  ///< values that were derived from each
  std::ptrdiff_t most_kept = 0;                     ///< at once
};

using Counts = std::map<std::string, Count>;

/// Counts, and asks `other` if there is one.
class Counting final : public AssessmentMethod {
 public:
  Counting(Count& count, std::shared_ptr<Assessor> other) : count_(count), other_(std::move(other)) {
    ++count_.made;
  }

  Assessment assess(const AssessedLoop& loop) override {
    ++count_.asked;
    count_.y_sim.push_back(loop.y_sim.data());
    count_.kept.emplace_back(loop.derived.of<const int>("", [] { return std::make_shared<int>(0); }));
    count_.most_kept =
        std::max(count_.most_kept, std::count_if(count_.kept.begin(), count_.kept.end(),
                                                 [](const auto& value) { return !value.expired(); }));
    Assessment assessment;
    assessment.score = (loop.y - loop.y_sim).squaredNorm();
    if (other_)
      assessment.score += other_->assess(loop).score;
    return assessment;
  }

 private:
  Count& count_;
  std::shared_ptr<Assessor> other_;
};

AssessmentMethodInfo counting(Counts& counts, const std::string& name,
                              ModelInformation information = ModelInformation::nominal,
                              std::shared_ptr<const AssessmentMethodInfo> other = nullptr) {
  return {{.name = name,
           .title = name,
           .verdict = "none",
           .requirements = {},
           .information = information,
           .numbers = {}},
          {},
          [&counts, name, other](const AssessmentContext& context) {
            return std::make_unique<Counting>(counts[name],
                                              other ? shared_assessor(*other, context) : nullptr);
          }};
}

/// wood-berry in worlds, with an excitation of each loop and moving windows.
Study world_study() {
  Study study = find_study("wood-berry");
  study.simulation.samples = 200;
  study.simulation.excitation = SignalSequence::each;
  study.world = WorldRanges{
      .count = 2,
      .gain_factor = Distribution::uniform(0.95, 1.05),
      .time_constant_factor = Distribution::uniform(0.95, 1.05),
      .background = {.cv_size = Distribution::constant(0.5), .time_constant = Distribution::constant(10.0)},
      .cost_loops = 1,
      .repair_loops = 1};
  study.experiments = {.mpm = 2, .ud = 2, .healthy = 1};
  study.monitoring = MonitoringOptions{120, 40};
  return study;
}

bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

/// Everything but the time.
bool same(const AssessmentRecord& a, const AssessmentRecord& b) {
  const Eigen::VectorXd scores = Eigen::Vector2d(a.score, b.score);
  return a.status == b.status && a.reason == b.reason && a.flagged == b.flagged &&
         same(scores.head(1), scores.tail(1)) && a.predicted_cv == b.predicted_cv &&
         a.predicted_source == b.predicted_source && same(a.numbers, b.numbers);
}

}  // namespace

TEST_CASE("a panel asks a method once for a record and once for a window, whoever else asks it", "[panel]") {
  Study study = world_study();
  const int windows = study.monitoring->count(study.simulation.samples);
  for (const bool asker_first : {true, false}) {
    Counts counts;
    const auto table = std::make_shared<MethodTable>();
    const auto asked = std::make_shared<const AssessmentMethodInfo>(counting(counts, "asked"));
    table->add(*asked);
    table->add(counting(counts, "asker", ModelInformation::nominal, asked));
    study.assessment.table = table;
    const BasisCase basis = run_basis_case(study, testing::kFactory);
    const AssessedLoop loop = assessed_loop(study, basis.point, basis.trajectory);
    MethodPanel panel(study, assessment_context(study, basis, testing::kFactory),
                      asker_first ? std::vector<std::string>{"asker", "asked"}
                                  : std::vector<std::string>{"asked", "asker"});
    for (int record = 1; record <= 2; ++record) {
      const std::vector<AssessmentRecord> said = panel.assess(loop);
      REQUIRE(said[0].answered());
      CHECK(std::max(said[0].score, said[1].score) == 2.0 * std::min(said[0].score, said[1].score));
      CHECK(counts["asked"].asked == record * (1 + windows));
      CHECK(counts["asker"].asked == record * (1 + windows));
    }
    CHECK(counts["asked"].made == 1);
    CHECK(counts["asked"].most_kept == 2);  // of the record and of the window at hand
    // Nothing is left of a record for the next one, which may have other signals at the same place.
    AssessedLoop other = loop;
    other.y.array() += 1.0;
    CHECK(panel.assess(other)[0].score != panel.assess(loop)[0].score);
  }
}

TEST_CASE("the methods of a panel that see what is new see one corrected record", "[panel]") {
  Study study = world_study();
  study.monitoring.reset();
  Counts counts;
  const auto table = std::make_shared<MethodTable>();
  for (const char* name : {"one", "two"})
    table->add(counting(counts, name, ModelInformation::shown));
  table->add(counting(counts, "plain"));
  study.assessment.table = table;
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), {"one", "plain", "two"});
  panel.assess(assessed_loop(study, basis.point, basis.trajectory));
  CHECK(counts["one"].y_sim == counts["two"].y_sim);
  CHECK(counts["one"].y_sim != counts["plain"].y_sim);
}

TEST_CASE("the correction by the benchmark is a factor that every method can be given and denied",
          "[panel]") {
  Study study = world_study();
  study.monitoring.reset();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessedLoop loop = assessed_loop(
      study, basis.point, simulate_experiment(study, draw_experiment(study, 0), testing::kFactory));
  AssessmentContext told = assessment_context(study, basis, testing::kFactory);
  REQUIRE(told.correction);
  AssessmentContext untold = told, corrected = told;
  untold.correction.reset();
  corrected.correction.reset();
  corrected.benchmark = *told.correction->corrected(*told.benchmark);
  const AssessedLoop corrected_loop = *told.correction->corrected(loop);
  const auto said = [](const AssessmentMethodInfo& method, const AssessmentContext& context,
                       const AssessedLoop& record) {
    const auto form = std::make_shared<const AssessmentForm>(method, context.study);
    return kept(form, Assessor(method, context).assess(record));
  };
  int answered = 0;
  for (const AssessmentMethodInfo& method : shipped_methods().methods()) {
    const std::optional<AssessmentMethodInfo> other = with_other_information(method);
    REQUIRE(other.has_value() == (method.information != ModelInformation::unused));
    if (!other)
      continue;
    INFO(other->name);
    CHECK(shipped_methods().method(other->name).name == other->name);
    const bool gains = other->information == ModelInformation::shown;
    CHECK(other->name == method.name + (gains ? ":corrected" : ":uncorrected"));
    // The variant, and the method itself where it is told this much.
    CHECK(same(said(*other, told, loop),
               gains ? said(method, corrected, corrected_loop) : said(method, untold, loop)));
    CHECK(same(said(*other, untold, loop), said(method, untold, loop)));
    answered += said(*other, told, loop).answered() ? 1 : 0;
  }
  CHECK(answered > 10);
}

TEST_CASE("a composite finds what one method finds, and names what another one names", "[panel]") {
  Study study = world_study();
  study.monitoring.reset();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"sse", "lasso", "sse+lasso"}, testing::kFactory);
  int mismatches = 0, disturbances = 0;
  for (std::int64_t index = 0; index < study.experiment_count(); ++index) {
    const std::vector<AssessmentRecord> said = runner.run(index, StorePolicy::none).assessments;
    const AssessmentRecord &detector = said[0], &namer = said[1], &both = said[2];
    REQUIRE((detector.answered() && namer.answered() && both.answered()));
    CHECK(both.flagged == detector.flagged);
    CHECK(both.score == detector.score);
    CHECK(both.predicted_cv == (namer.flagged ? namer : detector).predicted_cv);
    CHECK(both.predicted_source == (namer.flagged ? namer.predicted_source : FaultSource::ud));
    CHECK(same(both.values("mismatch_size").reshaped(), namer.values("mismatch_size").reshaped()));
    (namer.flagged ? mismatches : disturbances) += both.flagged ? 1 : 0;
  }
  CHECK(mismatches + disturbances > 0);
}

TEST_CASE("methods give the same answers alone and together, in any order and in threads", "[panel]") {
  const Study study = world_study();
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  std::vector<std::string> methods{"botelho", "sse",        "counterfactual", "mpmbench", "order",
                                   "lasso",   "likelihood", "ceiling",        "arx-oe"};
  for (const char* const variant :
       {"mpmbench:uncorrected", "likelihood:uncorrected", "order:uncorrected", "arx-oe:corrected",
        "pmr:corrected", "mpmbench:without-order", "sse+lasso", "counterfactual+order"})
    methods.emplace_back(variant);
  const std::vector<std::string> reversed(methods.rbegin(), methods.rend());
  using Answers = std::vector<std::vector<AssessmentRecord>>;  // of the experiments
  const auto answers = [&](const std::vector<std::string>& asked) {
    ExperimentRunner runner(study, basis, asked, testing::kFactory);
    Answers all;
    for (std::int64_t index = 0; index < 3; ++index)
      all.push_back(runner.run(index, StorePolicy::none).assessments);
    return all;
  };
  Answers together, backwards;
  std::thread beside([&] { backwards = answers(reversed); });
  together = answers(methods);
  beside.join();
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const Answers alone = answers({methods[method]});
    for (std::size_t index = 0; index < together.size(); ++index) {
      INFO(methods[method] << " on experiment " << index);
      const AssessmentRecord& said = together[index][method];
      REQUIRE(said.status != AssessmentStatus::not_assessed);
      CHECK(same(said, alone[index].front()));
      CHECK(same(said, backwards[index][methods.size() - 1 - method]));
    }
  }
}

TEST_CASE("the time of an answer is that of the method alone, whoever was asked before", "[panel]") {
  Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessedLoop loop = assessed_loop(
      study, basis.point, simulate_experiment(study, draw_experiment(study, 15), testing::kFactory));
  const auto milliseconds = [&](const std::vector<std::string>& methods) {
    MethodPanel panel(study, assessment_context(study, basis, testing::kFactory), methods);
    panel.assess(loop);  // learns
    return panel.assess(loop).back().milliseconds;
  };
  const double alone = milliseconds({"likelihood"});
  const double after = milliseconds({"mpmbench", "likelihood"});
  CHECK(after > 0.3 * alone);
}

}  // namespace mpm
