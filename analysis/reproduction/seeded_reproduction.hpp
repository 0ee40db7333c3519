#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"

// The same table with several seeds: which verdicts are those of the loop, and which those of its noise.

namespace mpm {

/// A cell of a table over the seeds.
struct SeededCell {
  TableCell cell;
  std::optional<std::string> thesis_verdict;  ///< none when the thesis's cell is not judged
  double median;                ///< of ours, over the seeds that have a number; NaN when none has
  int numbers = 0;              ///< how many have one
  std::optional<double> share;  ///< of all seeds, those whose verdict agrees; none when it is not judged
};

struct SeededRow {
  std::string label;
  std::string remark;  ///< the first one of a seed, and how many have one; empty when none has
  std::vector<SeededCell> cells;
};

/// A table over the seeds.
struct SeededTable {
  ThesisTable table;
  std::vector<SeededRow> rows;
  std::vector<int> agreeing;  ///< verdicts that agree, one number a seed
  int judged = 0;             ///< of as many

  /// How many agree on average over the seeds: the sum of all shares.
  double mean_agreeing() const;
};

/// The table with the seeds of its studies raised by `offset`.
ThesisTable with_seed_offset(ThesisTable table, std::uint64_t offset);

/// What `runs`, the same table with one seed each, have in common. There must be one or more.
SeededTable over_seeds(const std::vector<ReproducedTable>& runs);

}  // namespace mpm
