#include "results/records/data_sketch.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/monitored_loop.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/signal_look.hpp"
#include "analysis/validation/benchmark_period.hpp"
#include "base/non_finite.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/implausible_values.hpp"
#include "results/records/opc_quality.hpp"
#include "results/records/quality_columns.hpp"
#include "results/records/stamped_rows.hpp"
#include "scenarios/toml/nearest_name.hpp"
#include "scenarios/toml/toml_literal.hpp"

namespace mpm {
namespace {

/// Tells whether the word occurs in the name with no letter or digit beside it, as "f" in "fi_f" but not in
/// "flow".
bool has_word(const std::string& name, const std::string& word) {
  const auto is_border = [&](std::size_t at) {
    return at >= name.size() || std::isalnum(static_cast<unsigned char>(name[at])) == 0;
  };
  for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1))
    if ((at == 0 || is_border(at - 1)) && is_border(at + word.size()))
      return true;
  return false;
}

/// Tells whether the name is one of a mode or a quality: "fc11.mode", "fc11_quality".
bool says_mode_or_quality(const std::string& name) {
  static constexpr std::array<std::string_view, 6> kWords{"mode", "quality", "status", "qual", "q", "qc"};
  const std::size_t last = name.find_last_of("._ -/:");
  return last != std::string::npos &&
         std::find(kWords.begin(), kWords.end(), std::string_view(name).substr(last + 1)) != kWords.end();
}

/// Writes a name as a key of TOML.
std::string key_of(const std::string& name) {
  const bool bare = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
  });
  return bare && !name.empty() ? name : toml_literal(name);
}

/// Writes a foreign text so that it stays on one comment line.
std::string in_comment(const std::string& text) {
  std::string shown = plain_text(cut_utf8(text, 4 * kShownBytes));
  std::replace(shown.begin(), shown.end(), '\n', ' ');
  return shown;
}

std::string three_digits(double value) {
  return fmt::format("{:.3g}", value);
}

/// Returns the values of a column without those of bad quality and those that cannot be measurements.
std::vector<double> measured_values(const RecordColumns& file, std::size_t column) {
  const std::vector<std::string>& cells = file.columns[column];
  std::vector<double> values(cells.size(), kNaN);
  for (std::size_t row = 0; row < cells.size(); ++row)
    values[row] = file.number(cells[row]).value_or(kNaN);
  if (const auto quality = quality_column_of(file, column); quality && are_qualities(file, *quality)) {
    const OpcCodes codes = opc_codes(file, *quality);
    for (std::size_t row = 0; row < cells.size(); ++row)
      if (const std::string& cell = file.columns[*quality][row];
          !cell.empty() && !is_good_opc(file, cell, codes))
        values[row] = kNaN;
  }
  for (const std::size_t row : implausible_rows(values, -kInfinity, kInfinity, true))
    values[row] = kNaN;
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }),
               values.end());
  return values;
}

/// Statistics of the numbers of a column.
struct ColumnLook : SignalLook {
  ColumnLook(const RecordColumns& file, std::size_t column) : SignalLook(measured_values(file, column)) {}

  std::string rests() const {
    constexpr double kMost = 0.5;
    if (highest <= lowest)
      return "it never moves in the file";
    for (const bool upper : {true, false})
      if (const double share = share_at(upper); share > kMost)
        return fmt::format(
            "{:.0f} % of its values lie in the {} tenth of its range in the file ({} to {}), so the cost "
            "seems to be {}",
            100.0 * share, upper ? "upper" : "lower", three_digits(lowest), three_digits(highest),
            upper ? "negative" : "positive");
    return "it stays near neither end of its range in the file, so the sign of the cost is unknown";
  }

  std::string words() const {
    constexpr double kMeasured = 0.5;
    if (values.empty())
      return "no numbers";
    if (highest <= lowest)
      return fmt::format("always {}", three_digits(lowest));
    return fmt::format("{} to {}, mean {}, {}", three_digits(lowest), three_digits(highest),
                       three_digits(mean),
                       changes > kMeasured
                           ? "moves nearly always: measured (a CV or an MD), or an MV"
                           : fmt::format("moves in {:.2g} % of the rows: a setpoint, a limit, an MV or an MD",
                                         100.0 * changes));
  }
};

class DataSketcher {
 public:
  DataSketcher(const PlantModel& plant, StampedRows rows) : plant_(plant), rows_(std::move(rows)) {}

  DataSketch sketch() {
    for (const auto* list : {&plant_.cvs, &plant_.mvs, &plant_.mds})
      for (const PlantModel::Variable& variable : *list)
        find_column(variable.name, list == &plant_.mvs);
    sketch_.file = file().file;
    sketch_.step = step();
    write_table();
    look_at_variables();
    return std::move(sketch_);
  }

 private:
  const RecordColumns& file() const { return rows_.file; }

  /// Finds a column by the variable's name, by that name as the export writes it, as a part of a heading, or
  /// by the nearest heading.
  void find_column(const std::string& variable, bool is_mv) {
    std::optional<std::size_t> found = file().find(variable);
    for (const char* prefix : {"y", "u", "d"})
      if (!found)
        found = file().find(fmt::format("{}.{}", prefix, variable));
    if (!found)
      found = only_column_with(variable, is_mv);
    if (const std::string nearest = nearest_name(variable, file().names); !found && !nearest.empty())
      found = file().find(nearest);
    if (found && std::find(taken_.begin(), taken_.end(), *found) == taken_.end()) {
      taken_.push_back(*found);
      columns_.emplace_back(variable, *found);
      looks_.emplace(*found, ColumnLook(file(), *found));
    } else {
      missing_.push_back(variable);
    }
  }

  /// Returns the only column that has the variable as a word of its heading ("FI_F"), or else anywhere in it.
  /// Of several columns, takes the measurement (PV), or for an MV the output of the controller (SP, OP).
  /// Columns of modes and qualities do not count.
  std::optional<std::size_t> only_column_with(const std::string& variable, bool is_mv) const {
    static constexpr std::array kOfMv{"sp", "op", "out", "pv"}, kOfOthers{"pv", "val", "value", "av"};
    std::vector<std::size_t> as_word, anywhere;
    const std::string sought = in_lower_case(variable);
    for (std::size_t column = 0; column < file().names.size(); ++column) {
      const std::string name = in_lower_case(file().names[column]);
      if (name.find(sought) == std::string::npos || says_mode_or_quality(name))
        continue;
      if (has_word(name, sought))
        as_word.push_back(column);
      anywhere.push_back(column);
    }
    for (const auto* found : {&as_word, &anywhere})
      if (found->size() == 1)
        return found->front();
    for (const char* ending : is_mv ? kOfMv : kOfOthers) {
      std::vector<std::size_t> so_called;
      std::copy_if(anywhere.begin(), anywhere.end(), std::back_inserter(so_called),
                   [&](std::size_t column) { return ends_with(column, ending); });
      if (so_called.size() == 1)
        return so_called.front();
    }
    return std::nullopt;
  }

  double step() const {
    if (!rows_.stamped)
      return 0.0;
    std::vector<double> steps;
    for (std::size_t row = 1; row < rows_.times.size(); ++row)
      if (rows_.times[row] > rows_.times[row - 1])
        steps.push_back(rows_.times[row] - rows_.times[row - 1]);
    if (steps.empty())
      return 0.0;
    const std::optional<double> stamp_days = days_in(rows_.unit), plant_days = days_in(plant_.time_unit);
    return upper_median(std::move(steps)) * (stamp_days && plant_days ? *stamp_days / *plant_days : 1.0);
  }

  void line(const std::string& text) { sketch_.table += text + "\n"; }

  /// Writes KEY = {variable = value of its column, ...}.
  template <class Of>
  std::string assigned(const char* key, Of of) const {
    std::vector<std::string> pairs;
    for (const auto& [variable, column] : columns_)
      if (const std::optional<std::string> value = of(column))
        pairs.push_back(fmt::format("{} = {}", key_of(variable), *value));
    return pairs.empty() ? "" : fmt::format("{} = {{{}}}", key, fmt::join(pairs, ", "));
  }

  void write_table() {
    line("[data]");
    line(fmt::format("# From {}: {} rows{}. Whatever stands here is a first guess: look at each.",
                     in_comment(file().file), file().rows(),
                     sketch_.step > 0.0
                         ? fmt::format(", one every {} {}", three_digits(sketch_.step), plant_.time_unit)
                         : ""));
    for (const std::string& warning : file().warnings)
      line(fmt::format("# Note: {}.", in_comment(warning)));
    if (rows_.stamped && rows_.times.size() > 1) {
      line("# Guess: the whole file.");
      line(fmt::format("period = [{}, {}]", toml_literal(rows_.text(rows_.times.front())),
                       toml_literal(rows_.text(rows_.times.back()))));
    }
    write_benchmark();
    if (!columns_.empty()) {
      line("# Guess: columns whose names are alike.");
      line(assigned("tags", [&](std::size_t column) { return toml_literal(file().names[column]); }));
      write_operating_point();
      write_setpoints();
      write_modes();
      write_qualities();
    }
    for (const std::string& variable : missing_)
      line(fmt::format("# To do: no column has a name like {}: add it to tags.", in_comment(variable)));
    write_others();
  }

  /// Writes, as a comment, the quarter of the file in which the CVs vary least and every MV moves. Only
  /// people know whether the controller worked as designed there.
  void write_benchmark() {
    constexpr Eigen::Index kFewestRows = 60;
    const auto rows = static_cast<Eigen::Index>(rows_.times.size());
    if (!rows_.stamped || rows / kBenchmarkShare < kFewestRows)
      return;
    const auto [first, end] =
        quietest_period(numbers_of(plant_.cvs), numbers_of(plant_.mvs), rows / kBenchmarkShare);
    if (first == end)
      return;
    line(
        "# With a period of this plant in which its controller worked as designed, what the plant always "
        "does is");
    line("# its habit and no fault. Without one, a background that never stops counts as a disturbance.");
    line(
        "# Guess: the quarter of the file in which the CVs vary least and every MV moves. If you know that "
        "it was");
    line("# good, take the # away; `assess` says in which quarter the model is best.");
    line(fmt::format("# benchmark = [{}, {}]",
                     toml_literal(rows_.text(rows_.times[static_cast<std::size_t>(first)])),
                     toml_literal(rows_.text(rows_.times[static_cast<std::size_t>(end - 1)]))));
  }

  /// Returns the columns of those variables that have one, one row each; NaN if a cell has no number.
  Eigen::MatrixXd numbers_of(const std::vector<PlantModel::Variable>& variables) const {
    Eigen::MatrixXd numbers(static_cast<Eigen::Index>(variables.size()),
                            static_cast<Eigen::Index>(file().rows()));
    Eigen::Index count = 0;
    for (const auto& [name, column] : columns_) {
      if (std::none_of(variables.begin(), variables.end(),
                       [of = name](const PlantModel::Variable& variable) { return variable.name == of; }))
        continue;
      for (std::size_t row = 0; row < file().rows(); ++row)
        numbers(count, static_cast<Eigen::Index>(row)) =
            file().number(file().columns[column][row]).value_or(kNaN);
      ++count;
    }
    return numbers.topRows(count);
  }

  void write_operating_point() {
    bool deviations = true;
    for (const auto& [variable, column] : columns_) {
      const ColumnLook& look = looks_.at(column);
      deviations = deviations && std::abs(look.mean) <= look.deviation;
    }
    line(deviations ? "# Guess: the values are deviations already, because each mean is within one standard "
                      "deviation of 0. If not:"
                    : "# Guess: the means of the file; right only if the plant was at its operating point on "
                      "average.");
    line((deviations ? "# " : "") + assigned("operating_point", [&](std::size_t column) {
           return fmt::format("{:.6g}", looks_.at(column).mean);
         }));
  }

  /// Returns the heading of column_beside().
  std::optional<std::string> beside(std::size_t column, const std::string& ending) const {
    const auto found = column_beside(file(), column, ending);
    return found ? std::optional(toml_literal(file().names[*found])) : std::nullopt;
  }

  bool ends_with(std::size_t column, const std::string& ending) const {
    return in_lower_case(file().names[column]).ends_with(ending);
  }

  void write_setpoints() {
    const std::string text = assigned("setpoint", [&](std::size_t column) {
      return ends_with(column, "pv") ? beside(column, "SP") : std::nullopt;
    });
    if (text.empty())
      return;
    line("# Guess: the setpoints of the time.");
    line(text);
  }

  /// Writes the modes of CVs and MVs: FC11.MODE beside FC11.SP, FC11.OP or FC11.PV.
  void write_modes() {
    const std::string text = assigned("mode", [&](std::size_t column) {
      const bool is_tag = ends_with(column, ".sp") || ends_with(column, ".op") || ends_with(column, ".pv");
      return is_tag && !is_md(column) ? beside(column, "MODE") : std::nullopt;
    });
    if (text.empty())
      return;
    line("# Guess: whether the controller has the variable; the words for yes are in mode_on.");
    line(text);
  }

  void write_qualities() {
    const std::string text = assigned("quality", [&](std::size_t column) -> std::optional<std::string> {
      const auto quality = quality_column_of(file(), column);
      return quality && are_qualities(file(), *quality) ? std::optional(toml_literal(file().names[*quality]))
                                                        : std::nullopt;
    });
    if (text.empty())
      return;
    line("# Guess: the quality of each value; the words for a good one are in good_quality.");
    line(text);
  }

  bool is_md(std::size_t column) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const auto& of) {
      return of.second == column &&
             std::any_of(plant_.mds.begin(), plant_.mds.end(),
                         [&](const PlantModel::Variable& md) { return md.name == of.first; });
    });
  }

  void write_others() {
    constexpr std::size_t kMostShown = 100;
    std::size_t shown = 0;
    for (std::size_t column = 0; column < file().names.size() && shown < kMostShown; ++column) {
      if (std::find(taken_.begin(), taken_.end(), column) != taken_.end())
        continue;
      const ColumnLook look(file(), column);
      if (look.values.empty())
        continue;
      line(fmt::format("{}#   {}: {}", shown++ == 0 ? "# Columns that no variable has:\n" : "",
                       in_comment(file().names[column]), look.words()));
    }
  }

  void look_at_variables() {
    for (const auto& [variable, column] : columns_) {
      const ColumnLook& look = looks_.at(column);
      const auto is = [&, name = variable](const std::vector<PlantModel::Variable>& list) {
        return std::any_of(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
      };
      if (look.values.empty())
        continue;
      sketch_.spread[variable] = look.deviation;
      if (is(plant_.cvs))
        sketch_.noise[variable] = look.noise();
      if (const std::optional<std::size_t> period = look.period(); period && !is(plant_.mvs))
        sketch_.periods[variable] = *period;
      if (is(plant_.mvs))
        sketch_.rests[variable] = look.rests();
    }
  }

  const PlantModel& plant_;
  StampedRows rows_;
  DataSketch sketch_;
  std::vector<std::size_t> taken_;
  std::vector<std::pair<std::string, std::size_t>> columns_;  ///< variables that have a column, and its place
  std::map<std::size_t, ColumnLook> looks_;                   ///< statistics of these columns
  std::vector<std::string> missing_;
};

}  // namespace

DataSketch data_sketch(const PlantModel& plant, RecordColumns file) {
  const DataOptions none;
  std::vector<std::string> names;
  for (const auto* list : {&plant.cvs, &plant.mvs, &plant.mds})
    for (const PlantModel::Variable& variable : *list)
      names.push_back(variable.name);
  return DataSketcher(plant, stamped_rows({none, 1.0, plant.time_unit, names}, std::move(file))).sketch();
}

}  // namespace mpm
