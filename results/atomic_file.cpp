#include "results/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "results/archive_error.hpp"

namespace mpm {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  const std::error_code error(errno, std::generic_category());
  throw ArchiveError(fmt::format("{}: cannot {}: {}", path.string(), action, error.message()));
}

/// A file that is open for writing, and is removed again unless it is renamed.
class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& target)
      : target_(target), path_(target.string() + fmt::format(".{}.tmp", ::getpid())) {
    constexpr mode_t kAnybody = 0666;  // less the umask, as for any new file
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kAnybody);
    if (descriptor_ < 0)
      fail(target_, "create a temporary file beside it");
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  ~TemporaryFile() {
    if (descriptor_ >= 0)
      ::close(descriptor_);
    if (!renamed_)
      ::unlink(path_.c_str());
  }

  void write(std::span<const std::byte> content) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR)
        continue;
      if (written < 0)
        fail(target_, "write");
      content = content.subspan(static_cast<std::size_t>(written));
    }
  }

  void flush_and_close() {
    if (::fsync(descriptor_) != 0)
      fail(target_, "flush to the disk");
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0)
      fail(target_, "close");
  }

  void rename() {
    if (std::rename(path_.c_str(), target_.c_str()) != 0)
      fail(target_, "put the finished file in place");
    renamed_ = true;
  }

 private:
  std::filesystem::path target_;
  std::string path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// Makes the rename itself last. The file is complete by now, so that nothing is lost when a file system
/// cannot do this.
void flush_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content) {
  TemporaryFile file(path);
  file.write(content);
  file.flush_and_close();
  file.rename();
  flush_folder(path);
}

}  // namespace mpm
