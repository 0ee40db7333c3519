#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/execution/run_options.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// One of the inputs that decide the result of an experiment.
struct IdentityEntry {
  std::string name;
  std::string value;

  bool operator==(const IdentityEntry&) const = default;
};

/// What two runs must have in common for the experiments of one to be experiments of the other: program (the
/// bits of a result belong to one build), study, seed, methods, solver, audit share, which loops are stored
/// and, if loops of an archive are assessed, which archive. The number of experiments is no part of it, so
/// that a longer run can resume a shorter one; nor are jobs, threads and processes.
using ShardIdentity = std::vector<IdentityEntry>;

ShardIdentity shard_identity(const Study& study, const RunOptions& options);

/// The version, the revision, and the digest of the program file: two builds of a revision may differ.
std::string program_identity();

/// Shards of another run. They are intact, so the user decides whether to delete them.
class OtherRun : public InputError {
 public:
  using InputError::InputError;

  /// The same error, with the advice that the option `--discard` deletes the shards.
  OtherRun with_advice() const { return OtherRun(fmt::format("{}; or --discard, which deletes it", what())); }
};

/// Throws OtherRun, which names the first entry that differs and both values. `found_in` names what `found`
/// was read from.
void require_same(const ShardIdentity& found, const ShardIdentity& expected, const std::string& found_in);

}  // namespace mpm
