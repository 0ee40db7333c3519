#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <malloc.h>

#include "base/error.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/parts/loop_ranges.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/file_seal.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
namespace fs = std::filesystem;

const ShardIdentity kIdentity{{"program", "p"}, {"study", "s"}, {"seed", "7"}};

/// The study of the outcomes, which every method assesses.
const Study& study() {
  static const Study study = drawn_campaign().study;
  return study;
}

ExperimentOutcome outcome_of(std::int64_t index) {
  ExperimentOutcome outcome;
  outcome.record = lost_record(study(), index, fmt::format("experiment {}", index));
  outcome.audited.resize(2);
  outcome.audited.back().experiment = index;
  outcome.audit_seconds = 0.5;
  return outcome;
}

/// Reads a shard whose entries do not matter.
std::optional<double> seconds_of(const fs::path& path, const ShardIdentity& identity = kIdentity) {
  const std::optional<ShardContent> content = read_shard(path, identity);
  return content ? std::optional(content->seconds) : std::nullopt;
}

fs::path written(const TemporaryFolder& folder, const std::vector<std::int64_t>& keys) {
  ShardBytes bytes;
  for (const std::int64_t key : keys)
    bytes.add(key, fmt::format("entry {}", key));
  bytes.write(folder / "a.shard", kIdentity, 1.5);
  return folder / "a.shard";
}

void make_sealed(const fs::path& path, const std::string& content) {
  const auto bytes = std::as_bytes(std::span(content));
  write_file_atomically(path, sealed({bytes.begin(), bytes.end()}));
}

RunOptions five(Leftovers leftovers = Leftovers::resume) {
  RunOptions options;
  options.experiments = 5;
  options.leftovers = leftovers;
  return options;
}

const CampaignLoops& loops() {
  static const CampaignLoops loops(study(), five());
  return loops;
}

/// A store of five experiments.
ShardStore store_of(const fs::path& folder, Leftovers leftovers = Leftovers::resume,
                    std::vector<std::string>* warnings = nullptr, std::int64_t count = 5,
                    const Study& of = study()) {
  RunOptions options = five(leftovers);
  options.experiments = count;
  return CampaignLoops(of, options).open(folder, [=](const std::string& text) {
    if (warnings != nullptr)
      warnings->push_back(text);
  });
}

void add(ShardStore& store, const ExperimentOutcome& outcome) {
  const std::int64_t index = outcome.record.draw.index;
  store.add(index, loops().result(index, outcome).bytes);
}

/// Leaves a shard for each of these.
void leave_behind(const fs::path& folder, const std::vector<ExperimentOutcome>& outcomes) {
  ShardStore store = store_of(folder);
  for (const ExperimentOutcome& outcome : outcomes) {
    add(store, outcome);
    store.flush();
  }
}

using Keys = std::vector<std::int64_t>;

void leave_behind(const fs::path& folder, const Keys& keys) {
  std::vector<ExperimentOutcome> outcomes;
  for (const std::int64_t key : keys)
    outcomes.push_back(outcome_of(key));
  leave_behind(folder, outcomes);
}

Keys keys_in(const ShardStore& store, std::int64_t first = 0, std::int64_t end = kCalibrationKeys) {
  Keys keys;
  const ShardStore::Next next = store.in_order(first, end);
  while (const ShardStore::Entry* const entry = next())
    keys.push_back(entry->key);
  return keys;
}

Keys missing_in(const ShardStore& store, std::int64_t count = 5) {
  return store.missing(indices_in({{0, count}}));
}

TEST_CASE("shard: outcomes come back with every bit, loops and audits among them") {
  const TemporaryFolder folder;
  const Campaign campaign = drawn_campaign();
  std::vector<ExperimentOutcome> expected;
  for (const ExperimentRecord& record : campaign.records) {
    ExperimentOutcome outcome = outcome_of(0);
    outcome.record = record;
    expected.push_back(outcome);
  }
  RunOptions options = five();
  options.experiments = std::ssize(expected);
  const CampaignLoops all(campaign.study, options);
  ShardStore store = all.open(folder / "s", {});
  for (const ExperimentOutcome& outcome : expected)
    store.add(outcome.record.draw.index, all.result(0, outcome).bytes);
  store.flush();
  const RecordBytes records(campaign.study, forms_of(campaign));
  const ShardStore::Next next = store.in_order(0, kCalibrationKeys);
  for (const ExperimentOutcome& outcome : expected) {
    const ShardStore::Entry* const entry = next();
    REQUIRE(entry != nullptr);
    const ExperimentOutcome read = all.outcome(*entry);
    CHECK(all.result(0, read).bytes == all.result(0, outcome).bytes);
    CHECK(records.differences(read.record, outcome.record) == std::vector<std::string>{});
    CHECK(read.audited.size() == 2);
  }
  CHECK(next() == nullptr);
}

TEST_CASE("shard: cut off anywhere or with any byte changed, it is seen to be damaged") {
  const TemporaryFolder folder;
  const fs::path path = written(folder, {3});
  const std::string whole = file_content(path);
  REQUIRE(seconds_of(path));
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    make_file(path, whole.substr(0, i));
    CHECK_FALSE(seconds_of(path));
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    make_file(path, changed);
    CHECK_FALSE(seconds_of(path));
  }
  CHECK_THROWS_AS(seconds_of(folder / "none.shard"), ShardGone);
}

TEST_CASE("shard: one of another run, format version or file type is refused, and the difference named") {
  const TemporaryFolder folder;
  const fs::path path = written(folder, {3});
  ShardIdentity other = kIdentity;
  other[2] = {"seed", "8"};
  CHECK_THROWS_WITH(seconds_of(path, other),
                    Contains("a.shard") && Contains("another seed") && Contains("found 7; allowed: 8"));
  other = kIdentity;
  other.pop_back();
  CHECK_THROWS_AS(seconds_of(path, other), InputError);
  other = kIdentity;
  other.push_back({"solver", "auto"});
  CHECK_THROWS_WITH(seconds_of(path, other), Contains("another solver"));

  const std::string whole = file_content(path);
  std::string content = whole.substr(0, whole.size() - kSealBytes);
  const std::size_t version = std::string("mpmbench shard\n").size();
  content[version] = 9;
  make_sealed(path, content);
  CHECK_THROWS_WITH(seconds_of(path), Contains("format version") && Contains("found 9; allowed: 3"));
  make_sealed(path, "some other file");
  CHECK_THROWS_WITH(seconds_of(path), Contains("a shard of mpmbench"));
}

TEST_CASE("shard store: what an earlier run has left is not missing, and comes in the order of the keys") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{4, 1});
  ShardStore store = store_of(folder / "s");
  CHECK(missing_in(store) == Keys{0, 2, 3});
  CHECK(store.seconds() > 0.0);
  CHECK_FALSE(store.has_repeated());
  for (const std::int64_t key : {3, 0, 1, 2})  // 1 a second time
    add(store, outcome_of(key));
  store.flush();
  CHECK(store.has_repeated());
  CHECK(keys_in(store) == Keys{0, 1, 1, 2, 3, 4});
  CHECK(keys_in(store, 2, 4) == Keys{2, 3});
  std::int64_t count = 0;
  loops().experiment_records(store, {}).each(
      [&](const ExperimentRecord& record) { CHECK(record.draw.index == count++); });
  CHECK(count == 5);
}

TEST_CASE("shard store: without a folder it is in memory, with the same entries in the same order") {
  ShardStore store = loops().in_memory();
  for (const std::int64_t key : {3, 0, 4})
    add(store, outcome_of(key));
  CHECK(missing_in(store) == Keys{1, 2});
  CHECK(keys_in(store) == Keys{0, 3, 4});
  CHECK(keys_in(store, 1, 4) == Keys{3});
}

TEST_CASE("shard store: a longer run takes up a shorter one, and a shorter one refuses a longer one") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{4, 1});
  CHECK(missing_in(store_of(folder / "s", Leftovers::resume, nullptr, 7), 7) == Keys{0, 2, 3, 5, 6});
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::resume, nullptr, 4),
                    Contains("--experiments") && Contains("5 or more"));
  CHECK(missing_in(store_of(folder / "s")) == Keys{0, 2, 3});
  CHECK(missing_in(store_of(folder / "s", Leftovers::renew, nullptr, 4), 4) == Keys{0, 1, 2, 3});
}

TEST_CASE("shard store: a damaged shard is named, what it holds is missing, and nothing is overwritten") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{0, 1, 2});
  const fs::path damaged = folder / "s" / "00000002.shard";
  make_file(damaged, file_content(damaged).substr(0, 50));
  std::vector<std::string> warnings;
  ShardStore store = store_of(folder / "s", Leftovers::resume, &warnings);
  CHECK(missing_in(store) == Keys{1, 3, 4});
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings.front(), Contains("00000002.shard") && Contains("run again"));
  add(store, outcome_of(1));
  store.flush();
  CHECK(fs::exists(folder / "s" / "00000004.shard"));
  CHECK(keys_in(store) == Keys{0, 1, 2});
}

TEST_CASE("shard store: shards are refused unless told otherwise, and stay until they are to be discarded") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{0, 1});
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::refuse),
                    Contains("2 shards") && Contains("--resume") && Contains("--discard"));
  Study other = study();
  other.seed = 8;
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::resume, nullptr, 5, other), Contains("another seed"));
  CHECK(missing_in(store_of(folder / "s", Leftovers::renew)).size() == 3);
  CHECK(missing_in(store_of(folder / "s", Leftovers::discard)).size() == 5);
  CHECK_FALSE(fs::exists(folder / "s"));  // nothing was added
  CHECK(missing_in(store_of(folder / "s", Leftovers::refuse)).size() == 5);
  leave_behind(folder / "s", Keys{0, 1});
  CHECK(missing_in(store_of(folder / "s", Leftovers::renew, nullptr, 5, other)).size() == 5);
}

TEST_CASE("shard store: packed, the same entries and seconds lie in one shard") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{4, 1, 3});
  make_file(folder / "s" / "00000002.shard", "damaged");
  double seconds = 0.0;
  {
    ShardStore store = store_of(folder / "s");
    for (const std::int64_t key : {1, 3}) {  // 3 a second time
      add(store, outcome_of(key));
      store.flush();
    }
    seconds = store.seconds();
    store.compact();
    CHECK(keys_in(store) == Keys{1, 3, 4});
    CHECK(shards_in(folder / "s") == std::vector<fs::path>{folder / "s" / "00000006.shard"});
    store.compact();  // nothing to do
    CHECK(shards_in(folder / "s").size() == 1);
  }
  const ShardStore again = store_of(folder / "s");
  CHECK(missing_in(again) == Keys{0, 2});
  CHECK(again.seconds() == seconds);
  CHECK(keys_in(again) == Keys{1, 3, 4});
}

/// All outcomes of these folders as a campaign of five experiments.
Campaign merged(const std::vector<fs::path>& folders) {
  ShardStore store = loops().in_memory();
  for (const fs::path& one : folders)
    store.take_stock(shards_in(one), {});
  Campaign campaign;
  campaign.study = study();
  campaign.info.audit_share = 1.0;
  loops().take(campaign, store, {}, true);
  return campaign;
}

TEST_CASE("shard store: an experiment in two shards counts once, and is refused when they differ") {
  const TemporaryFolder folder;
  leave_behind(folder / "one", Keys{4, 1});
  leave_behind(folder / "two", Keys{1, 0});
  const Campaign campaign = merged({folder / "one", folder / "two"});
  REQUIRE(campaign.records.size() == 3);  // 0, 1, 4
  CHECK(campaign.records[1].message == "experiment 1");
  CHECK(campaign.records[2].message == "experiment 4");
  CHECK(campaign.audit.size() == 3);  // each audit has a step of experiment 0 too
  CHECK(campaign.info.audit_seconds == 1.5);

  ExperimentOutcome other = outcome_of(1);
  other.audited.back().ipopt_kkt_residual = 1e-9;
  leave_behind(folder / "audit", {other});
  CHECK_THROWS_WITH(merged({folder / "one", folder / "audit"}),
                    Contains("experiment 1: ") && Contains("audit of step 0: ipopt_kkt_residual"));
  other.audited.clear();  // a worker died over it
  leave_behind(folder / "unaudited", {other});
  CHECK(merged({folder / "unaudited", folder / "one"}).audit.size() == 3);
  other = outcome_of(1);
  other.record.solver.iterations = 7;
  leave_behind(folder / "record", {other});
  CHECK_THROWS_WITH(merged({folder / "one", folder / "two", folder / "record"}),
                    Contains((folder / "record" / "00000001.shard").string() + ": experiment 1") &&
                        Contains("solver_iterations that differ from those in " + (folder / "one").string()));
}

TEST_CASE("shard store: a shard that its run has packed meanwhile is gone, not damaged") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", Keys{4, 1, 3});
  const std::vector<fs::path> small = shards_in(folder / "s");
  ShardStore seen = loops().in_memory();
  seen.take_stock(small, {});
  store_of(folder / "s").compact();
  std::vector<std::string> warnings;
  ShardStore late = loops().in_memory();
  CHECK_THROWS_AS(late.take_stock(small, [&](const std::string& text) { warnings.push_back(text); }),
                  ShardGone);
  CHECK(warnings.empty());
  CHECK_THROWS_WITH(keys_in(seen), Contains("the file is gone") && Contains("the same command again"));
  ShardStore again = loops().in_memory();
  again.take_stock(shards_in(folder / "s"), {});
  CHECK(missing_in(again) == Keys{0, 2});
}

/// Shards of such keys, which the store takes in this order; each entry says in which one it is.
ShardStore store_with(const fs::path& folder, const std::vector<Keys>& shards) {
  ShardStore store(kIdentity);
  for (std::size_t shard = 0; shard < shards.size(); ++shard) {
    ShardBytes bytes;
    for (const std::int64_t key : shards[shard])
      bytes.add(key, fmt::format("{}", shard));
    const fs::path path = folder / fmt::format("{}.shard", shard);
    bytes.write(path, kIdentity, 1.0);
    store.take_stock({path}, {});
  }
  return store;
}

TEST_CASE("shard store: entries come in the order of their keys, those of several shards in that of these") {
  const TemporaryFolder folder;
  const ShardStore store =
      store_with(folder.path(), {{9, 3, 4}, {0, kCalibrationKeys}, {}, {5, 3, 1}, {3, 3, 9, 10}});
  using List = std::vector<std::pair<std::int64_t, std::string>>;
  const auto found = [&](std::int64_t first, std::int64_t end) {
    List list;
    const ShardStore::Next next = store.in_order(first, end);
    while (const ShardStore::Entry* const entry = next())
      list.emplace_back(entry->key, entry->bytes);
    return list;
  };
  CHECK(found(0, kCalibrationKeys) == List{{0, "1"},
                                           {1, "3"},
                                           {3, "0"},
                                           {3, "3"},
                                           {3, "4"},
                                           {3, "4"},
                                           {4, "0"},
                                           {5, "3"},
                                           {9, "0"},
                                           {9, "4"},
                                           {10, "4"}});
  CHECK(found(4, 9) == List{{4, "0"}, {5, "3"}});
  CHECK(found(kCalibrationKeys, 2 * kCalibrationKeys) == List{{kCalibrationKeys, "1"}});
}

TEST_CASE("shard store: of shards in the order of their keys the places in one of them are in memory") {
  constexpr std::int64_t kShards = 10, kEach = 2000;
  const TemporaryFolder folder;
  std::vector<Keys> shards;
  for (std::int64_t shard = 0; shard < kShards; ++shard)
    shards.push_back(indices_in({{shard * kEach, (shard + 1) * kEach}}));
  const ShardStore store = store_with(folder.path(), shards);
  const std::size_t before = ::mallinfo2().uordblks;
  std::int64_t count = 0;
  std::size_t most = before;
  const ShardStore::Next next = store.in_order(0, kCalibrationKeys);
  while (const ShardStore::Entry* const entry = next()) {
    CHECK(entry->key == count++);
    most = std::max(most, ::mallinfo2().uordblks);
  }
  CHECK(count == kShards * kEach);
  CHECK(most - before < kShards * kEach * 12);  // bytes; the place of an entry takes 24
}

TEST_CASE("shard store: a folder that cannot be made is an error, and files of others stay") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(store_of(folder / "none" / "s"), ArchiveError);
  make_file(folder / "file", "x");
  CHECK_THROWS_AS(store_of(folder / "file", Leftovers::refuse), ArchiveError);
  leave_behind(folder / "s", Keys{0});
  make_file(folder / "s" / "notes.txt", "x");
  ShardFolder(folder / "s").clear();
  CHECK(fs::exists(folder / "s" / "notes.txt"));
}

}  // namespace
