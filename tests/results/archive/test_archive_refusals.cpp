#include <catch2/catch.hpp>

#include "results/archive/archive.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/file_seal.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;
using Catch::EndsWith;

/// The message by which a file with this content is refused; "accepted" when it is not.
std::string refusal_of(const TemporaryFolder& folder, const std::string& content) {
  make_file(folder / "a.h5", content);
  try {
    read_archive(folder / "a.h5");
    return "accepted";
  } catch (const ArchiveError& error) {
    return error.what();
  }
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The content with the seal of an archive, so that the reader goes on behind it.
std::string with_seal(const std::string& content) {
  const auto bytes = std::as_bytes(std::span(content));
  return text_of(sealed({bytes.begin(), bytes.end()}));
}

std::string whole_archive(const TemporaryFolder& folder) {
  const Campaign campaign = made_up_campaign();
  write_archive(folder / "whole.h5", campaign, findings_of(campaign));
  return file_content(folder / "whole.h5");
}

/// An HDF5 file with these root attributes and nothing else.
std::string heading_only(const Attributes& attributes) {
  const Hdf5File file = Hdf5File::create("f");
  Hdf5Group root = file.root();
  for (const auto& [name, value] : attributes)
    root.write_attribute(name, value);
  return text_of(file.image());
}

TEST_CASE("archive: what is no HDF5 file is refused by name") {
  const TemporaryFolder folder;
  const std::string name = (folder / "a.h5").string();
  CHECK_THROWS_WITH(read_archive(folder / "a.h5"), name + ": no such file");
  CHECK_THROWS_WITH(read_archive(folder.path()), Contains("not an HDF5 file"));
  for (const std::string& content : {std::string(), std::string("[study]\nname = \"text\"\n"),
                                     std::string(100000, '\0'), std::string("\x89HDF\r\n")}) {
    CHECK_THAT(refusal_of(folder, content), Contains(name + ": not an HDF5 file, or not a whole one"));
    CHECK_THAT(refusal_of(folder, with_seal(content)),
               Contains(name + ": not an HDF5 file, or not a whole one"));
  }
}

TEST_CASE("archive: a file that is cut anywhere is refused") {
  const TemporaryFolder folder;
  const std::string whole = whole_archive(folder);
  REQUIRE(refusal_of(folder, whole) == "accepted");
  for (std::size_t part = 0; part < 100; ++part) {
    const std::string content = whole.substr(0, whole.size() * part / 100);
    CHECK_THAT(refusal_of(folder, content), Contains("not a whole one"));
    CHECK_THAT(refusal_of(folder, with_seal(content)), Contains("not a whole one"));
  }
  CHECK_THAT(refusal_of(folder, whole.substr(0, whole.size() - 1)), Contains("not a whole one"));
}

TEST_CASE("archive: random bytes are refused, with and without the signature of HDF5") {
  const TemporaryFolder folder;
  RandomStream stream(1, 2, StreamId::measurement_noise);
  for (int trial = 0; trial < 50; ++trial) {
    std::string content = trial % 2 == 0 ? "" : "\x89HDF\r\n\x1A\n";
    while (content.size() < 3000)
      content += static_cast<char>(stream.below(256));
    CHECK(refusal_of(folder, content) != "accepted");
    CHECK(refusal_of(folder, with_seal(content)) != "accepted");
  }
}

TEST_CASE("archive: another file type, another major version and a study that is none are refused") {
  const TemporaryFolder folder;
  const std::vector<std::int32_t> version{kArchiveMajorVersion, 7};  // a later minor version is no reason
  const std::pair<std::string, AttributeValue> type{"filetype", "mpmbench archive"};
  CHECK_THAT(refusal_of(folder, heading_only({})), Contains("attribute '/filetype': missing"));
  CHECK_THAT(refusal_of(folder, heading_only({{"filetype", "statepoint"}})),
             Contains("found 'statepoint'; allowed: 'mpmbench archive'"));
  CHECK_THAT(refusal_of(folder, heading_only({type})), Contains("attribute '/format_version': missing"));
  CHECK_THAT(refusal_of(folder, heading_only({type, {"format_version", std::vector<std::int32_t>{3, 0}}})),
             EndsWith("attribute '/format_version': found 3.0; allowed: 2.x"));
  CHECK_THAT(refusal_of(folder, heading_only({type, {"format_version", std::vector<std::int32_t>{}}})),
             Contains("'/format_version'"));
  CHECK_THAT(refusal_of(folder, heading_only({type, {"format_version", version}, {"scenario", "[study]"}})),
             Contains("the study in attribute '/scenario'") && Contains("name"));
  CHECK_THAT(refusal_of(folder, heading_only({type, {"format_version", version}})),
             Contains("attribute '/scenario': missing"));
}

TEST_CASE("archive: one of the format before is refused with the command that makes it anew") {
  const TemporaryFolder folder;
  const Attributes earlier{{"filetype", "mpmbench archive"},
                           {"format_version", std::vector<std::int32_t>{1, 9}},
                           {"command", "mpmbench run chapter6 -o 'my a.h5'"}};
  CHECK_THAT(
      refusal_of(folder, heading_only(earlier)),
      EndsWith("attribute '/format_version': found 1.9; allowed: 2.x; to make it again with this program: "
               "mpmbench run chapter6 -o 'my a.h5'"));
}

TEST_CASE("archive: a path that cannot be written is refused, and a file that was there stays") {
  const TemporaryFolder folder;
  const Campaign campaign = made_up_campaign();
  const StudyFindings findings = findings_of(campaign);
  make_file(folder / "file", "x");
  CHECK_THROWS_AS(write_archive(folder / "file/a.h5", campaign, findings), ArchiveError);
  CHECK_THROWS_AS(write_archive(folder / "none/a.h5", campaign, findings), ArchiveError);
  CHECK(file_content(folder / "file") == "x");
}

TEST_CASE("archive: the data sets do not depend on when, how and with how many jobs the campaign was run") {
  const TemporaryFolder folder;
  Campaign campaign = made_up_campaign();
  const StudyFindings findings = findings_of(campaign);
  write_archive(folder / "a.h5", campaign, findings);
  write_archive(folder / "b.h5", campaign, findings);
  CHECK(file_content(folder / "a.h5") == file_content(folder / "b.h5"));
  // The same bytes again, but for those of the attributes that differ: as many bytes as these texts have.
  campaign.info.created = "2016-05-02T13:11:11Z";
  campaign.info.jobs = 8;
  write_archive(folder / "b.h5", campaign, findings);
  CHECK(file_content(folder / "a.h5") != file_content(folder / "b.h5"));
  CHECK(file_content(folder / "a.h5").size() == file_content(folder / "b.h5").size());
}

}  // namespace
