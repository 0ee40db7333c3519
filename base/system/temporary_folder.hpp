#pragma once

#include <filesystem>

#include <sys/types.h>

namespace mpm {

/// An empty folder "mpmbench-temporary-XXXXXX" among the temporary files (TMPDIR), which is removed with this
/// object.
///
/// If a process was killed, its folder stays until the same user makes the next one. A folder is locked
/// (flock()) as long as its process lives, or a process that was forked off and has its open files; a folder
/// of this name that is not locked is removed.
class TemporaryFolder {
 public:
  /// Errors: std::system_error when none can be made.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
  pid_t owner_;  ///< the process that removes the folder; its forked copies do not
};

}  // namespace mpm
