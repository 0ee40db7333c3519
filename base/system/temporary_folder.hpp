#pragma once

#include <filesystem>

#include <sys/types.h>

namespace mpm {

/// An empty folder "mpmbench-temporary-XXXXXX" among the temporary files (TMPDIR), which goes with this
/// object.
///
/// Of a process that was killed it stays, and goes when the same user makes the next one: as long as its
/// process lives, or one that was forked off and has its open files, the folder is locked (flock()), and a
/// folder of this name that nobody has locked is nobody's.
class TemporaryFolder {
 public:
  /// Errors: std::system_error when there is none to be had.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
  pid_t owner_;  ///< which removes the folder: a copy of this process does not
};

}  // namespace mpm
