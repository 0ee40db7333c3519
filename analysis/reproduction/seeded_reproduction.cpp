#include "analysis/reproduction/seeded_reproduction.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

SeededCell cell_over_seeds(const std::vector<ReproducedTable>& runs, std::size_t row, std::size_t column) {
  const ReproducedCell& first = runs.front().rows[row].cells[column];
  std::vector<double> numbers;
  int agreeing = 0;
  for (const ReproducedTable& run : runs) {
    const ReproducedCell& cell = run.rows[row].cells[column];
    if (!std::isnan(cell.ours))
      numbers.push_back(cell.ours);
    agreeing += cell.agrees() == true ? 1 : 0;
  }
  std::sort(numbers.begin(), numbers.end());
  SeededCell result{first.cell, first.thesis_verdict, kNaN, static_cast<int>(numbers.size()), std::nullopt};
  if (!numbers.empty())
    result.median = sorted_quantile(numbers, 0.5);
  if (first.thesis_verdict)
    result.share = static_cast<double>(agreeing) / static_cast<double>(runs.size());
  return result;
}

std::string remark_over_seeds(const std::vector<ReproducedTable>& runs, std::size_t row) {
  std::string first;
  int count = 0;
  for (const ReproducedTable& run : runs) {
    const std::string& remark = run.rows[row].remark;
    if (remark.empty())
      continue;
    ++count;
    if (first.empty())
      first = remark;
  }
  return count == 0 ? "" : fmt::format("{} of {} seeds: {}", count, runs.size(), first);
}

}  // namespace

double SeededTable::mean_agreeing() const {
  return static_cast<double>(std::accumulate(agreeing.begin(), agreeing.end(), 0)) /
         static_cast<double>(agreeing.size());
}

ThesisTable with_seed_offset(ThesisTable table, std::uint64_t offset) {
  for (auto& [variant, study] : table.studies)
    study.seed += offset;
  return table;
}

SeededTable over_seeds(const std::vector<ReproducedTable>& runs) {
  assert(!runs.empty());
  SeededTable result{runs.front().table, {}, {}, runs.front().agreement().judged};
  for (const ReproducedTable& run : runs)
    result.agreeing.push_back(run.agreement().agreeing);
  for (std::size_t row = 0; row < runs.front().rows.size(); ++row) {
    SeededRow seeded{runs.front().rows[row].label, remark_over_seeds(runs, row), {}};
    for (std::size_t column = 0; column < runs.front().rows[row].cells.size(); ++column)
      seeded.cells.push_back(cell_over_seeds(runs, row, column));
    result.rows.push_back(std::move(seeded));
  }
  return result;
}

}  // namespace mpm
