#include "bench/files/archive_input.hpp"

#include <exception>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

/// The file of an archive whose records are read again and again. A command that replaces the archive puts a
/// new file in its place and leaves this one as it is; anything else that writes into this file would be read
/// as records. Does not wait for a pipe, which its reader will refuse.
class WatchedFile {
 public:
  explicit WatchedFile(const std::string& path)
      : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)), then_(now()) {}
  ~WatchedFile() {
    if (descriptor_ >= 0)
      ::close(descriptor_);
  }
  WatchedFile(const WatchedFile&) = delete;
  WatchedFile& operator=(const WatchedFile&) = delete;

  /// Throws ArchiveError if the file has changed.
  void require_unchanged() const {
    const struct ::stat status = now();
    if (status.st_size != then_.st_size || status.st_mtim.tv_sec != then_.st_mtim.tv_sec ||
        status.st_mtim.tv_nsec != then_.st_mtim.tv_nsec)
      throw ArchiveError(path_ +
                         ": found content that has just changed; allowed: an archive that nobody writes; run "
                         "the same command again to use it as it is now");
  }

 private:
  struct ::stat now() const {
    struct ::stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
      return {};
    return status;
  }

  std::string path_;
  int descriptor_;  // -1 if the file cannot be opened: its reader will say so
  struct ::stat then_;
};

/// Returns what `read` returns; turns its ArchiveError into BadArchive.
template <class Read>
auto as_input(Read read) {
  try {
    return read();
  } catch (const ArchiveError& error) {
    throw BadArchive(error.what());
  }
}

}  // namespace

Campaign stream_input(const std::string& archive) {
  const auto file = std::make_shared<const WatchedFile>(archive);
  Campaign campaign = as_input([&] { return stream_archive(archive); });
  if (!campaign.streamed)
    return campaign;
  const auto watched = [file](const auto& read) {
    return as_input([&] {
      try {
        return read();
      } catch (const std::exception&) {
        file->require_unchanged();  // unless this throws, the archive is as bad as that error says
        throw;
      }
    });
  };
  const auto require_unchanged = [file] { as_input([&] { file->require_unchanged(); }); };
  const RecordRange records = *campaign.streamed;
  campaign.streamed = RecordRange(
      records.size(),
      [=]() -> RecordRange::Next {
        return [=, next = records.one_by_one()] {
          const ExperimentRecord* const record = watched(next);
          if (record == nullptr)
            require_unchanged();
          return record;
        };
      },
      [=](std::size_t place) {
        ExperimentRecord record = watched([&] { return records.at(place); });
        require_unchanged();
        return record;
      });
  return campaign;
}

ExperimentRecord experiment_of(const Campaign& campaign, std::int64_t index) {
  const RecordRange records = records_of(campaign);
  const auto count = static_cast<std::int64_t>(records.size());
  if (index < 0 || index >= count)
    throw InputError("INDEX", fmt::format("{}", index),
                     count > 0 ? fmt::format("0 to {}", count - 1) : "none, the archive has no experiments");
  return records.at(static_cast<std::size_t>(index));
}

}  // namespace mpm
