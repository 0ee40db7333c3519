#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/reproduction/table_reproduction.hpp"

// The same table with several seeds: it shows which verdicts depend on the loop, and which on its noise.

namespace mpm {

/// A cell of a table over the seeds.
struct SeededCell {
  TableCell cell;
  std::optional<std::string> thesis_verdict;  ///< none if the thesis's cell is not judged
  double median;                ///< of our numbers, over the seeds with a number; NaN if none has one
  int numbers = 0;              ///< number of seeds with a number
  std::optional<double> share;  ///< share of all seeds whose verdict agrees; none if not judged
};

struct SeededRow {
  std::string label;
  std::string remark;  ///< the first remark of a seed, with the number of seeds that have one; empty if none
  std::vector<SeededCell> cells;
};

/// A table over the seeds.
struct SeededTable {
  ThesisTable table;
  std::vector<SeededRow> rows;
  std::vector<int> agreeing;  ///< number of verdicts that agree, for each seed
  int judged = 0;             ///< number of verdicts that are judged

  /// Returns the mean over the seeds of the number of verdicts that agree, which is the sum of all shares.
  double mean_agreeing() const;
};

/// Returns the table with the seeds of its studies raised by `offset`.
ThesisTable with_seed_offset(ThesisTable table, std::uint64_t offset);

/// Combines `runs`, the same table with one seed each. There must be at least one.
SeededTable over_seeds(const std::vector<ReproducedTable>& runs);

}  // namespace mpm
