#include "results/records/plant_record_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/monitored_loop.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/csv_columns.hpp"
#include "results/records/implausible_values.hpp"
#include "results/records/netcdf_columns.hpp"
#include "results/records/record_columns.hpp"
#include "results/records/time_stamps.hpp"

namespace mpm {
namespace {

constexpr double kMostSamples = 1e6;
constexpr double kWorthSaying = 0.05;  // share of missing samples
constexpr double kSecondsOfHour = 3600.0;
constexpr std::size_t kWordsShown = 5;  // of a quality

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_one_of(const std::string& cell, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [cell = in_lower_case(cell)](const std::string& word) {
    return in_lower_case(word) == cell;
  });
}

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

std::string cut_name(const std::string& text) {
  return std::string(cut_utf8(text, kShownBytes));
}

/// What the names of a DataOptions group say of a variable; none: nothing.
template <class Value>
std::optional<Value> named(const std::map<std::string, Value>& group, const std::string& variable) {
  const auto found = group.find(variable);
  return found == group.end() ? std::nullopt : std::optional(found->second);
}

/// A signal of the file on its own time stamps.
using Signal = std::vector<double>;

class RecordReader {
 public:
  RecordReader(const Study& study, RecordColumns columns)
      : study_(study), data_(study.data), file_(std::move(columns)) {
    require_names();
    read_times();
    choose_samples();
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
    read_candidates();
    leave_out_without_controller();
    refuse_missing();
    if (data_.benchmark.size() == 2)
      record_.benchmark = samples_between("benchmark", data_.benchmark);
    return std::move(record_);
  }

 private:
  void require_names() const {
    for (const std::string& name : file_.names)
      if (name.size() > kLongestCsvName)
        throw InputError(file_.file, fmt::format("a column with a name of {} bytes", name.size()),
                         fmt::format("at most {}", kLongestCsvName));
  }

  // --- Cells ---

  std::string where(const std::string& key, const std::string& variable) const {
    return fmt::format("{}: data.{}.{}", file_.file, key, variable);
  }

  /// Columns that the export of this program or a person may have: "xD", "y.xD".
  std::size_t variable_column(const std::string& variable, const char* prefix) const {
    if (const auto tag = named(data_.tags, variable))
      return file_.column(where("tags", variable), *tag);
    if (const auto exported = file_.find(fmt::format("{}.{}", prefix, variable)))
      return *exported;
    if (const auto column = file_.find(variable))
      return *column;
    return file_.column(where("tags", variable), variable);
  }

  /// The numbers of a column in the study's unit; NaN where there is none.
  Signal numbers(std::size_t column, const std::string& variable) {
    const double zero = named(data_.operating_point, variable).value_or(0.0);
    const double scale = named(data_.scale, variable).value_or(1.0);
    Signal signal(file_.rows(), kNaN);
    std::size_t texts = 0, first_text = 0, filled = 0;
    for (std::size_t row = 0; row < file_.rows(); ++row) {
      const std::string& cell = file_.columns[column][row];
      if (const auto value = file_.number(cell))
        signal[row] = *value;
      else if (!cell.empty() && texts++ == 0)
        first_text = row;
      filled += cell.empty() ? 0 : 1;
    }
    const std::string name = cut_name(file_.names[column]);
    const std::string_view text = texts == 0 ? "" : cut_utf8(file_.columns[column][first_text], kShownBytes);
    if (texts == filled)
      throw InputError(fmt::format("{}: column '{}', for {}", file_.file, name, variable),
                       texts == 0 ? std::string("no value") : fmt::format("no number, but '{}'", text),
                       file_.decimal == '.'
                           ? "numbers with a decimal point; data.decimal = \",\" for commas"
                           : "numbers with a decimal comma; data.decimal = \".\" for points");
    if (texts > 0)
      record_.warnings.push_back(fmt::format(
          "column '{}': {} cells are no numbers and count as missing, the first is '{}' in line {}", name,
          texts, text, file_.lines[first_text]));
    drop_implausible(column, variable, signal);
    for (double& value : signal)
      value = scale * (value - zero);
    return signal;
  }

  /// The hard limits of a variable; infinite without.
  std::pair<double, double> hard_limits(const std::string& variable) const {
    std::pair<double, double> found{-kInfinity, kInfinity};
    const auto look = [&](const std::vector<PlantModel::Variable>& variables, const Limits& limits) {
      for (std::size_t i = 0; i < variables.size(); ++i)
        if (variables[i].name == variable)
          found = {limits.lower(static_cast<Eigen::Index>(i)), limits.upper(static_cast<Eigen::Index>(i))};
    };
    look(study_.plant.cvs, study_.controller.cv_hard);
    look(study_.plant.mvs, study_.controller.mv_hard);
    return found;
  }

  /// Takes out what cannot be measured. The signal is as recorded: it is there that -9999 means something.
  void drop_implausible(std::size_t column, const std::string& variable, Signal& signal) {
    const double zero = named(data_.operating_point, variable).value_or(0.0);
    const double scale = named(data_.scale, variable).value_or(1.0);
    const std::pair<double, double> limits = hard_limits(variable);
    const double one = zero + limits.first / scale, other = zero + limits.second / scale;
    const std::vector<std::size_t> rows =
        implausible_rows(signal, std::min(one, other), std::max(one, other));
    if (rows.empty())
      return;
    for (const std::size_t row : rows)
      signal[row] = kNaN;
    record_.warnings.push_back(fmt::format(
        "column '{}': {} values cannot be measurements and count as missing, the first is '{}' in line {}",
        cut_name(file_.names[column]), rows.size(),
        cut_utf8(file_.columns[column][rows.front()], kShownBytes), file_.lines[rows.front()]));
  }

  bool has_numbers(std::size_t column) const {
    const std::vector<std::string>& cells = file_.columns[column];
    return std::any_of(cells.begin(), cells.end(),
                       [&](const std::string& cell) { return file_.number(cell).has_value(); });
  }

  void drop_bad_quality(const std::string& variable, Signal& signal) {
    const auto tag = named(data_.quality, variable);
    if (!tag)
      return;
    const std::size_t column = file_.column(where("quality", variable), *tag);
    std::size_t bad = 0;
    std::map<std::string, std::size_t> words;
    for (std::size_t row = 0; row < signal.size(); ++row) {
      const std::string& cell = file_.columns[column][row];
      if (is_word(cell, data_.good_quality))
        continue;
      signal[row] = kNaN;
      ++bad;
      if (const std::string word = cut_name(cell); words.size() <= kWordsShown || words.contains(word))
        ++words[word];
    }
    if (bad == 0)
      return;
    std::vector<std::string> shown;
    for (const auto& [word, rows] : words)
      shown.push_back(shown.size() < kWordsShown ? fmt::format("'{}' ({} rows)", word, rows) : "others");
    if (bad == signal.size())
      throw InputError(where("quality", variable),
                       fmt::format("no row of good quality, but {}", fmt::join(shown, ", ")),
                       fmt::format("one of data.good_quality: {}", fmt::join(data_.good_quality, ", ")));
    record_.warnings.push_back(fmt::format(
        "{} is missing in {} of {} rows, whose quality is none of data.good_quality ({}): {}", variable, bad,
        signal.size(), fmt::join(data_.good_quality, ", "), fmt::join(shown, ", ")));
  }

  /// Is the cell one of these words, or a number that one of them is?
  bool is_word(const std::string& cell, const std::vector<std::string>& words) const {
    if (is_one_of(cell, words))
      return true;
    const auto value = file_.number(cell);
    return value && is_one_of(fmt::format("{:g}", *value), words);
  }

  // --- Time ---

  std::optional<std::size_t> time_column() const {
    if (!data_.time.empty())
      return file_.column(file_.file + ": data.time", data_.time);
    for (const char* usual : {"time", "timestamp", "datetime", "date", "t"})
      if (const auto column = file_.find(usual))
        return column;
    return column_of_dates();
  }

  /// The one column of dates, whatever its heading is.
  std::optional<std::size_t> column_of_dates() const {
    std::optional<std::size_t> found;
    for (std::size_t column = 0; column < file_.names.size(); ++column) {
      const std::vector<std::string>& cells = file_.columns[column];
      const auto first =
          std::find_if(cells.begin(), cells.end(), [](const std::string& cell) { return !cell.empty(); });
      if (first == cells.end() || file_.number(*first) || !is_date(*first))
        continue;
      if (found)
        throw InputError(fmt::format("{}: time stamps", file_.file),
                         fmt::format("dates in the columns '{}' and '{}'", cut_name(file_.names[*found]),
                                     cut_name(file_.names[column])),
                         "data.time, the column of the time stamps");
      found = column;
    }
    return found;
  }

  /// Time units of the plant in one unit of the stamps.
  double unit_of_stamps(bool calendar) const {
    const std::string& of_plant = study_.plant.time_unit;
    const std::string of_stamps = calendar ? "s" : data_.time_unit.empty() ? of_plant : data_.time_unit;
    if (of_stamps == of_plant)
      return 1.0;
    const std::optional<double> plant_days = days_in(of_plant);
    if (!plant_days)
      throw InputError(fmt::format("{}: time stamps", file_.file),
                       fmt::format("dates, or data.time_unit, and the time unit '{}' of the plant", of_plant),
                       "plant.time_unit s, min, h or d, or stamps that are numbers in its unit");
    return *days_in(of_stamps) / *plant_days;
  }

  void read_times() {
    const auto column = time_column();
    if (!column) {
      unit_ = 1.0;
      for (std::size_t row = 0; row < file_.rows(); ++row)
        times_.push_back(static_cast<double>(row) * study_.controller.sample_time);
      record_.warnings.push_back(
          fmt::format("no column of time stamps (data.time): each row is taken as one sample of {:g} {}",
                      study_.controller.sample_time, study_.plant.time_unit));
      return;
    }
    const std::string place = fmt::format("{}: column '{}'", file_.file, file_.names[*column]);
    TimeStamps stamps =
        parse_time_stamps({place, file_.columns[*column], file_.lines}, data_.date_order, file_.decimal);
    calendar_ = stamps.calendar;
    local_ = stamps.calendar && !stamps.offsets;
    unit_ = unit_of_stamps(calendar_);
    times_ = std::move(stamps.times);
    drop_rows_without_stamp();
    require_order(place);
  }

  void keep_rows(const std::vector<std::size_t>& rows) {
    file_.keep_rows(rows);
    std::vector<double> kept;
    for (const std::size_t row : rows)
      kept.push_back(times_[row]);
    times_ = std::move(kept);
  }

  void drop_rows_without_stamp() {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < times_.size(); ++row)
      if (!std::isnan(times_[row]))
        rows.push_back(row);
    if (rows.empty())
      throw InputError(file_.file + ": time stamps", "none", "a stamp in each row");
    if (rows.size() < times_.size()) {
      record_.warnings.push_back(
          fmt::format("{} rows without a time stamp are left out", times_.size() - rows.size()));
      keep_rows(rows);
    }
  }

  std::string stamp_text(double time) const {
    return calendar_ ? date_text(time) : fmt::format("{:.15g}", time);
  }

  void require_order(const std::string& place) {
    if (times_.size() > 1 && std::is_sorted(times_.rbegin(), times_.rend()) &&
        times_.front() > times_.back()) {
      std::vector<std::size_t> rows(times_.size());
      for (std::size_t row = 0; row < rows.size(); ++row)
        rows[row] = rows.size() - 1 - row;
      keep_rows(rows);
      record_.warnings.emplace_back("the newest row stands first: the rows are turned round");
    }
    std::size_t doubles = 0;
    for (std::size_t row = 1; row < times_.size(); ++row) {
      const double step = times_[row] - times_[row - 1];
      doubles += step == 0.0 ? 1 : 0;
      if (step < 0.0)
        refuse_step_back(place, row);
      if (local_ && is_spring_forward(row))
        throw InputError(
            fmt::format("{}, line {}", place, file_.lines[row]),
            fmt::format("{} after {}, an hour too late at night", stamp_text(times_[row]),
                        stamp_text(times_[row - 1])),
            "stamps that no clock is put forward in: export them in UTC (with Z, also where the hour is "
            "missing in truth), or with their offset (2024-03-31T03:00:00+02:00)");
    }
    if (doubles > 0)
      record_.warnings.push_back(
          fmt::format("{} rows have the time stamp of the row before them; a CV is their mean, everything "
                      "else the last one",
                      doubles));
  }

  [[noreturn]] void refuse_step_back(const std::string& place, std::size_t row) const {
    const double usual = row > 1 ? times_[row - 1] - times_[row - 2] : 0.0;
    const double back = times_[row - 1] - times_[row];
    const bool clock = calendar_ && back <= kSecondsOfHour && back + usual >= kSecondsOfHour * 0.99;
    throw InputError(
        fmt::format("{}, line {}", place, file_.lines[row]),
        fmt::format("{} after {}", stamp_text(times_[row]), stamp_text(times_[row - 1])),
        clock ? "stamps that do not go back by an hour, as local time does when the clock is put back: "
                "export them in UTC, or with their offset (2024-10-27T02:30:00+02:00)"
              : "stamps in ascending order: sort the rows, and leave out what was recorded twice");
  }

  /// Is exactly one hour missing in the night, as when the clock is put forward?
  bool is_spring_forward(std::size_t row) const {
    const double step = times_[row] - times_[row - 1];
    const double usual = row > 1 ? times_[row - 1] - times_[row - 2] : 0.0;
    const double hour = std::fmod(times_[row], 86400.0) / kSecondsOfHour;
    return usual > 0.0 && usual < kSecondsOfHour && std::abs(step - usual - kSecondsOfHour) < 1.0 &&
           hour >= 2.0 && hour < 4.0;
  }

  /// Rows of a period of data.NAME, in stamps as the file has them.
  std::pair<double, double> between(const char* key, const std::vector<std::string>& period) const {
    const std::string place = fmt::format("data.{}", key);
    const std::vector<std::size_t> no_lines{0, 0};
    DateOrder order = data_.date_order;
    const TimeStamps stamps = parse_time_stamps({place, period, no_lines}, order, file_.decimal);
    if (stamps.calendar != calendar_ || !(stamps.times[0] < stamps.times[1]))
      throw InputError(place, fmt::format("[{}, {}]", period[0], period[1]),
                       fmt::format("two stamps of the form of the file, ascending, between {} and {}",
                                   stamp_text(times_.front()), stamp_text(times_.back())));
    return {stamps.times[0], stamps.times[1]};
  }

  /// The grid: sample k at first_ + k Ts.
  void choose_samples() {
    double last = times_.back();
    first_ = times_.front();
    if (!data_.period.empty()) {
      const auto [from, to] = between("period", data_.period);
      first_ = std::max(first_, from);
      last = std::min(last, to);
    }
    sample_ = study_.controller.sample_time / unit_;
    const double count = std::floor((last - first_) / sample_ + 1e-6) + 1.0;
    if (!(count >= 2.0 && count <= kMostSamples))
      throw InputError(
          fmt::format("{}: time stamps", file_.file),
          fmt::format("{} to {}, {:.10g} samples of {:g} {}", stamp_text(first_), stamp_text(last),
                      std::max(count, 0.0), study_.controller.sample_time, study_.plant.time_unit),
          "2 to 1000000 samples of the controller: look at the stamps, data.time_unit, data.period");
    samples_ = static_cast<Eigen::Index>(count);
    for (Eigen::Index k = 0; k < samples_; ++k)
      record_.stamps.push_back(stamp_text(at(k)));
  }

  double at(Eigen::Index k) const { return first_ + static_cast<double>(k) * sample_; }

  /// The sample to which a time belongs; -1 and samples_ of one before and behind all of them.
  Eigen::Index nearest_sample(double time) const {
    const double sample = std::floor((time - first_) / sample_ + 0.5);
    return static_cast<Eigen::Index>(std::clamp(sample, -1.0, static_cast<double>(samples_)));
  }

  std::pair<Eigen::Index, Eigen::Index> samples_between(const char* key,
                                                        const std::vector<std::string>& period) const {
    const auto [from, to] = between(key, period);
    const Eigen::Index first = std::clamp<Eigen::Index>(nearest_sample(from), 0, samples_);
    const Eigen::Index end = std::clamp<Eigen::Index>(nearest_sample(to) + 1, 0, samples_);
    if (first >= end)
      throw InputError(
          fmt::format("data.{}", key), fmt::format("[{}, {}]", period[0], period[1]),
          fmt::format("a period between {} and {}", record_.stamps.front(), record_.stamps.back()));
    return {first, end};
  }

  // --- Samples ---

  /// One row a variable: of(name) of each.
  template <class Of>
  Eigen::MatrixXd group(const std::vector<PlantModel::Variable>& variables, Of of) const {
    Eigen::MatrixXd signals(static_cast<Eigen::Index>(variables.size()), samples_);
    for (std::size_t i = 0; i < variables.size(); ++i)
      signals.row(static_cast<Eigen::Index>(i)) = of(variables[i].name);
    return signals;
  }

  Eigen::RowVectorXd measured(const Signal& signal) const {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(samples_), count = sum;
    Eigen::RowVectorXd distance = Eigen::RowVectorXd::Constant(samples_, kInfinity);
    const bool mean = data_.cv_resampling == CvResampling::mean;
    for (std::size_t row = 0; row < signal.size(); ++row) {
      const Eigen::Index k = nearest_sample(times_[row]);
      if (k < 0 || k >= samples_ || std::isnan(signal[row]))
        continue;
      const double off = std::abs(times_[row] - at(k));
      if (!mean && off >= distance(k))
        continue;
      sum(k) = mean ? sum(k) + signal[row] : signal[row];
      count(k) = mean ? count(k) + 1.0 : 1.0;
      distance(k) = off;
    }
    return (count.array() > 0.0).select(sum.array() / count.array(), kNaN);
  }

  /// The last value up to half a sample time after each sample; what is missing at the start is the first
  /// value.
  Eigen::RowVectorXd held(const Signal& signal) const {
    Eigen::RowVectorXd values = Eigen::RowVectorXd::Constant(samples_, kNaN);
    double last = kNaN;
    std::size_t row = 0;
    for (Eigen::Index k = 0; k < samples_; ++k) {
      for (; row < signal.size() && times_[row] < at(k) + 0.5 * sample_; ++row)
        last = std::isnan(signal[row]) ? last : signal[row];
      values(k) = last;
    }
    for (Eigen::Index k = samples_ - 2; k >= 0; --k)
      if (std::isnan(values(k)))
        values(k) = values(k + 1);
    return values;
  }

  Eigen::RowVectorXd cv(const std::string& name) {
    Signal signal = numbers(variable_column(name, "y"), name);
    drop_bad_quality(name, signal);
    return measured(signal);
  }

  Eigen::RowVectorXd input(const std::string& name, const char* prefix) {
    Signal signal = numbers(variable_column(name, prefix), name);
    drop_bad_quality(name, signal);
    const double missing = measured(signal).array().isNaN().cast<double>().mean();
    refuse_missing(name, missing);
    if (missing > kWorthSaying)
      record_.warnings.push_back(fmt::format(
          "{} is missing in {} of the samples and held there: check that it was recorded only on change",
          name, percent(missing)));
    return held(signal);
  }

  /// A signal that belongs to a variable and may be left out.
  Eigen::RowVectorXd companion(const std::string& variable, const DataOptions::Names& tags, const char* key,
                               const char* exported = "") {
    const auto tag = named(tags, variable);
    const auto column =
        tag ? file_.column(where(key, variable), *tag) : file_.find(fmt::format("{}.{}", exported, variable));
    const bool recorded = tag || (column && has_numbers(*column));  // exports have empty columns
    return recorded ? held(numbers(*column, variable)) : Eigen::RowVectorXd::Constant(samples_, kNaN);
  }

  /// Signals beside those of the loop, in units of their own: a regression looks at their moves only.
  void read_candidates() {
    record_.candidate_names = data_.candidates;
    record_.candidates.resize(static_cast<Eigen::Index>(data_.candidates.size()), samples_);
    for (std::size_t i = 0; i < data_.candidates.size(); ++i) {
      const std::string& name = data_.candidates[i];
      const std::size_t column = file_.column(fmt::format("{}: data.candidates", file_.file), name);
      const Eigen::RowVectorXd values = held(numbers(column, name));
      if ((values.array() == values(0)).all())
        throw InputError(fmt::format("{}: data.candidates: '{}'", file_.file, name),
                         fmt::format("{:g} in every sample", values(0)),
                         "a signal that changes, or leave it out");
      record_.candidates.row(static_cast<Eigen::Index>(i)) = values.array() - values.mean();
    }
  }

  void leave_out_without_controller() {
    if (data_.controller_on.empty())
      return;
    const std::size_t column = file_.column(file_.file + ": data.controller_on", data_.controller_on);
    Signal on;
    for (const std::string& cell : file_.columns[column]) {
      on.push_back(cell.empty() ? kNaN : is_word(cell, data_.on_values) ? 1.0 : 0.0);
    }
    const Eigen::RowVectorXd is_on = held(on);
    const double off = (is_on.array() != 1.0).cast<double>().mean();
    if (off == 1.0)
      throw InputError(
          file_.file + ": data.controller_on",
          fmt::format("'{}' throughout", cut_utf8(file_.columns[column].front(), kShownBytes)),
          fmt::format("a period with one of data.on_values: {}", fmt::join(data_.on_values, ", ")));
    if (off > 0.0)
      record_.warnings.push_back(
          fmt::format("the controller is off in {} of the samples: they are not judged", percent(off)));
    for (Eigen::Index k = 0; k < samples_; ++k)
      if (is_on(k) != 1.0)
        record_.y.col(k).setConstant(kNaN);
  }

  void refuse_missing(const std::string& name, double missing) const {
    if (missing > data_.most_missing)
      throw InputError(
          fmt::format("{}: {}", file_.file, name), fmt::format("{} of its samples missing", percent(missing)),
          fmt::format("at most {} (data.most_missing): choose another period (data.period), export a value "
                      "at least every {:g} {}, or raise data.most_missing{}",
                      percent(data_.most_missing), study_.controller.sample_time, study_.plant.time_unit,
                      calendar_ || data_.time_unit == study_.plant.time_unit
                          ? ""
                          : fmt::format("; stamps that are numbers count as {}: data.time_unit",
                                        data_.time_unit.empty() ? study_.plant.time_unit : data_.time_unit)));
  }

  void refuse_missing() {
    for (Eigen::Index cv = 0; cv < record_.y.rows(); ++cv) {
      const std::string& name = study_.plant.cvs[static_cast<std::size_t>(cv)].name;
      const double missing = record_.y.row(cv).array().isNaN().cast<double>().mean();
      refuse_missing(name, missing);
      if (missing > kWorthSaying)
        record_.warnings.push_back(
            fmt::format("{} is missing in {} of the samples: methods that need every sample do not apply",
                        name, percent(missing)));
    }
  }

  const Study& study_;
  const DataOptions& data_;
  RecordColumns file_;
  bool calendar_ = false;
  bool local_ = false;         ///< dates without an offset
  double unit_ = 1.0;          ///< time units of the plant in one of the stamps
  std::vector<double> times_;  ///< of the rows, unit of the stamps
  double first_ = 0.0;         ///< of the samples, unit of the stamps
  double sample_ = 1.0;        ///< sample time, unit of the stamps
  Eigen::Index samples_ = 0;
  PlantRecord record_;
};

}  // namespace

PlantRecord read_plant_record(const Study& study, std::string_view text, const std::string& file) {
  RecordColumns columns = parse_csv(text, file, study.data.separator);
  columns.decimal = study.data.decimal.empty() ? found_decimal(columns) : study.data.decimal.front();
  return RecordReader(study, std::move(columns)).record();
}

PlantRecord load_plant_record(const Study& study, const std::filesystem::path& path) {
  const std::string content =
      foreign_content(path, "a CSV or netCDF-4 file of records (docs/own_records.md)");
  const std::string file = path.filename().string();
  if (!is_netcdf4(content))
    return read_plant_record(study, content, file);
  const auto bytes = std::as_bytes(std::span(content));
  return RecordReader(study, netcdf_columns({bytes.begin(), bytes.end()}, file, study.data.time)).record();
}

}  // namespace mpm
