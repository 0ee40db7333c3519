#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/csv_table.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

using Row = std::vector<std::string>;

/// A table as RFC 4180 has it, by a reader that knows nothing of the writer.
std::vector<Row> parsed(const std::string& csv) {
  std::vector<Row> rows;
  Row row;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (quoted && c == '"' && i + 1 < csv.size() && csv[i + 1] == '"') {
      field += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == ',' || c == '\n')) {
      row.push_back(field);
      field.clear();
      if (c == '\n') {
        rows.push_back(row);
        row.clear();
      }
    } else {
      field += c;
    }
  }
  CHECK((field.empty() && row.empty()));  // the last line ends
  return rows;
}

/// A table with its columns by name.
class Table {
 public:
  Table(const Campaign& campaign, const std::string& name) : rows_(parsed(csv_table(campaign, name))) {
    for (const Row& row : rows_)
      CHECK(row.size() == head().size());
  }

  std::size_t size() const { return rows_.size() - 1; }
  const Row& head() const { return rows_.front(); }
  const std::string& at(std::size_t row, const std::string& column) const {
    const auto place = std::find(head().begin(), head().end(), column);
    if (place == head().end())
      throw std::out_of_range("no column " + column);
    return rows_.at(row + 1).at(static_cast<std::size_t>(place - head().begin()));
  }

 private:
  std::vector<Row> rows_;
};

TEST_CASE("csv table: one row an experiment, with flags as words and CVs and MVs by name") {
  Campaign campaign = made_up_campaign();
  campaign.records[0].ivar_basis = Eigen::Vector2d(0.1, std::nan(""));
  const Table table(campaign, "experiments");
  REQUIRE(table.size() == campaign.records.size());
  CHECK(table.head().front() == "experiment");
  for (std::size_t i = 0; i < table.size(); ++i) {
    const ExperimentRecord& record = campaign.records[i];
    CHECK(table.at(i, "experiment") == fmt::format("{}", record.draw.index));
    CHECK(table.at(i, "kind") == to_string(record.draw.kind));
    CHECK(table.at(i, "status") == to_string(record.status));
    const Eigen::Index cv = record.draw.true_cv();
    CHECK(table.at(i, "true_cv") == campaign.study.plant.cvs[static_cast<std::size_t>(cv)].name);
    CHECK(table.at(i, "flagged.sse") == (record.by("sse")->flagged ? "yes" : "no"));
  }
  CHECK(table.at(0, "ivar_basis.level") == "0.1");
  CHECK(table.at(0, "ivar_basis.heat") == "NaN");
  CHECK(table.at(1, "parameter") == "none");  // a disturbance alone
  CHECK(table.at(1, "parameter_value") == "NaN");
  CHECK(table.at(3, "ivar_basis.level") == "NaN");  // infeasible
  CHECK(table.at(3, "assessment_status.botelho") == "not_assessed");
  for (const std::string& name : table.head())
    CHECK(name.find("seconds") == std::string::npos);  // differs from run to run
}

TEST_CASE("csv table: what has a comma, a quote or a line end stands in quotes") {
  Campaign campaign = made_up_campaign();
  const std::string message = "died: \"a\", b\nc";
  campaign.records[4].message = message;
  CHECK(Table(campaign, "experiments").at(4, "message") == message);
  CHECK(csv_table(campaign, "experiments").find("\"died: \"\"a\"\", b\nc\"") != std::string::npos);
  campaign.study.plant.cvs[0].name = "level, left";
  CHECK(Table(campaign, "experiments").head().size() ==
        Table(made_up_campaign(), "experiments").head().size());
}

TEST_CASE("csv table: the numbers of a method, a column a coordinate") {
  const Campaign campaign = scenario_campaign();
  const Table table(campaign, "botelho");
  REQUIRE(table.size() == 5);
  const AssessmentRecord& said = *campaign.records[0].by("botelho");
  CHECK(table.at(0, "ivar.heat") == fmt::format("{}", said.number("ivar", 1)));
  const double acf = said.number("cv_acf_y", 1, 3);
  CHECK(table.at(0, "cv_acf_y.heat.3") == (acf != acf ? "NaN" : fmt::format("{}", acf)));
  CHECK(table.at(4, "cv_loop_speed.level") == "no_answer");
  CHECK(table.at(4, "ivar.heat") == "NaN");
}

TEST_CASE("csv table: the findings, a row each") {
  const Campaign campaign = made_up_campaign();
  const std::vector<Finding> rows = findings_of(campaign).rows;
  const Table table(campaign, "findings");
  REQUIRE(table.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(table.at(i, "name") == rows[i].name);
    CHECK(table.at(i, "meaning") == rows[i].meaning);
    CHECK(table.at(i, "value") == (std::isnan(rows[i].value) ? "NaN" : fmt::format("{}", rows[i].value)));
    CHECK(table.at(i, "count") == fmt::format("{}", rows[i].count));
  }
}

TEST_CASE("csv table: the kept loops, a row a sample") {
  Campaign campaign = made_up_campaign();
  ExperimentRecord& record = campaign.records[1];
  record.loop->trajectory.y(1, 7) = 0.625;
  record.loop->trajectory.d(0, 59) = -2.5;
  record.loop->y_sim(0, 0) = INFINITY;
  const Table table(campaign, "loops");
  REQUIRE(table.size() == 20 * 60);  // every second experiment keeps its loop
  CHECK(table.at(7, "experiment") == "1");
  CHECK(table.at(7, "sample") == "7");
  CHECK(table.at(7, "time") == "7");
  CHECK(table.at(7, "y.heat") == "0.625");
  CHECK(table.at(59, "d.drain") == "-2.5");
  CHECK(table.at(0, "y_sim.level") == "inf");
  CHECK(table.at(60, "experiment") == "3");
  CHECK(Table(empty_campaign(), "loops").size() == 0);
  CHECK(Table(empty_campaign(), "experiments").size() == 0);
}

TEST_CASE("csv table: another name is refused with the tables that there are") {
  const Campaign campaign = made_up_campaign();
  std::vector<std::string> names{"experiments", "findings", "loops"};
  for (const std::string& method : method_names(campaign))
    names.push_back(method);
  CHECK(csv_table_names(campaign) == names);
  CHECK_THROWS_WITH(csv_table(campaign, "trajectories"),
                    "--table: found 'trajectories'; allowed: " + fmt::format("{}", fmt::join(names, ", ")));
}

TEST_CASE("csv: of records that stay in the archive every table is the same") {
  const TemporaryFolder folder;
  const Campaign campaign = made_up_campaign();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const Campaign read = read_archive(folder / "a.h5"), streamed = stream_archive(folder / "a.h5");
  REQUIRE(streamed.records.empty());
  for (const std::string& table : csv_table_names(read))
    CHECK((csv_table(streamed, table) == csv_table(read, table)));
}

}  // namespace
