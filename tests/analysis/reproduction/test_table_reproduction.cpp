#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_cases.hpp"
#include "analysis/basis/basis_runs.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/experiment_record.hpp"
#include "analysis/reproduction/scenario_quantities.hpp"
#include "analysis/reproduction/table_reproduction.hpp"
#include "analysis/study_files/study_library.hpp"
#include "analysis/study_files/table_file.hpp"
#include "base/error.hpp"
#include "scenarios/loop/draw.hpp"
#include "tests/analysis/made_up_record.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

using Numbers = std::vector<std::optional<double>>;
using Verdicts = std::vector<std::optional<std::string>>;

const std::optional<double> kNone;
const std::optional<std::string> kNoVerdict;
VerdictRule rule_of(RuleKind kind, double lower = 0.0, double upper = 0.0) {
  return {{"ivar"}, kind, lower, upper, "yes", "no", "here"};
}

}  // namespace

TEST_CASE("outside: each number by itself, the edges of the band are inside", "[reproduction]") {
  CHECK(judge(rule_of(RuleKind::outside, 0.8, 1.2), Numbers{0.79, 0.8, kNone, 1.2, 1.21}) ==
        Verdicts{"yes", "no", kNoVerdict, "no", "yes"});
}

TEST_CASE("any-above and any-within: one number decides for all that are there", "[reproduction]") {
  const VerdictRule above = rule_of(RuleKind::any_above, 0.1);
  CHECK(judge(above, Numbers{0.05, 0.2, kNone}) == Verdicts{"yes", "yes", kNoVerdict});
  CHECK(judge(above, Numbers{0.05, 0.1, kNone}) == Verdicts{"no", "no", kNoVerdict});
  CHECK(judge(above, Numbers{kNone}) == Verdicts{kNoVerdict});
  const VerdictRule within = rule_of(RuleKind::any_within, 40, 50);
  CHECK(judge(within, Numbers{45.0, 60.0}) == Verdicts{"yes", "yes"});
  CHECK(judge(within, Numbers{40.0, 60.0}) == Verdicts{"no", "no"});
}

TEST_CASE("rank: from the smallest on, equal ones share a place, missing ones have none", "[reproduction]") {
  CHECK(judge(rule_of(RuleKind::rank), Numbers{3.0, 1.0, kNone, 3.0, 2.0}) ==
        Verdicts{"3", "1", kNoVerdict, "3", "2"});
}

TEST_CASE("a cell agrees when both verdicts are alike; a number that we lack does not agree",
          "[reproduction]") {
  ReproducedCell cell{{"y1", "ivar", 2.0}, 3.0, "yes", "yes"};
  CHECK(cell.ratio() == 1.5);
  CHECK(cell.agrees() == true);
  cell.our_verdict.reset();
  CHECK(cell.agrees() == false);
  cell.ours = std::nan("");
  CHECK_FALSE(cell.ratio());
  cell.thesis_verdict.reset();
  CHECK_FALSE(cell.agrees());
  cell.ours = 1.0;
  cell.cell.thesis = 0.0;
  CHECK_FALSE(cell.ratio());
}

TEST_CASE("the numbers of a table are those of the experiments of a run", "[reproduction]") {
  ThesisTable table;
  table.number = "4.5";
  const Study& study = table.studies.emplace("", find_study("chapter4-shell")).first->second;
  table.heads = {"ivar", "ivar_diag", "ivar_basis"};
  table.rules = {rule_of(RuleKind::outside, 0.8, 1.2)};
  table.rows = {{"1", "", "Scen1", {{"y1", "ivar", 4.54}, {"y1", "ivar_diag", {}}, {"y1", "ivar_basis", {}}}},
                {"basis", "", "", {{"y2", "ivar", 9.0}, {"y2", "ivar_diag", {}}, {"y2", "ivar_basis", {}}}}};
  BasisCases basis_cases(testing::kFactory);
  const ReproducedTable result = reproduced(table, table_numbers(table, testing::kFactory, basis_cases));
  REQUIRE(result.rows.size() == 2);

  const BasisCase basis = run_basis_case(study, testing::kFactory);
  const ExperimentRecord record =
      ExperimentRunner(study, basis, {"botelho"}, testing::kFactory).run(1, StorePolicy::none);
  const Diagnosis diagnosis = testing::diagnosis_of(record.chain());
  const std::vector<ReproducedCell>& cells = result.rows[0].cells;
  CHECK(cells[0].ours == diagnosis.ivar(0));  // the same bits
  CHECK(cells[1].ours == diagnosis.ivar_diag(0));
  CHECK(cells[2].ours == record.ivar_basis(0));
  CHECK(cells[0].agrees() == true);
  CHECK_FALSE(cells[1].agrees());  // no rule

  CHECK(result.rows[1].cells[0].ours == basis.diagnosis.ivar(1));
  CHECK(result.rows[1].cells[2].ours == 1.0);  // of the basis case against itself
  CHECK(result.rows[1].cells[0].agrees() == false);
  const Agreement agreement = result.agreement();
  CHECK(agreement.agreeing == 1);
  CHECK(agreement.judged == 2);
}

TEST_CASE("a loop that stops has a remark and no numbers", "[reproduction]") {
  ThesisTable table;
  Study study = find_study("chapter4-shell");
  study.controller.cv_hard.upper.setConstant(1e-3);  // no setpoint step can be kept
  table.studies.emplace("", study);
  table.heads = {"ivar"};
  table.rules = {rule_of(RuleKind::outside, 0.8, 1.2)};
  table.rows = {{"1", "", "Scen1", {{"y1", "ivar", 4.54}}}};
  BasisCases basis_cases(testing::kFactory);
  const ReproducedRow row =
      reproduced(table, table_numbers(table, testing::kFactory, basis_cases)).rows.at(0);
  CHECK_FALSE(row.remark.empty());
  CHECK(std::isnan(row.cells[0].ours));
  CHECK(row.cells[0].agrees() == false);
}

TEST_CASE("a quantity that there is not is refused by name", "[reproduction]") {
  const Study study = find_study("chapter4-shell");
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ScenarioQuantities quantities(study, basis, basis_draw(), testing::kFactory, std::nullopt);
  CHECK_THROWS_WITH(quantities.value("ivarr", 0), Catch::Contains("quantity: found 'ivarr'"));
  for (const TableQuantity& quantity : ScenarioQuantities::known())
    CHECK_NOTHROW(quantities.value(quantity.name, 0, 0));
  CHECK(quantities.value("botelho.ivar", 0) == quantities.value("ivar", 0));  // the same chain
  CHECK(quantities.value("botelho.loop_flagged", -1) == 0.0);
  CHECK(quantities.value("squared_error", 0) == Approx(std::pow(quantities.value("sse", 0), 2)));
}

TEST_CASE("every shipped table is read, under the name of its file", "[reproduction]") {
  const std::vector<ThesisTable> tables = find_tables("all", ScenarioQuantities::known());
  CHECK(tables.size() >= 19);
  for (const ThesisTable& table : tables) {
    INFO(table.number);
    CHECK(std::filesystem::exists(table_directory() /
                                  ((table.figure ? "figure-" : "table-") + table.number + ".toml")));
    CHECK_FALSE(table.rows.empty());
  }
}

}  // namespace mpm
