#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

using Catch::Contains;

using Names = std::vector<std::string>;

const std::string kKnown =
    "botelho, sun, badwe2009, badwe2010, yu-qin, variance-ratio, sse, counterfactual, mpmbench, order, "
    "excitation, "
    "candidates, likelihood, adequacy, ceiling, lasso, local, mqi-channels, arx-oe, pmr, autocovariance";

}  // namespace

TEST_CASE("methods by name: as they are asked for, and all of them by one word") {
  CHECK(shipped_methods().known({"sse", "botelho"}, "x") == Names{"sse", "botelho"});
  CHECK(shipped_methods().known({"all"}, "x") == shipped_methods().names());
  CHECK(shipped_methods().names().front() == "botelho");
  for (const std::string& name : shipped_methods().names())
    CHECK(assessment_method(name).name == name);
}

TEST_CASE("methods by name: no method, an unknown one, and one twice are refused under the name of the key") {
  const std::string allowed = "; allowed: each once: " + kKnown + "; or all";
  CHECK_THROWS_WITH(shipped_methods().known({}, "--methods"), "--methods: found no method" + allowed);
  CHECK_THROWS_WITH(shipped_methods().known({"sse", "nobody"}, "k"), "k: found 'nobody'" + allowed);
  CHECK_THROWS_WITH(shipped_methods().known({"sse", "sun", "sse"}, "k"), "k: found 'sse' twice" + allowed);
  CHECK_THROWS_WITH(shipped_methods().known({"all", "sse"}, "k"), "k: found 'all'" + allowed);
  CHECK_THROWS_AS(shipped_methods().known({}, "k"), InputError);
  CHECK_THROWS_WITH(assessment_method("nobody"), "method: found 'nobody'; allowed: " + kKnown);
  CHECK_THROWS_WITH(assessment_method("likelyhood"),
                    "method: found 'likelyhood' (nearest: 'likelihood'); allowed: " + kKnown);
}

TEST_CASE("methods of a study: those of its file, the thesis's chain when it names none") {
  Study study = find_study("chapter6");
  CHECK(study_methods(study) == Names{"botelho"});
  study.methods = {"all"};
  CHECK(study_methods(study) == shipped_methods().names());
  study.methods.clear();
  CHECK_THROWS_WITH(study_methods(study), Contains("methods.names: found no method"));
}

TEST_CASE("variants of methods are asked for by name, and are not among all of them") {
  CHECK(shipped_methods().known({"sun:corrected", "sse+lasso"}, "x") == Names{"sun:corrected", "sse+lasso"});
  for (const AssessmentMethodInfo& variant : shipped_methods().variants()) {
    INFO(variant.name);
    const Names all = shipped_methods().names();
    CHECK(std::find(all.begin(), all.end(), variant.name) == all.end());
    CHECK(&shipped_methods().method(variant.name) == &variant);
    CHECK_FALSE(variant.options);  // [assessment.NAME] is that of the method
  }
  CHECK_THROWS_WITH(shipped_methods().known({"sun:correct"}, "k"), Contains("nearest: 'sun:corrected'"));
  CHECK_FALSE(shipped_methods().has("yu-qin:corrected"));  // it does not look at y_sim
  MethodTable table;
  AssessmentMethodInfo mine = assessment_method("sse");
  mine.name = "mine";
  table.add(mine);
  CHECK(table.has("mine:uncorrected"));
}

TEST_CASE("every method describes itself, and each of its numbers once") {
  std::set<std::string> names;
  for (const AssessmentMethodInfo& method : shipped_methods().methods()) {
    INFO(method.name);
    CHECK(names.insert(method.name).second);
    CHECK_FALSE(method.title.empty());
    CHECK_FALSE(method.verdict.empty());
    CHECK(method.make);
    std::vector<AssessmentNumberInfo> numbers = method.numbers;
    if (method.scenario_numbers)
      for (const AssessmentNumberInfo& number : method.scenario_numbers())
        numbers.push_back(number);
    // The names that every method has for what it tells.
    std::set<std::string> of_method{"cv_flagged",      "cv_score",           "cv_source",
                                    "channel_flagged", "mismatch_parameter", "mismatch_size",
                                    "mismatch_lower",  "mismatch_upper",     "mismatch_bound",
                                    "named_candidate", "told_source",        "reason"};
    for (const AssessmentNumberInfo& number : numbers) {
      INFO(number.name);
      CHECK(of_method.insert(number.name).second);
      CHECK_FALSE(number.meaning.empty());
      CHECK_FALSE(number.unit.empty());
      CHECK((number.finding != NumberFinding::summary ||
             (number.scope == NumberScope::loop && !number.heading.empty())));
    }
  }
}

TEST_CASE("a method that locates CVs, flags a loop and names none has no verdict on it") {
  class Undecided final : public AssessmentMethod {
   public:
    Assessment assess(const AssessedLoop& loop) override {
      Assessment assessment;
      assessment.flagged = true;
      assessment.score = 2.0;
      assessment.cvs.resize(static_cast<std::size_t>(loop.y.rows()));
      return assessment;
    }
  };
  const Study study = find_study("chapter6");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const AssessmentContext context = assessment_context(study, basis, testing::kFactory);
  const AssessedLoop loop = assessed_loop(study, basis.point, basis.trajectory);
  AssessmentMethodInfo info;
  info.make = [](const AssessmentContext&) { return std::make_unique<Undecided>(); };
  CHECK(Assessor(info, context).assess(loop).flagged);
  info.locates_cvs = true;
  const Assessment said = Assessor(info, context).assess(loop);
  CHECK(said.status == AssessmentStatus::failed);
  CHECK(said.reason == "it flags the loop and names no CV");
}

}  // namespace mpm
