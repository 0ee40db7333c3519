#include "results/records/plant_record_file.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/record_file.hpp"
#include "results/records/sample_grid.hpp"
#include "results/records/signal_reader.hpp"
#include "results/records/stamped_rows.hpp"

namespace mpm {
namespace {

constexpr double kWorthSaying = 0.05;  // share of missing samples above which there is a warning

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

double missing_share(const Eigen::RowVectorXd& values) {
  return values.array().isNaN().cast<double>().mean();
}

/// Returns the names of columns that a file of records of this study may have.
std::vector<std::string> wanted_names(const Study& study) {
  std::vector<std::string> names;
  const auto add = [&](const std::vector<PlantModel::Variable>& variables, const char* prefix) {
    for (const PlantModel::Variable& each : variables) {
      const auto tag = study.data.tags.find(each.name);
      names.push_back(tag == study.data.tags.end() ? each.name : tag->second);
      names.push_back(fmt::format("{}.{}", prefix, each.name));
    }
  };
  add(study.plant.cvs, "y");
  add(study.plant.mvs, "u");
  add(study.plant.mds, "d");
  return names;
}

StampedRows rows_for(const Study& study, RecordColumns columns) {
  for (const std::string& name : columns.names)
    if (name.size() > kLongestCsvName)
      throw InputError(columns.file, fmt::format("a column with a name of {} bytes", name.size()),
                       fmt::format("at most {}", kLongestCsvName));
  return stamped_rows({study.data, study.controller.sample_time, study.plant.time_unit, wanted_names(study)},
                      std::move(columns));
}

class RecordReader {
 public:
  RecordReader(const Study& study, RecordColumns columns)
      : study_(study),
        data_(study.data),
        rows_(rows_for(study, std::move(columns))),
        grid_(study, rows_),
        signals_(study, rows_.file, record_.warnings) {
    record_.warnings.insert(record_.warnings.begin(), rows_.file.warnings.begin(), rows_.file.warnings.end());
    record_.stamps = grid_.stamps();
  }

  PlantRecord record() {
    const auto &cvs = study_.plant.cvs, &mvs = study_.plant.mvs, &mds = study_.plant.mds;
    record_.y = group(cvs, [&](const std::string& name) { return cv(name); });
    record_.u = group(mvs, [&](const std::string& name) { return input(name, "u"); });
    record_.d = group(mds, [&](const std::string& name) { return input(name, "d"); });
    record_.u_target = group(
        mvs, [&](const std::string& name) { return companion(name, data_.target, "target", "u_target"); });
    record_.y_set = group(
        cvs, [&](const std::string& name) { return companion(name, data_.setpoint, "setpoint", "y_set"); });
    record_.lower =
        group(cvs, [&](const std::string& name) { return companion(name, data_.lower, "lower"); });
    record_.upper =
        group(cvs, [&](const std::string& name) { return companion(name, data_.upper, "upper"); });
    record_.y_sim =
        group(cvs, [&](const std::string& name) { return companion(name, data_.y_sim, "y_sim"); });
    record_.u_off = off(mvs);
    record_.y_off = off(cvs);
    signals_.tell_unnamed();
    read_candidates();
    leave_out_without_controller();
    refuse_missing();
    if (data_.benchmark.size() == 2)
      record_.benchmark = grid_.between("benchmark", data_.benchmark);
    return std::move(record_);
  }

 private:
  /// Returns a matrix with one row per variable: of(name).
  template <class Of>
  Eigen::MatrixXd group(const std::vector<PlantModel::Variable>& variables, Of of) const {
    Eigen::MatrixXd signals(static_cast<Eigen::Index>(variables.size()), grid_.samples());
    for (std::size_t i = 0; i < variables.size(); ++i)
      signals.row(static_cast<Eigen::Index>(i)) = of(variables[i].name);
    return signals;
  }

  Eigen::RowVectorXd cv(const std::string& name) {
    const RowSignal signal = signals_.variable(name, "y");
    Eigen::RowVectorXd values = grid_.measured(signal);
    if (!signals_.on_change(name))
      return values;
    return values.array().isNaN().select(grid_.of_last_row(signals_.holding(name, "y", signal)), values);
  }

  Eigen::RowVectorXd input(const std::string& name, const char* prefix) {
    const RowSignal signal = signals_.variable(name, prefix);
    const double missing =
        missing_share(signals_.on_change(name) ? grid_.of_last_row(signals_.holding(name, prefix, signal))
                                               : grid_.measured(signal));
    refuse_missing(name, missing);
    if (missing > kWorthSaying)
      record_.warnings.push_back(
          fmt::format("{} is missing in {} of the samples and held there: say in "
                      "data.stored_on_change if it was stored only on change",
                      name, percent(missing)));
    return grid_.held(signal);
  }

  /// Reads a signal that belongs to a variable and may be left out.
  Eigen::RowVectorXd companion(const std::string& variable, const DataOptions::Names& tags, const char* key,
                               const char* exported = "") {
    const auto tag = tags.find(variable);
    const auto column = tag != tags.end() ? rows_.file.column(signals_.where(key, variable), tag->second)
                                          : rows_.file.find(fmt::format("{}.{}", exported, variable));
    const bool recorded =
        tag != tags.end() || (column && signals_.has_numbers(*column));  // exports have empty columns
    return recorded ? grid_.held(signals_.numbers(*column, variable))
                    : Eigen::RowVectorXd::Constant(grid_.samples(), kNaN);
  }

  /// Returns 1 where operators have a variable, 0 elsewhere; empty if the study names no column of modes for
  /// them.
  Eigen::MatrixXd off(const std::vector<PlantModel::Variable>& variables) {
    const auto has_mode = [this](const PlantModel::Variable& each) { return data_.mode.contains(each.name); };
    if (std::none_of(variables.begin(), variables.end(), has_mode))
      return {};
    return group(variables, [this](const std::string& name) -> Eigen::RowVectorXd {
      if (!data_.mode.contains(name))
        return Eigen::RowVectorXd::Zero(grid_.samples());
      const Eigen::RowVectorXd in_use = grid_.held(signals_.in_use(name));
      if (in_use.hasNaN())
        throw InputError(signals_.where("mode", name),
                         fmt::format("no value in '{}'", cut_utf8(data_.mode.at(name), kShownBytes)),
                         "a word of data.mode_on where the controller has " + name);
      Eigen::RowVectorXd off = (in_use.array() != 1.0).cast<double>();
      if (off.any())
        record_.warnings.push_back(fmt::format(
            "{} is off in {} of the samples, in which '{}' is none of data.mode_on ({})", name,
            percent(off.mean()), cut_utf8(data_.mode.at(name), kShownBytes), fmt::join(data_.mode_on, ", ")));
      return off;
    });
  }

  /// Reads the signals besides those of the loop. They keep their own units, because a regression uses only
  /// their moves.
  void read_candidates() {
    record_.candidate_names = data_.candidates;
    record_.candidates.resize(static_cast<Eigen::Index>(data_.candidates.size()), grid_.samples());
    for (std::size_t i = 0; i < data_.candidates.size(); ++i) {
      const std::string& name = data_.candidates[i];
      const std::size_t column = rows_.file.column(fmt::format("{}: data.candidates", rows_.file.file), name);
      const Eigen::RowVectorXd values = grid_.held(signals_.numbers(column, name));
      if ((values.array() == values(0)).all())
        throw InputError(fmt::format("{}: data.candidates: '{}'", rows_.file.file, name),
                         fmt::format("{:g} in every sample", values(0)),
                         "a signal that changes, or leave it out");
      record_.candidates.row(static_cast<Eigen::Index>(i)) = values.array() - values.mean();
    }
  }

  /// Tells at which samples the controller has no variable: its own column says so, or operators have every
  /// MV.
  Eigen::Array<bool, 1, Eigen::Dynamic> without_controller() const {
    Eigen::Array<bool, 1, Eigen::Dynamic> off =
        Eigen::Array<bool, 1, Eigen::Dynamic>::Constant(grid_.samples(), false);
    if (record_.u_off.rows() > 0)
      off = (record_.u_off.array() == 1.0).colwise().all();
    if (!data_.controller_on.empty())
      off = off || grid_.held(signals_.controller_on()).array() != 1.0;
    return off;
  }

  /// Removes the samples without the controller: they count nowhere, as if nothing had been recorded.
  void leave_out_without_controller() {
    const auto off = without_controller();
    const double share = off.cast<double>().mean();
    if (share == 1.0)
      refuse_without_controller();
    if (share == 0.0)
      return;
    record_.warnings.push_back(
        fmt::format("the controller is off in {} of the samples: they do not count, nor do the samples after "
                    "them until the slowest channel has settled",
                    percent(share)));
    Eigen::Index from = 0;
    while (off(from))
      ++from;
    for (Eigen::Index k = 0; k < grid_.samples(); ++k) {
      if (!off(k)) {
        from = k;
        continue;
      }
      record_.y.col(k).setConstant(kNaN);
      for (Eigen::MatrixXd PlantRecord::*const signals :
           {&PlantRecord::u, &PlantRecord::d, &PlantRecord::u_target, &PlantRecord::y_set,
            &PlantRecord::lower, &PlantRecord::upper, &PlantRecord::u_off, &PlantRecord::y_off})
        if (Eigen::MatrixXd& values = record_.*signals; values.size() > 0)
          values.col(k) = values.col(from);
    }
  }

  [[noreturn]] void refuse_without_controller() const {
    if (data_.controller_on.empty())
      throw InputError(rows_.file.file + ": data.mode", "no row in which the controller has an MV",
                       fmt::format("a period with one of data.mode_on: {}", fmt::join(data_.mode_on, ", ")));
    const std::size_t column = rows_.file.column("", data_.controller_on);
    throw InputError(
        rows_.file.file + ": data.controller_on",
        fmt::format("'{}' throughout", cut_utf8(rows_.file.columns[column].front(), kShownBytes)),
        fmt::format("a period with one of data.on_values: {}", fmt::join(data_.on_values, ", ")));
  }

  void refuse_missing(const std::string& name, double missing) const {
    const bool unit_known = rows_.calendar || data_.time_unit == study_.plant.time_unit;
    if (missing > data_.most_missing)
      throw InputError(
          fmt::format("{}: {}", rows_.file.file, name),
          fmt::format("{} of its samples missing", percent(missing)),
          fmt::format("at most {} (data.most_missing): choose another period (data.period), export a value "
                      "at least every {:g} {}, name it in data.stored_on_change if it was stored only on "
                      "change, or raise data.most_missing{}",
                      percent(data_.most_missing), study_.controller.sample_time, study_.plant.time_unit,
                      unit_known
                          ? ""
                          : fmt::format("; stamps that are numbers count as {}: data.time_unit",
                                        data_.time_unit.empty() ? study_.plant.time_unit : data_.time_unit)));
  }

  void refuse_missing() {
    for (Eigen::Index cv = 0; cv < record_.y.rows(); ++cv) {
      const std::string& name = study_.plant.cvs[static_cast<std::size_t>(cv)].name;
      const double missing = missing_share(record_.y.row(cv));
      refuse_missing(name, missing);
      if (missing > kWorthSaying)
        record_.warnings.push_back(
            fmt::format("{} is missing in {} of the samples: methods that need every sample do not apply",
                        name, percent(missing)));
    }
  }

  const Study& study_;
  const DataOptions& data_;
  PlantRecord record_;
  StampedRows rows_;
  SampleGrid grid_;
  SignalReader signals_;
};

}  // namespace

PlantRecord read_plant_record(const Study& study, std::string_view text, const std::string& file) {
  return RecordReader(study, csv_record_columns(text, file, study.data)).record();
}

PlantRecord load_plant_record(const Study& study, const std::filesystem::path& path) {
  return RecordReader(study, load_record_columns(path, study.data)).record();
}

}  // namespace mpm
