#include "bench/shards/shard.hpp"

#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/system/input_file.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/file_seal.hpp"

namespace mpm {
namespace {

constexpr std::string_view kFileType = "mpmbench shard\n";

template <class Stream, class Identity>
void transfer_identity(Stream& stream, Identity& identity) {
  transfer_list(stream, identity, [&](auto& entry) { transfer_all(stream, entry.name, entry.value); });
}

void require_version(ByteReader& reader, const std::string& file) {
  std::int32_t version = 0;
  transfer(reader, version);
  if (version != kShardVersion)
    throw OtherRun(
        fmt::format("{}: format version of the shard: found {}; allowed: {}", file, version, kShardVersion));
}

}  // namespace

ShardGone::ShardGone(const std::filesystem::path& shard)
    : ArchiveError(fmt::format(
          "{}: the file is gone, because its run is still in progress; run the same command again",
          shard.string())) {}

UnreadableShard::UnreadableShard(const std::filesystem::path& shard, const std::string& why)
    : InputError(shard.string(), fmt::format("a whole shard with unreadable content ({})", why),
                 "a shard as mpmbench writes it; or --discard to start again") {}

void ShardBytes::add(std::int64_t key, const std::string& bytes) {
  ByteWriter writer;
  transfer_all(writer, key, bytes);
  entries_ += writer.take();
}

void ShardBytes::write(const std::filesystem::path& path, const ShardIdentity& identity, double seconds) {
  ByteWriter writer;
  writer.block(kFileType.data(), kFileType.size());
  transfer(writer, kShardVersion);
  transfer_identity(writer, identity);
  transfer(writer, seconds);
  const std::string content = writer.take() + entries_;
  const auto bytes = std::as_bytes(std::span(content));
  write_file_atomically(path, sealed({bytes.begin(), bytes.end()}));
  entries_.clear();
}

std::optional<ShardContent> read_shard(const std::filesystem::path& path, const ShardIdentity& identity) {
  std::ifstream file(path, std::ios::binary);
  if (std::error_code no_status; !file && !std::filesystem::exists(path, no_status))
    throw ShardGone(path);
  std::string bytes = content_of(file);
  const std::optional<std::string_view> content = unsealed(bytes);
  if (!content)
    return std::nullopt;
  if (!content->starts_with(kFileType))
    throw InputError(path.string(), "a whole file of another type", "a shard of mpmbench");
  try {
    ByteReader reader(content->substr(kFileType.size()));
    require_version(reader, path.string());
    ShardIdentity found;
    transfer_identity(reader, found);
    require_same(found, identity, path.string());
    ShardContent read;
    transfer(reader, read.seconds);
    std::string entry;
    while (reader.left() > 0) {
      ShardPlace place{};
      transfer_all(reader, place.key, entry);
      place.size = entry.size();
      place.begin = content->size() - reader.left() - place.size;
      read.places.push_back(place);
    }
    read.file = std::move(bytes);
    return read;
  } catch (const std::runtime_error& error) {
    throw UnreadableShard(path, error.what());
  }
}

}  // namespace mpm
