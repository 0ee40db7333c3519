#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_messages.hpp"
#include "results/archive/campaign.hpp"

// The loops of a campaign without the truth, for somebody who assesses them and must not know what is wrong.

namespace mpm {

/// What a blind export contains besides the loops of the experiments.
struct BlindParts {
  bool calibration = false;  ///< the calibration loops, mixed with the others and numbered like them
  bool windows = false;      ///< the form gets a line for each moving window of each loop
};

/// One loop of a blind export.
struct BlindLoop {
  bool of_calibration = false;
  std::size_t place = 0;   ///< among the records, or in Campaign::calibration.loops
  std::int64_t index = 0;  ///< of the experiment, or of the calibration loop
};

/// The loops of a blind export, in the order of their numbers. They are stored elsewhere and read again in
/// each pass. A loop without samples did not run to its end.
struct BlindLoops {
  using Next = std::function<AssessedLoop()>;  ///< returns one loop after the other
  std::size_t count = 0;
  std::function<Next()> begin;
};

/// The loops of an export and, if each loop has its own benchmark, these benchmarks.
struct BlindRecords {
  BlindLoops loops;
  std::optional<BlindLoops> benchmarks = {};
};

/// Returns the names of the rows of a signal of the loops of a study.
std::vector<std::string> row_names(const Study& study, const LoopSignal& signal);

/// Returns which loops of the campaign are the loops 0, 1, 2, ... of its blind export. These are the records
/// with status ok and, if asked for, all calibration loops, because no archive tells whether a calibration
/// loop ran to its end. The stream `blind_order` of the master seed shuffles them (Fisher and Yates), so that
/// the archive is the key.
std::vector<BlindLoop> blind_order(const Campaign& campaign, bool with_calibration);

/// Returns the SHA-256 of what defines the loops: study, seed, solver, indices and Ivar_basis of the records
/// with status ok, and whether calibration loops are included. It does not change when methods are added to
/// the campaign, and it does not reveal what it was made of.
std::string loops_hash(const Campaign& campaign, bool with_calibration);

/// Returns the comment line of a CSV file that says which loops the file is about.
std::string hash_line(const std::string& hash);

/// Writes a blind export into `folder`, which must exist (docs/bring_your_own.md): `loops.nc` (netCDF-4),
/// `loops.csv`, `benchmark.csv`, `context.json` and `verdicts.csv`, a form to fill in. `records` are those of
/// blind_order(). The benchmark is that of the context, unless each loop has its own. If windows are asked
/// for, the study must monitor. Errors: ArchiveError if a file cannot be written.
void write_blind_loops(const std::filesystem::path& folder, const Campaign& campaign,
                       const AssessmentContext& context, const BlindRecords& records,
                       const BlindParts& parts);

/// Returns the key of a blind export, for somebody who trains a method on it: CSV with the columns `loop` and
/// `experiment` (its index; empty for a calibration loop).
std::string blind_key(const Campaign& campaign, bool with_calibration);

}  // namespace mpm
