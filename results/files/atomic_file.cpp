#include "results/files/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::string_view kExtension = ".tmp";  // after the number of the process

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  const std::error_code error(errno, std::generic_category());
  throw ArchiveError(fmt::format("{}: cannot {}: {}", path.string(), action, error.message()));
}

/// A file that is open for writing, and is removed again unless it is renamed.
class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& target)
      : target_(target), path_(fmt::format("{}.{}{}", target.string(), ::getpid(), kExtension)) {
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

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

/// Whether `name` is one that TemporaryFile gives for the target of this name.
bool is_temporary_name(std::string_view name, std::string_view target) {
  if (!name.starts_with(target) || !name.ends_with(kExtension) ||
      name.size() < target.size() + kExtension.size())
    return false;
  const std::string_view process =
      name.substr(target.size(), name.size() - target.size() - kExtension.size());
  return process.size() > 1 && process.front() == '.' &&
         process.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Makes the rename itself last. The file is complete by now, so that nothing is lost when a file system
/// cannot do this.
void flush_folder(const std::filesystem::path& file) {
  const int descriptor = ::open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
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

void remove_abandoned_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> abandoned;
  std::error_code error;  // what cannot be listed or removed stays
  for (const auto& entry : std::filesystem::directory_iterator(folder_of(path), error))
    if (is_temporary_name(entry.path().filename().string(), path.filename().string()))
      abandoned.push_back(entry.path());
  for (const std::filesystem::path& file : abandoned)
    std::filesystem::remove(file, error);
}

}  // namespace mpm
