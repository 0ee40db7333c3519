#include <iterator>

#include <catch2/catch.hpp>

#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Writes files with any content and reads them as archives. All other exceptions than ArchiveError go on and
/// fail the test.
class Reader {
 public:
  Reader() : file_(folder_ / "a.h5") {}

  bool accepts(const std::string& content) {
    std::filesystem::remove(file_);  // ext4 would flush a file that takes the place of its old content
    make_file(file_, content);
    try {
      read_archive(file_);
      return true;
    } catch (const ArchiveError& error) {
      const std::string message = error.what();
      if (!message.starts_with(file_.string() + ": "))
        FAIL_CHECK("a refusal that does not name the file: " << message);
      return false;
    }
  }

  /// Reading leaves nothing behind.
  bool left_alone() const {
    const std::filesystem::directory_iterator files(folder_.path());
    return std::distance(begin(files), end(files)) == 1;
  }

  std::string archive() const {
    const Campaign campaign = made_up_campaign();
    write_archive(file_, campaign, findings_of(campaign));
    return file_content(file_);
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
};

TEST_CASE("thousands of damaged archives are refused, every one") {
  Reader reader;
  const std::string whole = reader.archive();
  REQUIRE(reader.accepts(whole));
  Mutator mutator(1);
  int damaged = 0;
  while (damaged < 3000) {
    const std::string content = mutator.mutated_bytes(whole);
    if (content == whole)
      continue;
    ++damaged;
    if (reader.accepts(content))
      FAIL_CHECK("accepted the damaged file number " << damaged);
  }
  CHECK(reader.left_alone());
}

TEST_CASE("archives that are cut off, and random bytes, are refused") {
  Reader reader;
  const std::string whole = reader.archive();
  Mutator mutator(2);
  for (int i = 0; i < 1000; ++i)
    CHECK_FALSE(reader.accepts(whole.substr(0, mutator.below(whole.size()))));
  for (int i = 0; i < 2000; ++i) {
    const std::string signature = i % 2 == 0 ? "" : "\x89HDF\r\n\x1A\n";
    CHECK_FALSE(reader.accepts(signature + mutator.random_bytes(3000)));
  }
  CHECK(reader.left_alone());
}

}  // namespace
