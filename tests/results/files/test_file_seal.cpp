#include <catch2/catch.hpp>

#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/file_seal.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;
using Catch::Contains;

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string sealed_text(const std::string& text) {
  const std::vector<std::byte> bytes = sealed(bytes_of(text));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The message by which a file with this content is refused; "accepted" when it is not.
std::string seal_refusal_of(const TemporaryFolder& folder, const std::string& content) {
  make_file(folder / "f", content);
  try {
    read_sealed_file(folder / "f");
    return "accepted";
  } catch (const ArchiveError& error) {
    return error.what();
  }
}

TEST_CASE("file seal: it is the SHA-256 that FIPS 180-2 gives for 'abc', on a line of its own") {
  CHECK(sealed_text("abc") ==
        "abc\nmpmbench sha256 ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\n");
  CHECK(sealed_text("").size() == kSealBytes);
}

TEST_CASE("file seal: content of any length comes back") {
  const TemporaryFolder folder;
  RandomStream stream(1, 1, StreamId::measurement_noise);
  for (const std::size_t length : {0, 1, 81, 82, 83, 100000}) {
    std::vector<std::byte> content(length);
    for (std::byte& byte : content)
      byte = static_cast<std::byte>(stream.below(256));
    write_file_atomically(folder / "f", sealed(content));
    CHECK(read_sealed_file(folder / "f") == content);
  }
}

TEST_CASE("file seal: every bit that is turned over is noticed, in the content and in the seal") {
  const TemporaryFolder folder;
  const std::string whole = sealed_text("\x89HDF\r\n\x1A\nsome content of some length");
  REQUIRE(seal_refusal_of(folder, whole) == "accepted");
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    const std::string message = seal_refusal_of(folder, damaged);
    REQUIRE_THAT(message, Contains("the file is damaged") || Contains("no checksum at its end"));
    REQUIRE_THAT(message, Contains((folder / "f").string()));
  }
}

TEST_CASE("file seal: what is cut off, added or not there is named") {
  const TemporaryFolder folder;
  const std::string whole = sealed_text("\x89HDF\r\n\x1A\nsome content");
  for (std::size_t length = 8; length < whole.size(); ++length)
    REQUIRE_THAT(seal_refusal_of(folder, whole.substr(0, length)), Contains("no checksum at its end"));
  CHECK_THAT(seal_refusal_of(folder, whole + "\n"), Contains("no checksum at its end"));
  CHECK_THAT(seal_refusal_of(folder, whole.substr(1)), Contains("the file is damaged"));
  CHECK_THAT(seal_refusal_of(folder, "some text"), Contains("not an HDF5 file"));
  CHECK_THAT(seal_refusal_of(folder, ""), Contains("not an HDF5 file"));
  CHECK_THROWS_WITH(read_sealed_file(folder / "none"), Contains("none: no such file"));
  CHECK_THROWS_WITH(read_sealed_file(folder.path()), Contains("a folder or a device, not an HDF5 file"));
  CHECK_THROWS_WITH(read_sealed_file("/dev/null"), Contains("a folder or a device, not an HDF5 file"));
}

}  // namespace
