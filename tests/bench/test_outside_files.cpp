#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "base/sha256.hpp"
#include "bench/files/outside_files.hpp"

namespace {

using namespace mpm;

TEST_CASE("outside files: a file is read in pieces, and its digest is that of all of it") {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("mpmbench-digest-{}", ::getpid());
  for (const std::size_t size : {0, 1, 65535, 65536, 65537, 200000}) {
    const std::string content = std::string(size / 2, 'a') + std::string(size - size / 2, 'b');
    std::ofstream(path, std::ios::binary) << content;
    CHECK(digest_of_file(path) == digest_of(content));
  }
  std::filesystem::remove(path);
  CHECK(digest_of_file(path) == digest_of(""));
  CHECK(digest_of("abc") == "ba7816bf8f01cfea");  // FIPS 180-4
}

}  // namespace
