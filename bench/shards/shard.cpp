#include "bench/shards/shard.hpp"

#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bench/outcome/outcome_bytes.hpp"
#include "plants/error.hpp"
#include "plants/system/input_file.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/file_seal.hpp"

namespace mpm {
namespace {

constexpr std::string_view kFileType = "mpmbench shard\n";

std::string heading(const ShardIdentity& identity, double seconds) {
  ByteWriter writer;
  writer.block(kFileType.data(), kFileType.size());
  const std::size_t entries = identity.size();
  transfer_all(writer, kShardVersion, entries);
  for (const IdentityEntry& entry : identity)
    transfer_all(writer, entry.name, entry.value);
  transfer(writer, seconds);
  return writer.take();
}

void require_version(ByteReader& reader, const std::string& file) {
  std::int32_t version = 0;
  transfer(reader, version);
  if (version != kShardVersion)
    throw InputError(file + ": format version of the shard", fmt::format("{}", version),
                     fmt::format("{}", kShardVersion));
}

ShardIdentity read_identity(ByteReader& reader) {
  std::size_t entries = 0;
  transfer(reader, entries);
  ShardIdentity identity;
  for (std::size_t i = 0; i < entries; ++i) {  // a wrong number ends with the bytes
    IdentityEntry& entry = identity.emplace_back();
    transfer_all(reader, entry.name, entry.value);
  }
  return identity;
}

ExperimentOutcome read_outcome(const std::string& bytes, const OutcomeBytes& format, std::size_t number) {
  try {
    return format.from_bytes(bytes);
  } catch (const std::exception& error) {  // a part of an outcome may refuse its numbers by an InputError
    throw std::runtime_error(fmt::format("outcome {}: {}", number, error.what()));
  }
}

/// What `read` reads of a whole shard. Throws InputError when it cannot.
template <class Read>
auto readable(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::runtime_error& error) {
    throw InputError(path.string(), fmt::format("a whole shard with unreadable content ({})", error.what()),
                     "what mpmbench writes; or --discard to start anew");
  }
}

/// Gives next(reader, file size) for each outcome, the reader being at it, and returns the seconds; none for
/// a shard that is damaged. Errors: as read_shard().
template <class Next, class Give>
std::optional<double> read_whole(const std::filesystem::path& path, const ShardIdentity& identity,
                                 const Next& next, const Give& give) {
  std::ifstream file(path, std::ios::binary);
  if (std::error_code no_status; !file && !std::filesystem::exists(path, no_status))
    throw ShardGone(path);
  const std::string bytes = content_of(file);
  std::optional<std::string_view> content = unsealed(bytes);
  if (!content)
    return std::nullopt;
  if (!content->starts_with(kFileType))
    throw InputError(path.string(), "a whole file of another type", "a shard of mpmbench");
  ByteReader reader(content->substr(kFileType.size()));
  const double seconds = readable(path, [&] {
    require_version(reader, path.string());
    require_same(read_identity(reader), identity, path.string());
    double taken = 0.0;
    transfer(reader, taken);
    return taken;
  });
  while (reader.left() > 0)
    give(readable(path, [&] { return next(reader, content->size()); }));
  return seconds;
}

}  // namespace

ShardGone::ShardGone(const std::filesystem::path& shard)
    : ArchiveError(fmt::format("{}: gone meanwhile, its run is at work; the same command again finds what is "
                               "there",
                               shard.string())) {}

void ShardBytes::add(const std::string& outcome) {
  ByteWriter writer;
  transfer(writer, outcome);
  outcomes_ += writer.take();
}

void ShardBytes::write(const std::filesystem::path& path, const ShardIdentity& identity, double seconds) {
  const std::string content = heading(identity, seconds) + outcomes_;
  const auto bytes = std::as_bytes(std::span(content));
  write_file_atomically(path, sealed({bytes.begin(), bytes.end()}));
  outcomes_.clear();
}

std::optional<double> read_shard(const std::filesystem::path& path, const ShardIdentity& identity,
                                 const OutcomeBytes& format,
                                 const std::function<void(ExperimentOutcome)>& take) {
  std::string bytes;
  std::size_t number = 0;
  const auto next = [&](ByteReader& reader, std::size_t) {
    transfer(reader, bytes);
    return read_outcome(bytes, format, number++);
  };
  return read_whole(path, identity, next, take);
}

std::optional<std::vector<OutcomePlace>> outcome_places(const std::filesystem::path& path,
                                                        const ShardIdentity& identity) {
  std::vector<OutcomePlace> places;
  std::string bytes;
  const auto next = [&](ByteReader& reader, std::size_t file_size) {
    transfer(reader, bytes);
    return OutcomePlace{OutcomeBytes::index_of(bytes), file_size - reader.left() - bytes.size(),
                        static_cast<std::uint32_t>(bytes.size())};
  };
  const auto give = [&places](const OutcomePlace& place) { places.push_back(place); };
  return read_whole(path, identity, next, give) ? std::optional(std::move(places)) : std::nullopt;
}

}  // namespace mpm
