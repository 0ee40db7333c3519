#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// The way in which a number of a table becomes a verdict.
enum class RuleKind {
  outside,     ///< the number is outside the band
  any_above,   ///< at least one number of the row to which the rule applies is above the threshold
  any_within,  ///< at least one number of the row to which the rule applies lies within the band
  rank,        ///< its rank among the rows, with the smallest number of the column first
};

/// A rule for verdicts on quantities of a table, and the names of the verdicts.
struct VerdictRule {
  std::vector<std::string> quantities;
  RuleKind kind = RuleKind::outside;
  double lower = 0.0, upper = 0.0;  ///< the band; of any_above the threshold is `lower`
  std::string yes, no;              ///< the two verdicts, such as "flagged" and "not flagged"
  std::string source;               ///< the place in the thesis
};

/// The object to which a quantity belongs.
enum class QuantityScope { loop, cv, channel };

/// A quantity that a cell may have.
struct TableQuantity {
  std::string name;
  QuantityScope scope = QuantityScope::cv;
};

/// One cell of a table: a quantity in one scenario, and its value in the thesis.
struct TableCell {
  std::string cv;  ///< empty for a quantity of the loop
  std::string quantity;
  std::optional<double> thesis = {};        ///< its number, or
  std::optional<std::string> verdict = {};  ///< its verdict in words; an empty cell has neither
  std::string mv = {};                      ///< for a quantity of a channel
};

/// One row: the loop of one scenario under one variant of the study.
struct TableRow {
  std::string label;
  std::string variant;   ///< if empty, the study as it is
  std::string scenario;  ///< the scenario of the study; if empty, the basis case
  std::vector<TableCell> cells;
  /// The variant whose basis case is the benchmark of methods that need one (default: `variant`).
  std::optional<std::string> benchmark = {};
};

/// A table of the thesis, or a figure that it describes in words, and the study that reproduces it.
struct ThesisTable {
  std::string number;   ///< "4.5"
  bool figure = false;  ///< figures and tables have numbers of their own
  int chapter = 0;
  std::string title;
  std::string note;  ///< choices made for numbers that the thesis does not give; may be empty
  std::map<std::string, Study> studies;  ///< by the name of the variant; "" is the study as it is
  std::vector<std::string> heads;        ///< of the columns
  std::vector<TableRow> rows;
  std::vector<VerdictRule> rules;

  /// Returns "Table 4.5" or "Figure 2.8", for example.
  std::string label() const;
  /// Returns the name for the command line: "4.5" or "figure2.8", for example.
  std::string name() const;

  /// Returns the rule for a quantity; null if its numbers are only compared.
  const VerdictRule* rule_for(const std::string& quantity) const;
};

}  // namespace mpm
