#include "bench/shards/shard_identity.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/method_table.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/version.hpp"

namespace mpm {
namespace {

/// The methods, each with everything else that decides its answers.
std::string methods_text(const Study& study) {
  std::vector<std::string> methods;
  for (const std::string& name : study.methods) {
    const std::string& fingerprint = method_table(study.assessment).method(name).fingerprint;
    methods.push_back(fingerprint.empty() ? name : fmt::format("{} ({})", name, fingerprint));
  }
  return fmt::format("{}", fmt::join(methods, ", "));
}

std::string study_text(const Study& study) {
  const std::string outside = outside_files(study);
  return fmt::format("{} (text {}{}{})", study.name, digest_of(study.source), outside.empty() ? "" : ", ",
                     outside);
}

}  // namespace

std::string program_identity() {
  static const std::string file = digest_of_file("/proc/self/exe");
  return fmt::format("mpmbench {} {} (program {})", mpmbench_version(), source_revision(), file);
}

ShardIdentity shard_identity(const Study& study, const RunOptions& options) {
  ShardIdentity identity{{"program", program_identity()},
                         {"study", study_text(study)},
                         {"seed", fmt::format("{}", study.seed)},
                         {"methods", methods_text(study)},
                         {"solver", options.solver},
                         {"audit", fmt::format("{}", audited_share(study, options))},
                         {"store", name_of(options.store)}};
  if (!options.archive.empty())
    identity.push_back({"archive", options.archive});
  return identity;
}

void require_same(const ShardIdentity& found, const ShardIdentity& expected, const std::string& found_in) {
  const auto [one, other] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  if (one == found.end() && other == expected.end())
    return;
  const IdentityEntry none{"end", "nothing more"};
  const IdentityEntry& here = one == found.end() ? none : *one;
  const IdentityEntry& there = other == expected.end() ? none : *other;
  throw OtherRun(fmt::format("{}: it belongs to a run with another {}: found {}; allowed: {}", found_in,
                             there.name, here.value, there.value));
}

}  // namespace mpm
