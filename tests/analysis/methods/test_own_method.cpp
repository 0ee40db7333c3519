#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/resolved_study.hpp"
#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "tests/solvers/active_set_factory.hpp"

// A method of the tests: all that the program knows of it, and of its option, stands in this source.

namespace mpm {
namespace {

struct PeakOptions {
  double limit = 2.0;

  bool operator==(const PeakOptions&) const = default;
};

OptionKeys keys(PeakOptions& options) {
  return {key::number("limit", options.limit, NumberRule::positive(), "of |y - y_sim|")};
}

class Peak final : public AssessmentMethod {
 public:
  explicit Peak(const AssessmentContext& context) : options_(context.study.assessment.of<PeakOptions>()) {}

  Assessment assess(const AssessedLoop& loop) override {
    Assessment assessment;
    assessment.score = (loop.y - loop.y_sim).cwiseAbs().maxCoeff();
    assessment.flagged = assessment.score > options_.limit;
    assessment.numbers.push_back({"peak", assessment.score});
    return assessment;
  }

 private:
  const PeakOptions& options_;
};

AssessmentMethodInfo peak_method() {
  return {{.name = "peak",
           .title = "largest simulation error",
           .verdict = "it is above the limit",
           .requirements = {},
           .numbers = {{"peak", NumberScope::loop, "largest |y - y_sim|"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<Peak>(context); },
          option_table<PeakOptions>(keys, "of the largest error")};
}

}  // namespace

TEST_CASE("the options of a method that is one source are keys of study files") {
  const auto table = std::make_shared<MethodTable>();
  table->add(peak_method());
  CHECK_THROWS_WITH(table->add(peak_method()), Catch::Contains("found 'peak' from outside"));
  const Study shipped = find_study("chapter6");
  const Study chapter6 = parse_study(shipped.source, shipped.name, table);
  const auto with = [&](const std::string& options) {
    return parse_study(chapter6.source + "\n[assessment.peak]\n" + options, "s.toml", table);
  };
  CHECK_THROWS_WITH(parse_study(shipped.source + "\n[assessment.peak]\n", "s.toml"),
                    Catch::Contains("unknown key 'peak'"));

  const Study study = with("limit = 1e-3");
  CHECK(study.assessment.of<PeakOptions>().limit == 1e-3);
  CHECK(study.assessment != chapter6.assessment);
  CHECK(with("limit = 2").assessment == chapter6.assessment);
  CHECK(changed_study(chapter6, {{"assessment.peak.limit", "1e-3"}}, "--set").assessment == study.assessment);
  CHECK_THROWS_WITH(with("limt = 3"), Catch::Contains("assessment.peak: ") &&
                                          Catch::Contains("unknown key 'limt' (nearest: 'limit')"));
  CHECK_THROWS_WITH(with("limit = 0"), Catch::Contains("assessment.peak.limit: found 0; allowed: "));
  CHECK_THROWS_WITH(parse_study(chapter6.source + "\n[assessment.peek]\n", "s.toml", table),
                    Catch::Contains("unknown key 'peek' (nearest: 'peak')"));

  CHECK_THAT(resolved_study(chapter6), Catch::Contains("\n[assessment.peak]\nlimit = 2.0\n"));
  const std::vector<std::string> changed = changed_defaults(study);
  CHECK(std::count(changed.begin(), changed.end(), "assessment.peak.limit = 0.001 (default: 2.0)") == 1);
  MethodOptions options;
  CHECK_THAT(manual_table(table->option_tables().back().keys(options)),
             Catch::Contains("| `limit` | number | 2 | > 0 |"));

  const BasisCase basis = run_basis_case(chapter6, testing::kFactory);
  const AssessedLoop loop = assessed_loop(chapter6, basis.point, basis.trajectory);
  const auto flags = [&](const Study& of) {
    const AssessmentContext context = assessment_context(of, basis, testing::kFactory);
    return Assessor(method_table(of.assessment).method("peak"), context).assess(loop).flagged;
  };
  CHECK(flags(study));
  CHECK_FALSE(flags(chapter6));
}

}  // namespace mpm
