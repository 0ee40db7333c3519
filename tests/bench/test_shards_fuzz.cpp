#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/file_seal.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Random experiments, healthy and badly tuned ones, and named scenarios.
Campaign any_campaign() {
  return GENERATE(drawn_campaign(), faultless_campaign(), scenario_campaign());
}

/// A store digests the program file each time, which takes long.
constexpr int kResumeEach = 50;

RunOptions resuming(std::int64_t experiments) {
  RunOptions options;
  options.experiments = experiments;
  options.leftovers = Leftovers::resume;
  return options;
}

/// An interrupted run of this campaign, of which one loop was kept.
Campaign one_loop(Campaign campaign) {
  for (std::size_t i = 2; i < campaign.records.size(); ++i)
    campaign.records[i].loop.reset();
  return campaign;
}

/// What is in a shard.
struct Shard {
  double seconds = 0.0;
  std::vector<ExperimentOutcome> outcomes = {};
};

/// Writes files with any content as the only shard of an interrupted run, and reads them. All other
/// exceptions than InputError go on and fail the test.
class Reader {
 public:
  explicit Reader(Campaign campaign)
      : campaign_(one_loop(std::move(campaign))),
        loops_(campaign_.study, resuming(std::ssize(campaign_.records))),
        identity_(shard_identity(campaign_.study, loops_.options())),
        file_(folder_ / "00000001.shard") {}

  /// The shard, when it is neither damaged nor refused; a refusal must name the file.
  std::optional<Shard> read(const std::string& content) {
    std::filesystem::remove(file_);  // ext4 would flush a file that takes the place of its old content
    make_file(file_, content);
    refused_ = false;
    try {
      const std::optional<ShardContent> found = read_shard(file_, identity_);
      if (!found)
        return std::nullopt;
      Shard shard{.seconds = found->seconds};
      ShardStore::Entry entry{.key = 0, .bytes = "", .shard = &file_};
      const std::string bytes = file_content(file_);
      for (const ShardPlace& place : found->places) {
        entry.key = place.key;
        entry.bytes = bytes.substr(place.begin, place.size);
        shard.outcomes.push_back(loops_.outcome(entry));
      }
      return shard;
    } catch (const InputError& error) {
      refused_ = true;
      if (!std::string_view(error.what()).starts_with(file_.string() + ": "))
        FAIL_CHECK("a refusal that does not name the file: " << error.what());
      return std::nullopt;
    }
  }
  std::optional<Shard> read_sealed(const std::string& content) {
    const auto bytes = std::as_bytes(std::span(content));
    const std::vector<std::byte> whole = sealed({bytes.begin(), bytes.end()});
    return read({reinterpret_cast<const char*>(whole.data()), whole.size()});
  }
  /// Whether the last one was whole but refused.
  bool refused() const { return refused_; }

  /// Resumes a run with the last one as its shard.
  void resume() const {
    try {
      const ShardStore store = loops_.open(folder_.path(), {});
      loops_.experiment_records(store, {}).each([](const ExperimentRecord&) {});
    } catch (const InputError& error) {
      if (std::string_view(error.what()).find(file_.string()) == std::string_view::npos)
        FAIL_CHECK("a refusal that does not name the file: " << error.what());
    }
  }

  /// A shard of all its experiments.
  std::string whole() const {
    ShardBytes bytes;
    for (const ExperimentRecord& record : campaign_.records) {
      ExperimentOutcome outcome;
      outcome.record = record;
      outcome.audited.resize(2);
      bytes.add(record.draw.index, loops_.result(record.draw.index, outcome).bytes);
    }
    bytes.write(file_, identity_, 1.5);
    return file_content(file_);
  }

  /// What stands before the outcomes of a shard.
  std::string heading() const {
    const std::filesystem::path empty = folder_ / "empty";
    ShardBytes().write(empty, identity_, 1.5);
    const std::string content = file_content(empty);
    std::filesystem::remove(empty);
    return content.substr(0, content.size() - kSealBytes);
  }

  /// The outcomes of a shard behind the heading, as they would be written.
  std::string written(const Shard& shard) const {
    std::string content = heading();
    for (const ExperimentOutcome& outcome : shard.outcomes) {
      ByteWriter writer;
      const std::string bytes = loops_.result(outcome.record.draw.index, outcome).bytes;
      transfer_all(writer, outcome.record.draw.index, bytes);
      content += writer.take();
    }
    return content;
  }

 private:
  Campaign campaign_;
  CampaignLoops loops_;
  ShardIdentity identity_;
  TemporaryFolder folder_;
  std::filesystem::path file_;
  bool refused_ = false;
};

std::string without_seal(const std::string& file) {
  return file.substr(0, file.size() - kSealBytes);
}

TEST_CASE("shard: thousands that are damaged, cut off or random bytes are passed over, every one") {
  Reader reader(any_campaign());
  const std::string whole = reader.whole();
  REQUIRE(reader.read(whole));
  Mutator mutator(1);
  for (int i = 0; i < 700; ++i) {
    const std::string content = mutator.mutated_bytes(whole);
    CHECK(reader.read(content).has_value() == (content == whole));
    CHECK_FALSE(reader.refused());
  }
  for (int i = 0; i < 200; ++i) {
    CHECK_FALSE(reader.read(whole.substr(0, mutator.below(whole.size()))));
    CHECK_FALSE(reader.read(mutator.random_bytes(3000)));
    CHECK_FALSE(reader.refused());
  }
}

TEST_CASE("shard: random bytes under a right checksum are refused by name, wherever they begin") {
  Reader reader(any_campaign());
  const std::string with_identity = reader.heading();
  const std::string with_type = with_identity.substr(0, with_identity.find('\n') + 1);
  const std::string with_version = with_identity.substr(0, with_type.size() + sizeof kShardVersion);
  Mutator mutator(2);
  for (const std::string& start : {std::string(), with_type, with_version, with_identity})
    for (int i = 0; i < 200; ++i) {
      CHECK_FALSE(reader.read_sealed(start + "x" + mutator.random_bytes(2000)));
      CHECK(reader.refused());
    }
  for (int i = 0; i < 300; ++i) {  // an outcome of the right length
    ByteWriter writer;
    const std::int64_t key = i % 2;
    const std::string outcome = mutator.random_bytes(2000);
    transfer_all(writer, key, outcome);
    CHECK_FALSE(reader.read_sealed(with_identity + writer.take()));
    CHECK(reader.refused());
    if (i % kResumeEach == 0)
      reader.resume();
  }
}

TEST_CASE("shard: changed under a right checksum, it is refused by name or read as it stands") {
  Reader reader(any_campaign());
  const std::string start = reader.heading();
  const std::string whole = without_seal(reader.whole());
  REQUIRE(whole.starts_with(start));
  const std::string outcomes = whole.substr(start.size());
  Mutator mutator(3);
  int refused = 0;
  int read = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::optional<Shard> shard = reader.read_sealed(start + mutator.mutated_bytes(outcomes));
    if (i % kResumeEach == 0)
      reader.resume();
    REQUIRE(shard.has_value() != reader.refused());
    refused += reader.refused();
    if (!shard)
      continue;
    ++read;
    // What was read has no other meaning when it is written again. (A number of a method that gave no answer
    // may be lost: there is no place for it in a record.)
    const std::string again = reader.written(*shard);
    const std::optional<Shard> second = reader.read_sealed(again);
    REQUIRE(second);
    CHECK((reader.written(*second) == again));
  }
  CHECK(refused > 150);
  CHECK(read > 30);
}

}  // namespace
