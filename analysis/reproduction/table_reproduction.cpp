#include "analysis/reproduction/table_reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "analysis/reproduction/scenario_quantities.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

using Numbers = std::vector<std::optional<double>>;
using Verdicts = std::vector<std::optional<std::string>>;

std::optional<double> number_or_none(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// The loops of a table. Each scenario is run only once.
class Loops {
 public:
  Loops(const ThesisTable& table, const QpSolverFactory& factory, BasisCases& basis_cases)
      : table_(table), factory_(factory), basis_cases_(basis_cases) {}

  /// Returns the loop of this row; null, with a remark, if the basis case did not run to its end.
  ScenarioQuantities* of(const TableRow& row, std::string& remark) {
    const Study& study = table_.studies.at(row.variant);
    const BasisCase& basis = basis_cases_.of(study);
    if (basis.trajectory.status != ControlStatus::ok) {
      remark = basis.explanation;
      return nullptr;
    }
    const std::string& benchmark = row.benchmark.value_or(row.variant);
    std::unique_ptr<ScenarioQuantities>& loop = loops_[{row.variant, row.scenario, benchmark}];
    if (!loop)
      loop = std::make_unique<ScenarioQuantities>(study, basis, draw_of(study, row.scenario), factory_,
                                                  benchmark_of(benchmark));
    if (loop->status() != ControlStatus::ok)
      remark = fmt::format("the loop is {}", to_string(loop->status()));
    return loop.get();
  }

 private:
  /// Returns the basis case of a variant; none if it did not run to its end.
  std::optional<AssessedLoop> benchmark_of(const std::string& variant) {
    const Study& study = table_.studies.at(variant);
    const BasisCase& basis = basis_cases_.of(study);
    if (basis.trajectory.status != ControlStatus::ok)
      return std::nullopt;
    return assessed_loop(study, basis.point, basis.trajectory);
  }

  static ExperimentDraw draw_of(const Study& study, const std::string& scenario) {
    for (std::size_t i = 0; i < study.scenarios.size(); ++i)
      if (study.scenarios[i].name == scenario)
        return draw_experiment(study, static_cast<std::int64_t>(i));
    return basis_draw();
  }

  const ThesisTable& table_;
  const QpSolverFactory& factory_;
  BasisCases& basis_cases_;
  /// By variant, scenario and benchmark.
  std::map<std::tuple<std::string, std::string, std::string>, std::unique_ptr<ScenarioQuantities>> loops_;
};

/// Returns the place of a name in `variables`; -1 if the cell has no name.
Eigen::Index place(const std::vector<PlantModel::Variable>& variables, const std::string& name) {
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].name == name)
      return static_cast<Eigen::Index>(i);
  return -1;
}

/// The cells that one rule judges together.
using Group = std::vector<ReproducedCell*>;

void judge_group(const VerdictRule& rule, const Group& group) {
  Numbers ours, thesis;
  for (const ReproducedCell* cell : group) {
    ours.push_back(number_or_none(cell->ours));
    thesis.push_back(cell->cell.thesis);
  }
  const Verdicts our_verdicts = judge(rule, ours);
  const Verdicts thesis_verdicts = judge(rule, thesis);
  for (std::size_t i = 0; i < group.size(); ++i) {
    group[i]->our_verdict = our_verdicts[i];
    group[i]->thesis_verdict = group[i]->cell.verdict ? group[i]->cell.verdict : thesis_verdicts[i];
  }
}

void judge_table(ReproducedTable& result) {
  for (const VerdictRule& rule : result.table.rules) {
    const auto judged = [&](const ReproducedCell& cell) {
      return result.table.rule_for(cell.cell.quantity) == &rule;
    };
    if (rule.kind == RuleKind::rank) {
      for (std::size_t column = 0; column < result.table.heads.size(); ++column) {
        Group group;
        for (ReproducedRow& row : result.rows)
          if (judged(row.cells[column]))
            group.push_back(&row.cells[column]);
        judge_group(rule, group);
      }
      continue;
    }
    for (ReproducedRow& row : result.rows) {
      Group group;
      for (ReproducedCell& cell : row.cells)
        if (judged(cell))
          group.push_back(&cell);
      judge_group(rule, group);
    }
  }
}

Verdicts judge_any(const VerdictRule& rule, const Numbers& numbers) {
  const bool any = std::any_of(numbers.begin(), numbers.end(), [&](const std::optional<double>& number) {
    return number && *number > rule.lower && (rule.kind == RuleKind::any_above || *number < rule.upper);
  });
  Verdicts verdicts;
  for (const std::optional<double>& number : numbers)
    verdicts.push_back(number ? std::optional(any ? rule.yes : rule.no) : std::nullopt);
  return verdicts;
}

Verdicts judge_rank(const Numbers& numbers) {
  Verdicts verdicts;
  for (const std::optional<double>& number : numbers) {
    const auto smaller = std::count_if(numbers.begin(), numbers.end(), [&](const auto& other) {
      return number && other && *other < *number;
    });
    verdicts.push_back(number ? std::optional(fmt::format("{}", smaller + 1)) : std::nullopt);
  }
  return verdicts;
}

Verdicts judge_each(const VerdictRule& rule, const Numbers& numbers) {
  Verdicts verdicts;
  for (const std::optional<double>& number : numbers)
    verdicts.push_back(number
                           ? std::optional(*number < rule.lower || *number > rule.upper ? rule.yes : rule.no)
                           : std::nullopt);
  return verdicts;
}

}  // namespace

std::optional<double> ReproducedCell::ratio() const {
  if (!cell.thesis || *cell.thesis == 0.0 || std::isnan(ours))
    return std::nullopt;
  return ours / *cell.thesis;
}

std::optional<bool> ReproducedCell::agrees() const {
  return thesis_verdict ? std::optional(our_verdict == thesis_verdict) : std::nullopt;
}

void Agreement::add(const Agreement& other) {
  agreeing += other.agreeing;
  judged += other.judged;
}

Agreement ReproducedTable::agreement() const {
  Agreement total;
  for (const ReproducedRow& row : rows)
    for (const ReproducedCell& cell : row.cells)
      if (const std::optional<bool> agrees = cell.agrees())
        total.add({*agrees ? 1 : 0, 1});
  return total;
}

std::vector<std::optional<std::string>> judge(const VerdictRule& rule,
                                              const std::vector<std::optional<double>>& numbers) {
  switch (rule.kind) {
    case RuleKind::any_above:
    case RuleKind::any_within:
      return judge_any(rule, numbers);
    case RuleKind::rank:
      return judge_rank(numbers);
    case RuleKind::outside:
      break;
  }
  return judge_each(rule, numbers);
}

TableNumbers table_numbers(const ThesisTable& table, const QpSolverFactory& factory,
                           BasisCases& basis_cases) {
  TableNumbers numbers;
  Loops loops(table, factory, basis_cases);
  for (const TableRow& row : table.rows) {
    TableNumbers::Row& found = numbers.rows.emplace_back();
    ScenarioQuantities* const loop = loops.of(row, found.remark);
    const Study& study = table.studies.at(row.variant);
    for (const TableCell& cell : row.cells)
      found.ours.push_back(
          loop ? loop->value(cell.quantity, place(study.plant.cvs, cell.cv), place(study.plant.mvs, cell.mv))
               : kNaN);
  }
  return numbers;
}

ReproducedTable reproduced(ThesisTable table, const TableNumbers& numbers) {
  ReproducedTable result{std::move(table), {}};
  for (std::size_t r = 0; r < result.table.rows.size(); ++r) {
    const TableRow& row = result.table.rows[r];
    ReproducedRow& judged = result.rows.emplace_back(ReproducedRow{row.label, numbers.rows[r].remark, {}});
    for (std::size_t c = 0; c < row.cells.size(); ++c)
      judged.cells.push_back({row.cells[c], numbers.rows[r].ours[c], {}, {}});
  }
  judge_table(result);
  return result;
}

}  // namespace mpm
