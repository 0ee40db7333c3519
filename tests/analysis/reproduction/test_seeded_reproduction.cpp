#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/reproduction/seeded_reproduction.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// One row with a judged and an unjudged cell. Without a number there is a remark and no verdict.
ReproducedTable run_of(double ours) {
  const bool none = std::isnan(ours);
  const std::optional<std::string> verdict =
      none ? std::nullopt : std::optional<std::string>(ours > 1.0 ? "yes" : "no");
  return {{},
          {{"row",
            none ? "it stopped" : "",
            {{{"y1", "ivar", 2.0}, ours, verdict, "yes"}, {{"y2", "sse"}, ours, {}, {}}}}}};
}

}  // namespace

TEST_CASE("over seeds: the share of all seeds that agree, the median of those with a number",
          "[reproduction]") {
  const double nan = kNaN;
  const SeededTable table = over_seeds({run_of(9.0), run_of(0.5), run_of(nan), run_of(2.0), run_of(3.0)});
  CHECK(table.judged == 1);
  CHECK(table.agreeing == std::vector<int>{1, 0, 0, 1, 1});
  CHECK(table.mean_agreeing() == Approx(0.6));
  const SeededRow& row = table.rows.at(0);
  CHECK(row.remark == "1 of 5 seeds: it stopped");
  CHECK(row.cells[0].share == 0.6);
  CHECK(row.cells[0].numbers == 4);
  CHECK(row.cells[0].median == 2.5);  // of 0.5, 2, 3, 9
  CHECK_FALSE(row.cells[1].share);
  CHECK(row.cells[1].median == 2.5);
}

TEST_CASE("over seeds: without a number in any seed there is no median, and no agreement", "[reproduction]") {
  const double nan = kNaN;
  const SeededTable table = over_seeds({run_of(nan), run_of(nan)});
  CHECK(std::isnan(table.rows[0].cells[0].median));
  CHECK(table.rows[0].cells[0].share == 0.0);
}

TEST_CASE("the seeds of all studies of a table are raised", "[reproduction]") {
  ThesisTable table;
  Study study = find_study("chapter4-shell");
  study.seed = 5;
  table.studies.emplace("", study);
  study.seed = 9;
  table.studies.emplace("variant", study);
  const ThesisTable raised = with_seed_offset(table, 3);
  CHECK(raised.studies.at("").seed == 8);
  CHECK(raised.studies.at("variant").seed == 12);
}

}  // namespace mpm
