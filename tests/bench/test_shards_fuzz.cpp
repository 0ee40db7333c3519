#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "bench/byte_stream.hpp"
#include "bench/outcome_bytes.hpp"
#include "bench/shards/shard_store.hpp"
#include "plants/error.hpp"
#include "results/files/file_seal.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

const ShardIdentity kIdentity{{"program", "p"}, {"study", "s"}};
constexpr std::int64_t kExperiments = 8;

/// Writes files with any content as the only shard of an interrupted run, and reads them. All other
/// exceptions than InputError go on and fail the test.
class Reader {
 public:
  Reader() : file_(folder_ / "00000001.shard") {}

  /// The shard, when it is neither damaged nor refused; a refusal must name the file.
  std::optional<Shard> read(const std::string& content) {
    std::filesystem::remove(file_);  // ext4 would flush a file that takes the place of its old content
    make_file(file_, content);
    refused_ = false;
    try {
      return read_shard(file_, kIdentity);
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
      const ShardStore store(folder_.path(), {.leftovers = Leftovers::resume}, kIdentity, kExperiments, {});
      store.read([](const ExperimentOutcome&) {});
    } catch (const InputError& error) {
      if (std::string_view(error.what()).find(file_.string()) == std::string_view::npos)
        FAIL_CHECK("a refusal that does not name the file: " << error.what());
    }
  }

  /// A shard of random experiments, healthy and badly tuned ones among them, and named scenarios, and one
  /// loop.
  std::string whole() const {
    ShardBytes bytes;
    bool has_loop = false;
    for (const Campaign& campaign : {made_up_campaign(), faultless_campaign(), scenario_campaign()})
      for (const ExperimentRecord& record : campaign.records) {
        ExperimentOutcome outcome;
        outcome.record = record;
        outcome.audited.resize(2);
        if (has_loop)
          outcome.record.loop.reset();
        has_loop = has_loop || record.loop.has_value();
        bytes.add(outcome);
      }
    bytes.write(file_, kIdentity, 1.5);
    return file_content(file_);
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
  bool refused_ = false;
};

std::string without_seal(const std::string& file) {
  return file.substr(0, file.size() - kSealBytes);
}

/// What stands before the outcomes of a shard.
std::string heading(const Reader& reader) {
  const std::string content = without_seal(reader.whole());
  const TemporaryFolder folder;
  ShardBytes().write(folder / "empty", kIdentity, 1.5);
  std::string empty = without_seal(file_content(folder / "empty"));
  REQUIRE(content.starts_with(empty));
  return empty;
}

TEST_CASE("shard: thousands that are damaged, cut off or random bytes are passed over, every one") {
  Reader reader;
  const std::string whole = reader.whole();
  REQUIRE(reader.read(whole));
  Mutator mutator(1);
  for (int i = 0; i < 2000; ++i) {
    const std::string content = mutator.mutated_bytes(whole);
    CHECK(reader.read(content).has_value() == (content == whole));
    CHECK_FALSE(reader.refused());
  }
  for (int i = 0; i < 500; ++i) {
    CHECK_FALSE(reader.read(whole.substr(0, mutator.below(whole.size()))));
    CHECK_FALSE(reader.read(mutator.random_bytes(3000)));
    CHECK_FALSE(reader.refused());
  }
}

TEST_CASE("shard: random bytes under a right checksum are refused by name, wherever they begin") {
  Reader reader;
  const std::string with_identity = heading(reader);
  const std::string with_type = with_identity.substr(0, with_identity.find('\n') + 1);
  const std::string with_version = with_identity.substr(0, with_type.size() + sizeof kShardVersion);
  Mutator mutator(2);
  for (const std::string& start : {std::string(), with_type, with_version, with_identity})
    for (int i = 0; i < 500; ++i) {
      CHECK_FALSE(reader.read_sealed(start + "x" + mutator.random_bytes(2000)));
      CHECK(reader.refused());
    }
  for (int i = 0; i < 1000; ++i) {  // an outcome of the right length
    ByteWriter writer;
    const std::string outcome = mutator.random_bytes(2000);
    transfer(writer, outcome);
    CHECK_FALSE(reader.read_sealed(with_identity + writer.take()));
    CHECK(reader.refused());
    reader.resume();
  }
}

TEST_CASE("shard: changed under a right checksum, it is refused by name or read as it stands") {
  Reader reader;
  const std::string content = without_seal(reader.whole());
  const std::string start = heading(reader);
  Mutator mutator(3);
  int refused = 0;
  int read = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string changed = start + mutator.mutated_bytes(content.substr(start.size()));
    const std::optional<Shard> shard = reader.read_sealed(changed);
    reader.resume();
    REQUIRE(shard.has_value() != reader.refused());
    refused += reader.refused();
    if (!shard)
      continue;
    ++read;
    std::string again = start;
    for (const ExperimentOutcome& outcome : shard->outcomes) {
      ByteWriter writer;
      const std::string bytes = to_bytes(outcome);
      transfer(writer, bytes);
      again += writer.take();
    }
    CHECK((again == changed));  // no byte without an effect
  }
  CHECK(refused > 500);
  CHECK(read > 100);
}

}  // namespace
