#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/basis_cases.hpp"
#include "analysis/study_files/thesis_table.hpp"
#include "solvers/qp_solver.hpp"

// The tables of the thesis, cell by cell: our number, the thesis's, and whether the same is concluded.

namespace mpm {

/// A cell of a table beside ours.
struct ReproducedCell {
  TableCell cell;
  double ours;  ///< NaN when the loop did not run to its end, or the quantity is not determined
  std::optional<std::string> our_verdict, thesis_verdict;  ///< none without a rule, or without a number

  /// Ours over the thesis's; none when one of them is missing or the thesis's is zero.
  std::optional<double> ratio() const;
  /// Both are judged, and alike; none when the thesis's cell is not judged. A number that we cannot determine
  /// does not agree.
  std::optional<bool> agrees() const;
};

struct ReproducedRow {
  std::string label;
  std::string remark;  ///< why there are no numbers; empty when there are
  std::vector<ReproducedCell> cells;
};

/// How many of the judged cells agree.
struct Agreement {
  int agreeing = 0;
  int judged = 0;

  void add(const Agreement& other);
};

struct ReproducedTable {
  ThesisTable table;
  std::vector<ReproducedRow> rows;

  Agreement agreement() const;
};

/// What the loops of a table give: for each of its rows the number of each cell, NaN as in ReproducedCell.
struct TableNumbers {
  struct Row {
    std::string remark;  ///< of ReproducedRow
    std::vector<double> ours;
  };
  std::vector<Row> rows;
};

/// Runs every loop of the table. Each study is run with its own basis case and S0, from `basis_cases`, where
/// other tables that have the study find them. Throws InputError as run_basis_case(). The table must have
/// been read with ScenarioQuantities::known().
TableNumbers table_numbers(const ThesisTable& table, const QpSolverFactory& factory, BasisCases& basis_cases);

/// Judges every cell by the rules of the table, ours and the thesis's by the same.
ReproducedTable reproduced(ThesisTable table, const TableNumbers& numbers);

/// The verdicts on the numbers of one column or row: judge(numbers)[i] for `i` of them. For any_above and
/// any_within `numbers` are those of the row that the rule is for; for rank those of the column. Entries are
/// none where there is no number.
std::vector<std::optional<std::string>> judge(const VerdictRule& rule,
                                              const std::vector<std::optional<double>>& numbers);

}  // namespace mpm
