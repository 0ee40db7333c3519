#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "results/archive/campaign.hpp"

// The loops of a campaign without the truth: for somebody who is to assess them and not to know what is
// wrong.

namespace mpm {

/// Which records of the campaign (those with status ok) are the loops 0, 1, 2, ... of its blind export: a
/// shuffle by the stream `blind_order` of the master seed (Fisher and Yates), so that the archive is the key.
std::vector<std::size_t> blind_order(const Campaign& campaign);

/// SHA-256 of what makes the loops what they are: study, seed, solver, indices and Ivar_basis of the records
/// with status ok. Methods that are added to the campaign do not change it, and it does not tell what it was
/// made of.
std::string loops_hash(const Campaign& campaign);

/// The comment line of a CSV file that says which loops it is of.
std::string hash_line(const std::string& hash);

/// Writes a blind export into `folder`, which must be there (docs/bring_your_own.md): `loops.nc` (netCDF-4),
/// `loops.csv`, `benchmark.csv`, `context.json` and `verdicts.csv`, a form to fill in. `loops` are those of
/// blind_order(). Errors: ArchiveError when a file cannot be written.
void write_blind_loops(const std::filesystem::path& folder, const Campaign& campaign,
                       const AssessmentContext& context, const std::vector<AssessedLoop>& loops);

}  // namespace mpm
