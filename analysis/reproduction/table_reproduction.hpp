#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/basis_cases.hpp"
#include "analysis/study_files/thesis_table.hpp"
#include "solvers/qp_solver.hpp"

// The tables of the thesis, cell by cell: our number, that of the thesis, and whether both lead to the same
// verdict.

namespace mpm {

/// A cell of a table of the thesis, with our number.
struct ReproducedCell {
  TableCell cell;
  double ours;  ///< NaN if the loop did not run to its end, or if the quantity is not determined
  std::optional<std::string> our_verdict, thesis_verdict;  ///< none if there is no rule or no number

  /// Returns our number divided by that of the thesis; none if either is missing or that of the thesis is
  /// zero.
  std::optional<double> ratio() const;
  /// Returns whether our verdict equals that of the thesis; none if the thesis's cell is not judged. A number
  /// that we cannot determine does not agree.
  std::optional<bool> agrees() const;
};

struct ReproducedRow {
  std::string label;
  std::string remark;  ///< why there are no numbers; empty if there are
  std::vector<ReproducedCell> cells;
};

/// The number of judged cells, and how many of them agree.
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

/// The results of the loops of a table: for each row the number of each cell, NaN as in ReproducedCell.
struct TableNumbers {
  struct Row {
    std::string remark;  ///< as in ReproducedRow
    std::vector<double> ours;
  };
  std::vector<Row> rows;
};

/// Runs every loop of the table. Each study has its own basis case and S0 from `basis_cases`, where other
/// tables with the same study find them again. Throws InputError as run_basis_case(). The table must have
/// been read with ScenarioQuantities::known().
TableNumbers table_numbers(const ThesisTable& table, const QpSolverFactory& factory, BasisCases& basis_cases);

/// Judges every cell by the rules of the table, which are the same for our number and that of the thesis.
ReproducedTable reproduced(ThesisTable table, const TableNumbers& numbers);

/// Returns the verdicts on the numbers of one column or row, in the order of `numbers`. For any_above and
/// any_within, `numbers` are those of the row to which the rule applies; for rank, those of the column. A
/// verdict is none if there is no number.
std::vector<std::optional<std::string>> judge(const VerdictRule& rule,
                                              const std::vector<std::optional<double>>& numbers);

}  // namespace mpm
