#include <csignal>

#include <catch2/catch.hpp>
#include <sys/resource.h>

#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Files cannot grow beyond `bytes` while this lives: a full disk, as far as write() is concerned.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

void write_text(const std::filesystem::path& path, const std::string& text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

std::size_t count_files(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()),
                                                std::filesystem::directory_iterator()));
}

TEST_CASE("atomic file: a file is made, and replaced, with nothing beside it") {
  const TemporaryFolder folder;
  write_text(folder / "f", "first");
  CHECK(file_content(folder / "f") == "first");
  write_text(folder / "f", "");
  CHECK(file_content(folder / "f").empty());
  CHECK(count_files(folder) == 1);
}

TEST_CASE("atomic file: who has the old file open goes on reading the old file") {
  const TemporaryFolder folder;
  write_text(folder / "f", "old");
  std::filesystem::create_hard_link(folder / "f", folder / "opened");  // the old file by another name
  write_text(folder / "f", "new");
  CHECK(file_content(folder / "opened") == "old");
  CHECK(file_content(folder / "f") == "new");
}

TEST_CASE("atomic file: on a full disk the old file stays and the temporary one goes") {
  const TemporaryFolder folder;
  write_text(folder / "f", "old");
  {
    const FileSizeLimit limit(10000);
    CHECK_THROWS_WITH(write_text(folder / "f", std::string(20000, 'x')),
                      Catch::Contains((folder / "f").string()) && Catch::Contains("cannot write"));
  }
  CHECK(file_content(folder / "f") == "old");
  CHECK(count_files(folder) == 1);
}

TEST_CASE("atomic file: a path that cannot be written is refused by name and reason") {
  const TemporaryFolder folder;
  write_text(folder / "f", "a file");
  CHECK_THROWS_WITH(write_text(folder / "none/f", "x"), Catch::Contains("none/f: cannot create"));
  CHECK_THROWS_WITH(write_text(folder / "f/f", "x"), Catch::Contains("Not a directory"));
  std::filesystem::create_directory(folder / "folder");
  CHECK_THROWS_AS(write_text(folder / "folder", "x"), ArchiveError);
  std::filesystem::create_symlink("/dev/null", folder / "device");
  CHECK_THROWS_WITH(write_text(folder / "device", "x"), Catch::Contains("not a regular file"));
  CHECK(std::filesystem::is_symlink(folder / "device"));
  CHECK(count_files(folder) == 3);
}

TEST_CASE("atomic file: a link stays, and what it leads to is replaced") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("f", folder / "link");
  std::filesystem::create_symlink("link", folder / "link to it");
  for (const char* text : {"first", "second"}) {
    write_text(folder / "link to it", text);
    CHECK(file_content(folder / "f") == text);
  }
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(count_files(folder) == 3);
}

}  // namespace
