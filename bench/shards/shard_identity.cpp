#include "bench/shards/shard_identity.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/files/sha256.hpp"

namespace mpm {
namespace {

std::string digest(std::string_view content) {
  constexpr std::size_t kDigits = 16;  // enough against accidents, and short enough for a message
  return sha256(std::as_bytes(std::span(content))).substr(0, kDigits);
}

std::string digest_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  return digest(content);
}

/// The version, the revision, and the digest of the program file: two builds of a revision may differ.
std::string program() {
  return fmt::format("mpmbench {} {} (program {})", mpmbench_version(), source_revision(),
                     digest_of_file("/proc/self/exe"));
}

/// What the file of a plant that somebody else simulates adds to a study.
std::string plant_file(const Study& study) {
  return study.nonlinear && study.nonlinear->model.foreign && !study.nonlinear->model.foreign->file().empty()
             ? fmt::format(", FMU {}", digest_of_file(study.nonlinear->model.foreign->file()))
             : "";
}

std::string_view name_of(StorePolicy store) {
  switch (store) {
    case StorePolicy::none:
      return "none";
    case StorePolicy::flagged:
      return "flagged";
    case StorePolicy::all:
      return "all";
  }
  return "";
}

}  // namespace

ShardIdentity shard_identity(const Study& study, const RunOptions& options) {
  return {{"program", program()},
          {"study", fmt::format("{} (text {}{})", study.name, digest(study.source), plant_file(study))},
          {"seed", fmt::format("{}", study.seed)},
          {"methods", fmt::format("{}", fmt::join(study.methods, ", "))},
          {"solver", options.solver},
          {"audit", fmt::format("{}", audited_share(options))},
          {"store", std::string(name_of(options.store))}};
}

void require_same(const ShardIdentity& found, const ShardIdentity& expected, const std::string& found_in) {
  const auto [one, other] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  if (one == found.end() && other == expected.end())
    return;
  const IdentityEntry none{"end", "nothing more"};
  const IdentityEntry& here = one == found.end() ? none : *one;
  const IdentityEntry& there = other == expected.end() ? none : *other;
  throw InputError(fmt::format("{}: it belongs to a run with another {}: found {}; allowed: {}", found_in,
                               there.name, here.value, there.value));
}

}  // namespace mpm
