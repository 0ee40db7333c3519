#include "base/system/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderName = "mpmbench-temporary-";
constexpr const char* kDrawn = "XXXXXX";  // part of the name that mkdtemp() replaces
constexpr mode_t kPermissions = 0777;     // permission bits of a mode, without the type

int open_folder(const fs::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/// Tells whether mkdtemp() can have made this folder for this user. Folders of this name that others made
/// stay.
bool is_ours(int folder) {
  struct stat status {};
  return ::fstat(folder, &status) == 0 && status.st_uid == ::geteuid() &&
         (status.st_mode & kPermissions) == S_IRWXU;
}

/// Removes the folders of processes that have ended. Whatever cannot be removed stays.
void remove_left_folders(const fs::path& among) {
  std::error_code ignored;
  for (fs::directory_iterator entry(among, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(kFolderName))
      continue;
    const int folder = open_folder(entry->path());
    if (folder < 0)
      continue;
    std::error_code stays;
    if (is_ours(folder) && ::flock(folder, LOCK_EX | LOCK_NB) == 0)
      fs::remove_all(entry->path(), stays);
    ::close(folder);
  }
}

/// Makes a folder and locks it. Returns its open file, or -1 if another process took the folder for an
/// abandoned one between these two steps. On a file system without locks no process can do that.
int make_locked_folder(std::string& name) {
  if (::mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), name + ": no temporary folder");
  const int folder = open_folder(name);
  const bool is_taken = folder >= 0 && ::flock(folder, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  struct stat status {};
  if (folder >= 0 && !is_taken && ::fstat(folder, &status) == 0 && status.st_nlink > 0)
    return folder;
  if (folder < 0 && errno != ENOENT)
    throw std::system_error(errno, std::generic_category(), name + ": cannot be opened");
  ::close(folder);
  return -1;
}

}  // namespace

TemporaryFolder::TemporaryFolder() : owner_(::getpid()) {
  const fs::path among = fs::temp_directory_path();
  remove_left_folders(among);
  std::string name;
  while (lock_ < 0) {
    name = (among / kFolderName).string() + kDrawn;
    lock_ = make_locked_folder(name);
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (owner_ == ::getpid())
    fs::remove_all(path_, ignored);
  ::close(lock_);
}

}  // namespace mpm
