#include "results/files/atomic_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::string_view kExtension = ".tmp";  // after the process number

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  const std::error_code error(errno, std::generic_category());
  throw ArchiveError(fmt::format("{}: cannot {}: {}", path.string(), action, error.message()));
}

void write_all(int descriptor, std::span<const std::byte> content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      fail(path, "write");
    content = content.subspan(static_cast<std::size_t>(written));
  }
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

constexpr int kMostLinks = 40;  // the limit of the kernel

/// Returns where a link leads, or the path itself if it is no link.
std::filesystem::path next_link(const std::filesystem::path& path) {
  std::error_code error;  // a path that cannot be looked at counts as no link
  const std::filesystem::path target = std::filesystem::read_symlink(path, error);
  return error ? path : path.parent_path() / target;
}

/// Returns the number of the open file of this process that a path stands for, as /dev/stdout does; none for
/// other paths.
std::optional<int> open_file_of(std::filesystem::path path) {
  std::error_code error;  // without /proc no path stands for an open file
  const std::filesystem::path open_files = std::filesystem::canonical("/proc/self/fd", error);
  for (int links = 0; !error && links < kMostLinks; ++links) {
    const std::string name = path.filename().string();
    int number = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
    if (read.ec == std::errc() && read.ptr == name.data() + name.size() &&
        std::filesystem::canonical(folder_of(path), error) == open_files && ::fcntl(number, F_GETFD) >= 0)
      return number;
    if (!std::filesystem::is_symlink(path, error))
      break;
    path = next_link(path);
  }
  return std::nullopt;
}

bool is_locked_by_its_writer(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) != 0;
}

/// A file that is open for writing and is removed at the end unless it was renamed. It is locked meanwhile:
/// an unlocked one was left by a process that was killed.
class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& target)
      : target_(target), path_(fmt::format("{}.{}{}", target.string(), ::getpid(), kExtension)) {
    while (!make_and_lock()) {
    }
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  ~TemporaryFile() {
    if (descriptor_ >= 0)
      ::close(descriptor_);
    if (!renamed_)
      ::unlink(path_.c_str());
  }

  std::filesystem::path path() const { return path_; }

  void write(std::span<const std::byte> content) { write_all(descriptor_, content, target_); }

  void flush() {
    if (::fsync(descriptor_) != 0)
      fail(target_, "flush to the disk");
  }

  void rename() {
    if (std::rename(path_.c_str(), target_.c_str()) != 0)
      fail(target_, "put the finished file in place");
    renamed_ = true;
  }

 private:
  /// Returns false if the file is gone: another process that cleans up may have removed it before it was
  /// locked.
  bool make_and_lock() {
    constexpr mode_t kAnybody = 0666;  // minus the umask, as for any new file
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, kAnybody);
    if (descriptor_ < 0)
      fail(target_, "create a temporary file beside it");
    struct stat status {};
    ::flock(descriptor_, LOCK_EX | LOCK_NB);  // fails harmlessly where there are no locks
    if (::fstat(descriptor_, &status) == 0 && status.st_nlink == 0) {
      ::close(std::exchange(descriptor_, -1));
      return false;
    }
    return true;
  }

  std::filesystem::path target_;
  std::string path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// Tells whether `name` is a name that TemporaryFile gives to a file for `target`.
bool is_temporary_name(std::string_view name, std::string_view target) {
  if (!name.starts_with(target) || !name.ends_with(kExtension) ||
      name.size() < target.size() + kExtension.size())
    return false;
  const std::string_view process =
      name.substr(target.size(), name.size() - target.size() - kExtension.size());
  return process.size() > 1 && process.front() == '.' &&
         process.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Makes the rename itself permanent. The file is complete by now, so nothing is lost if a file system cannot
/// do this.
void flush_folder(const std::filesystem::path& file) {
  const int descriptor = ::open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_text_atomically(const std::filesystem::path& path,
                           const std::function<void(const TextSink&)>& write) {
  write_file_atomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    write([&file](std::string_view piece) { file << piece; });
    if (!file.flush())
      fail(path, "write it");
  });
}

std::filesystem::path link_target(std::filesystem::path path) {
  std::error_code error;  // a path that cannot be looked at counts as no link
  for (int links = 0; std::filesystem::is_symlink(path, error); ++links) {
    errno = ELOOP;
    if (links == kMostLinks)
      fail(path, "follow the link");
    path = next_link(path);
  }
  return path;
}

void remove_abandoned_files(const std::filesystem::path& target) {
  std::vector<std::filesystem::path> temporary;
  std::error_code error;  // files that cannot be listed or removed stay
  for (const auto& entry : std::filesystem::directory_iterator(folder_of(target), error))
    if (is_temporary_name(entry.path().filename().string(), target.filename().string()) &&
        entry.is_regular_file(error))
      temporary.push_back(entry.path());
  for (const std::filesystem::path& file : temporary) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
      continue;
    if (!is_locked_by_its_writer(descriptor))
      std::filesystem::remove(file, error);
    ::close(descriptor);
  }
}

bool is_stream(const std::filesystem::path& path) {
  std::error_code error;  // a path that cannot be looked at is no stream
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status) ||
         open_file_of(path).has_value();
}

namespace {

template <class Write>
void write_atomically(const std::filesystem::path& path, const Write& write) {
  const std::filesystem::path target = link_target(path);
  std::error_code error;  // not needed: a path that cannot be looked at fails below
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error))
    throw ArchiveError(
        fmt::format("{}: cannot be replaced: it is a {}, not a regular file", path.string(),
                    std::filesystem::is_directory(target, error) ? "folder" : "device or a pipe"));
  remove_abandoned_files(target);
  TemporaryFile file(target);
  write(file);
  file.flush();
  file.rename();
  flush_folder(target);
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content) {
  write_atomically(path, [content](TemporaryFile& file) { file.write(content); });
}

void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& fill) {
  write_atomically(path, [&fill](const TemporaryFile& file) { fill(file.path()); });
}

void write_through(const std::filesystem::path& path, std::span<const std::byte> content) {
  // A file that is already open is not opened again: that would overwrite its beginning.
  const std::optional<int> number = open_file_of(path);
  const int descriptor =
      number ? ::fcntl(*number, F_DUPFD_CLOEXEC, 0) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0)
    fail(path, "open");
  try {
    write_all(descriptor, content, path);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  if (::close(descriptor) != 0)
    fail(path, "close");
}

}  // namespace mpm
