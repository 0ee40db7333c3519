#include "bench/cache/cache_folder.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system/surroundings.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBytesInMegabyte = 1'000'000;
constexpr std::uint64_t kDefaultMegabytes = 2000;
constexpr std::string_view kKept = ".kept";
constexpr std::size_t kDigits = 64;  // hexadecimal digits of a SHA-256

struct KeptFile {
  fs::path path;
  std::uint64_t bytes;
  fs::file_time_type used;
};

/// The name of the cache file to which a file belongs; none if it belongs to no cache. A process that is
/// killed while it writes leaves a file with a longer name that begins with this one.
std::optional<std::string> name_in_cache(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::string own = name.substr(0, kDigits + kKept.size());
  const bool is_ours = own.ends_with(kKept) && own.find_first_not_of("0123456789abcdef") == kDigits;
  return is_ours ? std::optional(own) : std::nullopt;
}

/// Returns the files of a cache, and removes those that killed processes have left half-written.
std::vector<KeptFile> kept_files(const fs::path& folder) {
  std::vector<KeptFile> files;
  std::error_code error;  // another process may have removed the folder, or a file
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::optional<std::string> name = name_in_cache(entry.path());
    if (name && *name != entry.path().filename())
      remove_abandoned_files(folder / *name);
    else if (name && entry.is_regular_file(error))
      if (const std::uint64_t bytes = entry.file_size(error); !error)
        files.push_back({entry.path(), bytes, entry.last_write_time(error)});
  }
  return files;
}

CacheUsage cache_usage_of(const std::vector<KeptFile>& files) {
  CacheUsage usage{.files = files.size()};
  for (const KeptFile& file : files)
    usage.bytes += file.bytes;
  return usage;
}

std::string environment_of(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::uint64_t limit_of_user() {
  const std::string text = environment_of("MPMBENCH_CACHE_MB");
  if (text.empty())
    return kDefaultMegabytes * kBytesInMegabyte;
  std::uint64_t megabytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), megabytes);
  constexpr std::uint64_t kMost = 1'000'000'000;
  if (error != std::errc() || end != text.data() + text.size() || megabytes > kMost)
    throw InputError("MPMBENCH_CACHE_MB", text, fmt::format("a whole number from 0 to {}", kMost));
  return megabytes * kBytesInMegabyte;
}

}  // namespace

fs::path CacheFolder::file_of(const ShardIdentity& identity) const {
  std::string text;
  for (const IdentityEntry& entry : identity)
    text += fmt::format("{} {} {}\n", entry.name, entry.value.size(), entry.value);
  return path_ / (sha256(std::as_bytes(std::span(text))) + std::string(kKept));
}

std::optional<ShardContent> CacheFolder::read(const ShardIdentity& identity) const {
  const fs::path file = file_of(identity);
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    return std::nullopt;
  try {
    std::optional<ShardContent> content = read_shard(file, identity);
    if (content)
      fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    return content;
  } catch (const std::exception& failure) {  // an intact file of another kind, or one that has just gone
    if (is_of_surroundings(failure))
      throw;
    return std::nullopt;
  }
}

std::optional<std::string> CacheFolder::write(ShardBytes& content, const ShardIdentity& identity) const {
  if (content.size() > limit_ || cannot_write_)
    return std::nullopt;
  std::error_code error;
  fs::create_directories(path_, error);
  try {
    if (error)
      throw ArchiveError(fmt::format("{}: cannot make the folder: {}", path_.string(), error.message()));
    content.write(file_of(identity), identity, 0.0);
  } catch (const ArchiveError& failure) {
    cannot_write_ = true;
    return failure.what();
  }
  make_room();
  return std::nullopt;
}

void CacheFolder::make_room() const {
  std::vector<KeptFile> files = kept_files(path_);
  std::uint64_t bytes = cache_usage_of(files).bytes;
  if (bytes <= limit_)
    return;
  std::sort(files.begin(), files.end(),
            [](const KeptFile& one, const KeptFile& other) { return one.used < other.used; });
  std::error_code gone;
  for (const KeptFile& file : files) {
    if (bytes <= limit_)
      return;
    fs::remove(file.path, gone);
    bytes -= file.bytes;
  }
}

CacheUsage CacheFolder::usage() const {
  return cache_usage_of(kept_files(path_));
}

CacheUsage CacheFolder::clear() const {
  const std::vector<KeptFile> files = kept_files(path_);
  std::error_code gone;
  for (const KeptFile& file : files)
    fs::remove(file.path, gone);
  fs::remove(path_, gone);  // unless something else is in it
  return cache_usage_of(files);
}

std::shared_ptr<const CacheFolder> user_cache() {
  const std::string wanted = environment_of("MPMBENCH_CACHE");
  if (wanted == "off")
    return nullptr;
  fs::path folder = wanted;
  if (wanted.empty()) {
    const fs::path caches = environment_of("XDG_CACHE_HOME"), home = environment_of("HOME");
    if (caches.is_absolute())  // its specification ignores relative paths
      folder = caches / "mpmbench";
    else if (home.is_absolute())
      folder = home / ".cache" / "mpmbench";
    else
      return nullptr;
  }
  return std::make_shared<const CacheFolder>(fs::absolute(folder), limit_of_user());
}

}  // namespace mpm
