#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <malloc.h>

#include "bench/campaign/streamed_records.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/outcome/outcome_bytes.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_index.hpp"
#include "bench/shards/shard_set.hpp"
#include "bench/shards/shard_store.hpp"
#include "plants/error.hpp"
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

const OutcomeBytes& format() {
  static const OutcomeBytes format(study());
  return format;
}

ExperimentOutcome outcome_of(std::int64_t index) {
  ExperimentOutcome outcome;
  outcome.record = lost_record(study(), index, fmt::format("experiment {}", index));
  outcome.audited.resize(2);
  outcome.audited.back().experiment = index;
  outcome.audit_seconds = 0.5;
  return outcome;
}

/// Reads a shard whose outcomes do not matter.
std::optional<double> seconds_of(const fs::path& path, const ShardIdentity& identity = kIdentity) {
  return read_shard(path, identity, format(), [](const ExperimentOutcome&) {});
}

fs::path written(const TemporaryFolder& folder, std::vector<std::int64_t> indices) {
  ShardBytes bytes;
  for (const std::int64_t index : indices)
    bytes.add(format().to_bytes(outcome_of(index)));
  bytes.write(folder / "a.shard", kIdentity, 1.5);
  return folder / "a.shard";
}

void make_sealed(const fs::path& path, const std::string& content) {
  const auto bytes = std::as_bytes(std::span(content));
  write_file_atomically(path, sealed({bytes.begin(), bytes.end()}));
}

/// A store of five experiments, of which an earlier one was given some in a shard each.
ShardStore store_of(const fs::path& folder, Leftovers leftovers, std::vector<std::string>* warnings = nullptr,
                    std::int64_t count = 5, const Study& of = study()) {
  RunOptions options;
  options.leftovers = leftovers;
  return ShardStore(folder, options, of, count, [=](const std::string& text) {
    if (warnings != nullptr)
      warnings->push_back(text);
  });
}

void leave_behind(const fs::path& folder, const std::vector<std::int64_t>& indices) {
  ShardStore store = store_of(folder, Leftovers::resume);
  for (const std::int64_t index : indices) {
    store.add(outcome_of(index));
    store.flush();
  }
}

std::vector<std::int64_t> indices_in(const ShardStore& store) {
  std::vector<std::int64_t> indices;
  store.read([&](const ExperimentOutcome& outcome) { indices.push_back(outcome.record.draw.index); });
  return indices;
}

using Indices = std::vector<std::int64_t>;

TEST_CASE("shard: outcomes come back with every bit, loops and audits among them") {
  const TemporaryFolder folder;
  const Campaign campaign = drawn_campaign();
  ShardBytes bytes;
  std::vector<std::string> expected;
  for (const ExperimentRecord& record : campaign.records) {
    ExperimentOutcome outcome = outcome_of(0);
    outcome.record = record;
    expected.push_back(format().to_bytes(outcome));
    bytes.add(expected.back());
  }
  bytes.write(folder / "a.shard", kIdentity, 1.5);
  CHECK(bytes.empty());
  std::vector<ExperimentOutcome> outcomes;
  CHECK(read_shard(folder / "a.shard", kIdentity, format(),
                   [&](ExperimentOutcome outcome) { outcomes.push_back(std::move(outcome)); }) == 1.5);
  REQUIRE(outcomes.size() == expected.size());
  const RecordBytes records(campaign.study, forms_of(campaign));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(format().to_bytes(outcomes[i]) == expected[i]);
    CHECK(records.differences(outcomes[i].record, campaign.records[i]) == std::vector<std::string>{});
    CHECK(outcomes[i].audited.size() == 2);
  }
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
  CHECK_THROWS_WITH(seconds_of(path), Contains("format version") && Contains("found 9; allowed: 2"));
  make_sealed(path, "some other file");
  CHECK_THROWS_WITH(seconds_of(path), Contains("a shard of mpmbench"));
}

TEST_CASE("shard store: what an earlier run has left is not missing, and is given once") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {4, 1});
  ShardStore store = store_of(folder / "s", Leftovers::resume);
  CHECK(store.missing() == Indices{0, 2, 3});
  CHECK(store.seconds() > 0.0);
  for (const std::int64_t index : {3, 0, 1, 2})  // 1 a second time
    store.add(outcome_of(index));
  store.flush();
  CHECK(indices_in(store) == Indices{4, 1, 3, 0, 2});
}

TEST_CASE("shard store: a longer run takes up a shorter one, and a shorter one refuses a longer one") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {4, 1});
  CHECK(store_of(folder / "s", Leftovers::resume, nullptr, 7).missing() == Indices{0, 2, 3, 5, 6});
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::resume, nullptr, 4),
                    Contains("--experiments") && Contains("5 or more"));
  CHECK(store_of(folder / "s", Leftovers::resume).missing() == Indices{0, 2, 3});
}

TEST_CASE("shard store: a damaged shard is named, its experiments are missing, and nothing is overwritten") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {0, 1, 2});
  const fs::path damaged = folder / "s" / "00000002.shard";
  make_file(damaged, file_content(damaged).substr(0, 50));
  std::vector<std::string> warnings;
  ShardStore store = store_of(folder / "s", Leftovers::resume, &warnings);
  CHECK(store.missing() == Indices{1, 3, 4});
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings.front(), Contains("00000002.shard") && Contains("run again"));
  store.add(outcome_of(1));
  store.flush();
  CHECK(fs::exists(folder / "s" / "00000004.shard"));
  CHECK(indices_in(store) == Indices{0, 2, 1});
}

TEST_CASE("shard store: shards are refused unless told otherwise, and stay until they are to be discarded") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {0, 1});
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::refuse),
                    Contains("2 shards") && Contains("--resume") && Contains("--discard"));
  Study other = study();
  other.seed = 8;
  CHECK_THROWS_WITH(store_of(folder / "s", Leftovers::resume, nullptr, 5, other), Contains("another seed"));
  CHECK(store_of(folder / "s", Leftovers::resume).missing().size() == 3);
  CHECK(store_of(folder / "s", Leftovers::discard).missing().size() == 5);
  CHECK_FALSE(fs::exists(folder / "s"));  // nothing was added
  CHECK(store_of(folder / "s", Leftovers::refuse).missing().size() == 5);
}

TEST_CASE("shard store: packed, the same experiments and seconds lie in one shard") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {4, 1, 3});
  make_file(folder / "s" / "00000002.shard", "damaged");
  double seconds = 0.0;
  {
    ShardStore store = store_of(folder / "s", Leftovers::resume);
    store.add(outcome_of(1));
    store.flush();
    seconds = store.seconds();
    store.compact();
    CHECK(indices_in(store) == Indices{4, 3, 1});
    CHECK(shards_in(folder / "s") == std::vector<fs::path>{folder / "s" / "00000005.shard"});
    store.compact();  // nothing to do
    CHECK(shards_in(folder / "s").size() == 1);
  }
  const ShardStore again = store_of(folder / "s", Leftovers::resume);
  CHECK(again.missing() == Indices{0, 2});
  CHECK(again.seconds() == seconds);
  CHECK(indices_in(again) == Indices{4, 3, 1});
}

/// One shard more in a folder, of this outcome.
void leave_another(const fs::path& folder, const ExperimentOutcome& outcome) {
  ShardStore store = store_of(folder, Leftovers::resume);
  store.add(outcome);
  store.flush();
}

/// All outcomes of these folders as a campaign of five experiments.
Campaign merged(const std::vector<fs::path>& folders) {
  ShardSet set(RunOptions(), study(), 5);
  for (const fs::path& one : folders)
    set.take_stock(shards_in(one), {});
  Campaign campaign;
  campaign.study = study();
  campaign.info.audit_share = 1.0;
  take_records(campaign, set, {});
  records_of(campaign).each([&](const ExperimentRecord& record) { campaign.records.push_back(record); });
  campaign.streamed.reset();  // the set ends here
  return campaign;
}

TEST_CASE("shard set: an experiment in two shards counts once, and is refused when they differ") {
  const TemporaryFolder folder;
  leave_behind(folder / "one", {4, 1});
  leave_behind(folder / "two", {1, 0});
  const Campaign campaign = merged({folder / "one", folder / "two"});
  REQUIRE(campaign.records.size() == 3);  // 0, 1, 4
  CHECK(campaign.records[1].message == "experiment 1");
  CHECK(campaign.records[2].message == "experiment 4");
  CHECK(campaign.audit.size() == 3);  // each audit has a step of experiment 0 too

  ExperimentOutcome other = outcome_of(1);
  other.audited.back().ipopt_kkt_residual = 1e-9;
  leave_another(folder / "audit", other);
  CHECK_THROWS_WITH(merged({folder / "one", folder / "audit"}),
                    Contains("experiment 1: audit of step 0: ipopt_kkt_residual"));
  other = outcome_of(1);
  other.record.solver.iterations = 7;
  leave_another(folder / "record", other);
  CHECK_THROWS_WITH(merged({folder / "one", folder / "two", folder / "record"}),
                    Contains((folder / "record" / "00000001.shard").string() + ": experiment 1") &&
                        Contains("another solver_iterations than in " + (folder / "one").string()));
}

TEST_CASE("shard set: a shard that its run has packed meanwhile is gone, not damaged") {
  const TemporaryFolder folder;
  leave_behind(folder / "s", {4, 1, 3});
  const std::vector<fs::path> small = shards_in(folder / "s");
  ShardSet seen(RunOptions(), study(), 5);
  seen.take_stock(small, {});
  store_of(folder / "s", Leftovers::resume).compact();
  std::vector<std::string> warnings;
  ShardSet late(RunOptions(), study(), 5);
  CHECK_THROWS_AS(late.take_stock(small, [&](const std::string& text) { warnings.push_back(text); }),
                  ShardGone);
  CHECK(warnings.empty());
  CHECK_THROWS_AS(seen.read([](const ExperimentOutcome&) {}), ShardGone);
  CHECK_THROWS_WITH(records_in(seen, {}), Contains("gone meanwhile") && Contains("the same command again"));
  ShardSet again(RunOptions(), study(), 5);
  again.take_stock(shards_in(folder / "s"), {});
  CHECK(again.missing() == Indices{0, 2});
}

/// Shards of such indices, which the set takes in this order.
void add_shards(ShardSet& set, const fs::path& folder, const std::vector<Indices>& shards) {
  for (const Indices& indices : shards) {
    ShardBytes bytes;
    for (const std::int64_t index : indices) {
      ExperimentOutcome outcome = outcome_of(index);
      outcome.audit_seconds = static_cast<double>(set.shards().size());  // tells the shards apart
      bytes.add(format().to_bytes(outcome));
    }
    set.add_written(folder / fmt::format("{}.shard", set.shards().size()), 1.0);
    bytes.write(set.shards().back(), set.identity(), 1.0);
  }
}

TEST_CASE("shard index: outcomes come in the order of their index, those of several shards from the first") {
  const TemporaryFolder folder;
  ShardSet set(RunOptions(), study(), 12);
  add_shards(set, folder.path(), {{9, 3, 4}, {0, 11}, {}, {5, 3, 1}, {3, 3, 9, 10}});
  const ShardIndex index(set);
  std::vector<std::pair<std::int64_t, double>> found, again;
  const auto to = [](auto& list) {
    return [&list](const ExperimentOutcome& outcome) {
      list.emplace_back(outcome.record.draw.index, outcome.audit_seconds);
    };
  };
  index.each(to(found));
  index.each_repeated(to(again));
  using List = std::vector<std::pair<std::int64_t, double>>;
  CHECK(found == List{{0, 1}, {1, 3}, {3, 0}, {4, 0}, {5, 3}, {9, 0}, {10, 4}, {11, 1}});
  CHECK(again == List{{3, 3}, {3, 4}, {3, 4}, {9, 4}});
}

TEST_CASE("shard index: of shards in the order of their index the places in one of them are in memory") {
  constexpr std::int64_t kShards = 10, kEach = 2000;
  const TemporaryFolder folder;
  ShardSet set(RunOptions(), study(), kShards * kEach);
  for (std::int64_t shard = 0; shard < kShards; ++shard) {
    Indices indices(kEach);
    std::iota(indices.begin(), indices.end(), shard * kEach);
    add_shards(set, folder.path(), {indices});
  }
  const std::size_t before = ::mallinfo2().uordblks;
  const ShardIndex index(set);
  std::int64_t count = 0;
  std::size_t most = before;
  index.each([&](const ExperimentOutcome& outcome) {
    CHECK(outcome.record.draw.index == count++);
    most = std::max(most, ::mallinfo2().uordblks);
  });
  CHECK(count == kShards * kEach);
  CHECK(most - before < kShards * kEach * 12);  // bytes; the place of an outcome takes 24
}

TEST_CASE("shard store: a folder that cannot be made is an error, and files of others stay") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(store_of(folder / "none" / "s", Leftovers::refuse), ArchiveError);
  make_file(folder / "file", "x");
  CHECK_THROWS_AS(store_of(folder / "file", Leftovers::refuse), ArchiveError);
  leave_behind(folder / "s", {0});
  make_file(folder / "s" / "notes.txt", "x");
  ShardFolder(folder / "s").clear();
  CHECK(fs::exists(folder / "s" / "notes.txt"));
}

}  // namespace
