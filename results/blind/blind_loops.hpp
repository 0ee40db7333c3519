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

// The loops of a campaign without the truth: for somebody who assesses them and must not know what is
// wrong.

namespace mpm {

/// What a blind export has besides the loops of the experiments.
struct BlindParts {
  bool calibration = false;  ///< the calibration loops, among the others and under numbers like theirs
  bool windows = false;      ///< a line of the form for each moving window of each loop
};

/// A loop of a blind export.
struct BlindLoop {
  bool of_calibration = false;
  std::size_t place = 0;   ///< among the records, or in Campaign::calibration.loops
  std::int64_t index = 0;  ///< of the experiment, or of the calibration loop
};

/// Loops of a blind export in the order of their numbers, which wait elsewhere and are read anew each time;
/// one without samples did not run to its end.
struct BlindLoops {
  using Next = std::function<AssessedLoop()>;  ///< gives one after the other
  std::size_t count = 0;
  std::function<Next()> begin;
};

/// The loops of an export, and where each has a benchmark of its own, these.
struct BlindRecords {
  BlindLoops loops;
  std::optional<BlindLoops> benchmarks = {};
};

/// The names of the rows of a signal of the loops of a study.
std::vector<std::string> row_names(const Study& study, const LoopSignal& signal);

/// Which loops of the campaign are the loops 0, 1, 2, ... of its blind export: records with status ok and, if
/// asked for, all calibration loops, in a shuffle by the stream `blind_order` of the master seed (Fisher and
/// Yates), so that the archive is the key. No archive tells whether a calibration loop ran to its end.
std::vector<BlindLoop> blind_order(const Campaign& campaign, bool with_calibration);

/// SHA-256 of what makes the loops what they are: study, seed, solver, indices and Ivar_basis of the records
/// with status ok, and whether calibration loops are among them. Methods that are added to the campaign do
/// not change it, and it does not tell what it was made of.
std::string loops_hash(const Campaign& campaign, bool with_calibration);

/// The comment line of a CSV file that says which loops it is of.
std::string hash_line(const std::string& hash);

/// Writes a blind export into `folder`, which must be there (docs/bring_your_own.md): `loops.nc` (netCDF-4),
/// `loops.csv`, `benchmark.csv`, `context.json` and `verdicts.csv`, a form to fill in. `records` are those of
/// blind_order(). The benchmark is that of the context, or each loop has its own. With windows the study must
/// monitor. Errors: ArchiveError when a file cannot be written.
void write_blind_loops(const std::filesystem::path& folder, const Campaign& campaign,
                       const AssessmentContext& context, const BlindRecords& records,
                       const BlindParts& parts);

/// CSV with the columns `loop` and `experiment` (its index; empty: a calibration loop): the key of a blind
/// export, for whoever trains a method on it.
std::string blind_key(const Campaign& campaign, bool with_calibration);

}  // namespace mpm
