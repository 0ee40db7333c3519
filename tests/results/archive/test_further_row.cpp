#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "results/archive/archive_groups.hpp"
#include "results/archive/archive_record_reader.hpp"
#include "results/archive/csv_table.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/files/atomic_file.hpp"
#include "tests/results/made_up_campaign.hpp"

// A further fact of an experiment costs one row: archive, bytes of shards, comparison and CSV have it then.

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

bool has_row(const RecordTable& table, std::string_view name) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [name](const auto& row) { return row.text.name == name; });
}

/// The tables without the row of a member, whose name is free for another.
std::vector<RecordTable> tables_of(const Campaign& campaign) {
  std::vector<RecordTable> tables = record_tables(campaign.study, forms_of(campaign));
  for (RecordTable& table : tables)
    std::erase_if(table.rows, [](const auto& row) { return row.text.name == "solver_fallbacks"; });
  return tables;
}

/// The same with a row more, of that member.
std::vector<RecordTable> tables_with_fact(const Campaign& campaign) {
  std::vector<RecordTable> tables = tables_of(campaign);
  const auto outcomes = std::find_if(tables.begin(), tables.end(),
                                     [](const RecordTable& table) { return has_row(table, "status"); });
  REQUIRE(outcomes != tables.end());
  outcomes->rows.push_back(member_row<std::int64_t, ExperimentRecord>(
                               {"fact", "answers of another solver", "1", "from 0"},
                               path(&ExperimentRecord::solver, &SolverStatistics::fallbacks))
                               .from_version(6));
  return tables;
}

/// A campaign in which each experiment has this fact.
Campaign campaign_with_fact() {
  Campaign campaign = drawn_campaign();
  for (ExperimentRecord& record : campaign.records)
    record.solver.fallbacks = 1000 + record.draw.index;
  return campaign;
}

/// The records as an archive with these tables has them.
Hdf5Group written(const TemporaryFolder& folder, const Campaign& campaign,
                  const std::vector<RecordTable>& tables) {
  const Hdf5File file = Hdf5File::create("a.h5");
  Hdf5Group root = file.root();
  write_records(root, campaign, tables);
  write_methods(root, campaign, findings_of(campaign));
  write_file_atomically(folder / "a.h5", file.image());
  return Hdf5File::open(folder / "a.h5").root();
}

std::vector<ExperimentRecord> read(const Hdf5Group& root, const Campaign& campaign) {
  const ArchiveRecordReader reader(root, campaign.study, forms_of(campaign), tables_with_fact(campaign),
                                   "a.h5");
  return reader.read(0, reader.size());
}

TEST_CASE("further row: an archive has it with what is said of it, and gives it back") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_with_fact();
  const Hdf5Group root = written(folder, campaign, tables_with_fact(campaign));
  const std::vector<std::string> names = root.variables();
  CHECK(std::count(names.begin(), names.end(), "fact") == 1);
  const std::vector<ExperimentRecord> records = read(root, campaign);
  REQUIRE(records.size() == campaign.records.size());
  for (const ExperimentRecord& record : records)
    CHECK(record.solver.fallbacks == 1000 + record.draw.index);
}

TEST_CASE("further row: archives of earlier minor versions are read without it") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_with_fact();
  for (const ExperimentRecord& record : read(written(folder, campaign, tables_of(campaign)), campaign))
    CHECK(record.solver.fallbacks == 0);
}

TEST_CASE("further row: bytes keep it, and a comparison names it") {
  const Campaign campaign = campaign_with_fact();
  const RecordBytes bytes(campaign.study, tables_with_fact(campaign));
  const ExperimentRecord& record = campaign.records.front();
  CHECK(bytes.from_bytes(bytes.to_bytes(record)).solver.fallbacks == 1000);
  ExperimentRecord other = record;
  other.solver.fallbacks = 7;
  CHECK(bytes.differences(record, other) == std::vector<std::string>{"fact"});
}

TEST_CASE("further row: a CSV table has a column of it") {
  const Campaign campaign = campaign_with_fact();
  std::string text;
  write_csv_records(campaign, tables_with_fact(campaign), "",
                    [&text](std::string_view piece) { text += piece; });
  CHECK_THAT(text.substr(0, text.find('\n')), Contains(",fact"));
  CHECK_THAT(text, Contains(",1001") && Contains(",1002"));
}

}  // namespace
