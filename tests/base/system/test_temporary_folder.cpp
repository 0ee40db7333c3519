#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/temporary_folder.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

/// Another TMPDIR, and another process that has a temporary folder in it until it is killed.
class OtherUser {
 public:
  OtherUser() {
    ::setenv("TMPDIR", inner_.c_str(), 1);
    std::array<int, 2> made{};
    REQUIRE(::pipe(made.data()) == 0);
    child_ = ::fork();
    if (child_ == 0) {
      const TemporaryFolder folder;
      std::ofstream(folder.path() / "file") << "content";
      fs::create_directory(folder.path() / "inner");
      if (::write(made[1], "x", 1) == 1)
        ::pause();
      ::_exit(1);
    }
    char byte = 0;
    REQUIRE(::read(made[0], &byte, 1) == 1);
    ::close(made[0]);
    ::close(made[1]);
  }
  OtherUser(const OtherUser&) = delete;
  OtherUser& operator=(const OtherUser&) = delete;
  ~OtherUser() {
    if (child_ > 0)
      kill();
    ::unsetenv("TMPDIR");
    fs::remove_all(inner_);
  }

  void kill() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

  const fs::path& temporary() const { return inner_; }
  /// Files and folders in TMPDIR.
  auto count() const { return std::distance(fs::directory_iterator(inner_), {}); }

 private:
  static fs::path made_folder() {
    std::string name = (fs::temp_directory_path() / "mpmbench-test-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    return name;
  }

  fs::path inner_ = made_folder();
  pid_t child_ = -1;
};

TEST_CASE("a temporary folder goes with its owner") {
  fs::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    CHECK(fs::is_empty(path));
    std::ofstream(path / "file") << "content";
    const TemporaryFolder other;
    CHECK(other.path() != path);
    CHECK(fs::exists(path / "file"));
  }
  CHECK_FALSE(fs::exists(path));
}

TEST_CASE("the temporary folder of a killed process goes with the next one that is made, no other does") {
  OtherUser other;
  fs::create_directory(other.temporary() / "mpmbench-temporary-mine");  // with the rights of everybody
  fs::permissions(other.temporary() / "mpmbench-temporary-mine", fs::perms(0755));
  fs::create_directory_symlink("/", other.temporary() / "mpmbench-temporary-linked");
  CHECK(other.count() == 3);
  { const TemporaryFolder folder; }
  CHECK(other.count() == 3);  // that of a process at work stays
  other.kill();
  CHECK(other.count() == 3);
  { const TemporaryFolder folder; }
  CHECK(other.count() == 2);
}

TEST_CASE("a forked copy of its owner leaves a temporary folder") {
  OtherUser other;
  std::optional<TemporaryFolder> folder(std::in_place);
  const pid_t copy = ::fork();
  if (copy == 0) {
    folder.reset();
    ::_exit(0);
  }
  ::waitpid(copy, nullptr, 0);
  CHECK(fs::exists(folder->path()));
  const TemporaryFolder next;
  CHECK(fs::exists(folder->path()));
}

}  // namespace
}  // namespace mpm
