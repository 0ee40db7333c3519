#include "bench/shards/shard_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".shard";
constexpr const char* kLock = "lock";

std::vector<fs::path> files_in(const fs::path& folder, const char* extension) {
  std::vector<fs::path> files;
  std::error_code error;  // a folder that is not there has no files
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == extension && entry.is_regular_file(error))  // a pipe might never answer
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());  // names are numbers of fixed width
  return files;
}

/// The number in the name of a shard; 0 for a name that this program does not give.
int number_of(const fs::path& shard) {
  const std::string stem = shard.stem().string();
  const bool digits = !stem.empty() && stem.size() < 9 &&
                      std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? std::stoi(stem) : 0;
}

}  // namespace

ShardFolder::ShardFolder(fs::path folder) : path_(std::move(folder)) {
  std::error_code error;
  fs::create_directory(path_, error);
  if (error)
    throw ArchiveError(
        fmt::format("{}: cannot make the folder of shards: {}", path_.string(), error.message()));
  lock();
  for (const fs::path& shard : shards())
    last_ = std::max(last_, number_of(shard));
}

ShardFolder::~ShardFolder() {
  if (shards().empty()) {
    std::error_code ignored;  // what is not ours stays, and the folder with it
    fs::remove(path_ / kLock, ignored);
    fs::remove(path_, ignored);
  }
  ::close(lock_);
}

/// A record lock ends with its process however that ends, and worker processes do not inherit it.
void ShardFolder::lock() {
  const fs::path file = path_ / kLock;
  constexpr mode_t kAnybody = 0666;
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kAnybody);
  if (lock_ < 0)
    throw ArchiveError(
        fmt::format("{}: cannot be made: {}", file.string(), std::generic_category().message(errno)));
  struct flock region {};
  region.l_type = F_WRLCK;
  region.l_whence = SEEK_SET;
  if (::fcntl(lock_, F_SETLK, &region) == 0 || (errno != EACCES && errno != EAGAIN))
    return;  // locked, or on a file system that knows no locks
  ::fcntl(lock_, F_GETLK, &region);
  ::close(lock_);
  throw InputError(path_.string(), fmt::format("another run in progress, process {}", region.l_pid),
                   "one run per output at a time");
}

std::vector<fs::path> ShardFolder::shards() const {
  return shards_in(path_);
}

fs::path ShardFolder::next() {
  return path_ / fmt::format("{:08}{}", ++last_, kExtension);
}

void ShardFolder::clear() {
  for (const char* extension : {kExtension, ".tmp"})
    for (const fs::path& file : files_in(path_, extension))
      fs::remove(file);
}

std::vector<fs::path> shards_in(const fs::path& folder) {
  return files_in(folder, kExtension);
}

fs::path shard_folder_of(const fs::path& output) {
  return output.string() + ".shards";
}

void remove_shards(const fs::path& output) {
  remove_shard_folder(shard_folder_of(output));
}

void remove_shard_folder(const fs::path& folder) {
  ShardFolder shards(folder);
  shards.clear();
  fs::remove(shards.path() / kCampaignDescription);
}

bool has_shards(const fs::path& output) {
  return !shards_in(shard_folder_of(output)).empty();
}

}  // namespace mpm
