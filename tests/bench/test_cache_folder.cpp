#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/system/temporary_folder.hpp"
#include "bench/cache/cache_folder.hpp"
#include "results/files/deflated.hpp"

namespace {

using namespace mpm;
namespace fs = std::filesystem;

constexpr std::uint64_t kRoom = 1'000'000;

ShardIdentity identity(const std::string& study) {
  return {{"content", "loops"}, {"study", study}};
}

std::optional<std::string> keep(const CacheFolder& cache, const std::string& study, const std::string& text) {
  ShardBytes bytes;
  bytes.add(7, text);
  return cache.write(bytes, identity(study));
}

/// What is kept of a study; empty: nothing.
std::string kept_text(const CacheFolder& cache, const std::string& study) {
  const std::optional<ShardContent> content = cache.read(identity(study));
  return content ? std::string(content->bytes(content->places.at(0))) : "";
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files.push_back(entry.path());
  return files;
}

}  // namespace

TEST_CASE("A cache gives back what was put into it under the same identity, and nothing under another") {
  const TemporaryFolder folder;
  const CacheFolder cache(folder.path() / "deep" / "cache", kRoom);
  CHECK(kept_text(cache, "one").empty());
  CHECK(!keep(cache, "one", "first"));
  CHECK(!keep(cache, "two", "second"));
  CHECK(kept_text(cache, "one") == "first");
  CHECK(kept_text(cache, "two") == "second");
  CHECK(kept_text(cache, "three").empty());
  CHECK(!keep(cache, "one", "again"));
  CHECK(kept_text(cache, "one") == "again");
  CHECK(cache.usage().files == 2);
}

TEST_CASE("A file of a cache that is damaged, cut off or of somebody else is as none") {
  const TemporaryFolder folder;
  const CacheFolder cache(folder.path(), kRoom);
  REQUIRE(!keep(cache, "one", "first"));
  const fs::path file = files_in(folder.path()).at(0);
  SECTION("a byte is another one") {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    stream.put('\x7f');
  }
  SECTION("it is cut off") {
    fs::resize_file(file, fs::file_size(file) - 1);
  }
  SECTION("it is empty") {
    fs::resize_file(file, 0);
  }
  SECTION("it is a text") {
    std::ofstream(file) << "something else";
  }
  SECTION("it is of another study") {
    REQUIRE(!keep(cache, "two", "second"));
    const std::vector<fs::path> files = files_in(folder.path());
    const fs::path other = files[0] == file ? files[1] : files[0];
    fs::copy_file(other, file, fs::copy_options::overwrite_existing);
  }
  SECTION("it is a folder") {
    fs::remove(file);
    fs::create_directory(file);
    CHECK(kept_text(cache, "one").empty());
    fs::remove(file);
  }
  CHECK(kept_text(cache, "one").empty());
  CHECK(!keep(cache, "one", "made again"));
  CHECK(kept_text(cache, "one") == "made again");
}

TEST_CASE("A cache that is full loses what nobody has used for longest") {
  const TemporaryFolder folder;
  const std::string large(1000, 'x');
  const CacheFolder cache(folder.path(), 4000);  // room for three of them, with what stands around them
  const auto make_old = [&](int seconds) {
    for (const fs::path& file : files_in(folder.path()))
      fs::last_write_time(file, fs::last_write_time(file) - std::chrono::seconds(seconds));
  };
  for (const char* const study : {"one", "two", "three"}) {
    REQUIRE(!keep(cache, study, large));
    make_old(10);
  }
  CHECK(kept_text(cache, "one") == large);  // used now
  REQUIRE(!keep(cache, "four", large));
  CHECK(kept_text(cache, "two").empty());
  for (const char* const study : {"one", "three", "four"})
    CHECK(kept_text(cache, study) == large);
  CHECK(cache.usage().bytes <= cache.limit());
  CHECK(!keep(cache, "five", std::string(5000, 'x')));  // more than all of the room
  CHECK(kept_text(cache, "five").empty());
  CHECK(kept_text(cache, "four") == large);
}

TEST_CASE("Clearing a cache leaves what is not its own") {
  const TemporaryFolder folder;
  const CacheFolder cache(folder.path() / "cache", kRoom);
  REQUIRE(!keep(cache, "one", "first"));
  const fs::path own = files_in(cache.path()).at(0);
  std::ofstream(own.string() + ".4194304.tmp") << "of a process that was killed";
  std::ofstream(cache.path() / "notes.kept") << "mine";
  CHECK(cache.clear().files == 1);
  CHECK(files_in(cache.path()) == std::vector{cache.path() / "notes.kept"});
  fs::remove(cache.path() / "notes.kept");
  REQUIRE(!keep(cache, "one", "first"));
  CHECK(cache.clear().files == 1);
  CHECK(!fs::exists(cache.path()));
}

TEST_CASE("A folder that cannot be written keeps nothing, and tells why once") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "no folder";
  const CacheFolder cache(folder.path() / "file" / "cache", kRoom);
  const std::optional<std::string> why = keep(cache, "one", "first");
  REQUIRE(why);
  CHECK_THAT(*why, Catch::Contains("cannot make the folder"));
  CHECK(!keep(cache, "one", "first"));
  CHECK(kept_text(cache, "one").empty());
  CHECK(cache.usage().files == 0);
}

TEST_CASE("Packed bytes come back as they were, and damaged ones are refused") {
  for (const std::string& text : {std::string(), std::string("a"), std::string(100'000, 'x')})
    CHECK(inflated(deflated(text)) == text);
  CHECK(deflated(std::string(100'000, 'x')).size() < 1000);
  const std::string packed = deflated("some content that is packed");
  CHECK_THROWS_AS(inflated(""), std::runtime_error);
  CHECK_THROWS_AS(inflated(packed.substr(0, packed.size() - 1)), std::runtime_error);
  CHECK_THROWS_AS(inflated(std::string(16, '\x7f')), std::runtime_error);  // of an impossible length
}
