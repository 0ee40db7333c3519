#include "results/records/netcdf_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/system/forked_service.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"
#include "results/records/date_words.hpp"
#include "results/records/matlab_columns.hpp"
#include "results/records/time_stamps.hpp"

namespace mpm {
namespace {

constexpr std::array kUsualTimes{"time", "timestamp", "datetime", "date", "t"};
constexpr double kMicrosecond = 1e-6;  // s
constexpr std::string_view kSince = " since ";
constexpr double kEarliest = -12212553600.0;                // 1583-01-01 in s since 1970
constexpr double kLatest = 253402300800.0;                  // 10000-01-01
constexpr std::size_t kMostNumbers = std::size_t{1} << 28;  // of 8 bytes each, in the answer
constexpr const char* kAllowed =
    "a netCDF-4 file of records, one of MATLAB 7.3, or a CSV file (docs/own_records.md)";

/// Returns the seconds in a unit of CF; none for any other unit. Months and years have no fixed length.
std::optional<double> seconds_in(std::string unit) {
  unit = in_lower_case(std::move(unit));
  if (unit.size() > 2 && unit.back() == 's')
    unit.pop_back();
  for (const auto& [names, seconds] :
       {std::pair{" nsec nanosecond ns ", 1e-9}, std::pair{" usec microsecond us ", kMicrosecond},
        std::pair{" msec millisecond ms ", 1e-3}, std::pair{" sec second s ", 1.0},
        std::pair{" min minute ", 60.0}, std::pair{" hr hour h ", 3600.0}, std::pair{" day d ", 86400.0}})
    if (std::string(names).find(fmt::format(" {} ", unit)) != std::string::npos)
      return seconds;
  return std::nullopt;
}

/// Pads each number of a date to two digits, because people write 1900-1-1 0:0:0 here.
std::string with_two_digits(const std::string& date) {
  const auto is_digit = [&date](std::size_t at) {
    return at < date.size() && std::isdigit(static_cast<unsigned char>(date[at])) != 0;
  };
  std::string padded;
  for (std::size_t at = 0; at < date.size(); ++at) {
    const bool alone = is_digit(at) && !is_digit(at + 1) && at > 0 && !is_digit(at - 1);
    padded += alone && date[at - 1] != '.' ? std::string{'0', date[at]} : std::string{date[at]};
  }
  return padded;
}

/// Returns the stamp of a time in s since 1970, with `digits` decimals of a second.
std::string utc_text(double seconds, int digits) {
  const double parts = digits == 3 ? 1e3 : 1e6;  // of a second
  const double rounded = std::round(seconds * parts), whole = std::floor(rounded / parts);
  const auto rest = static_cast<int>(rounded - whole * parts);
  return fmt::format("{}{}Z", date_text(whole), rest == 0 ? "" : fmt::format(".{:0{}}", rest, digits));
}

class NetcdfReader {
 public:
  NetcdfReader(const Hdf5Group& root, const std::string& file, const std::string& time)
      : root_(root), variables_(root.variables()) {
    columns_.file = file;
    find_time(time);
  }

  RecordColumns columns() {
    columns_.lines.resize(samples_);
    std::iota(columns_.lines.begin(), columns_.lines.end(), std::size_t{1});
    if (!time_.empty())
      add(time_, time_cells());
    for (const std::string& variable : variables_)
      if (variable != time_)
        add_variable(variable);
    if (columns_.names.size() < 2)
      throw InputError(
          columns_.file,
          several_loops_ ? "several loops" : "no variables along the time" + left_out_text(columns_),
          several_loops_ ? "a file of one loop: take it out first (ncks -d loop,0)"
                         : "numbers of one dimension, or of two with the time last");
    return std::move(columns_);
  }

 private:
  bool has(const std::string& name) const {
    return std::find(variables_.begin(), variables_.end(), name) != variables_.end();
  }

  void find_time(const std::string& wanted) {
    if (!wanted.empty() && !has(wanted))
      throw InputError(fmt::format("{}: data.time", columns_.file), fmt::format("no variable '{}'", wanted),
                       fmt::format("one of {}", fmt::join(variables_, ", ")));
    time_ = wanted;
    for (const char* usual : kUsualTimes)
      if (time_.empty() && has(usual))
        time_ = usual;
    const std::string along = time_.empty() && has("sample") ? "sample" : time_;
    if (along.empty() || root_.dimensions(along).size() != 1)
      throw InputError(
          columns_.file,
          along.empty()
              ? std::string("no variable of the time")
              : fmt::format("'{}' of {} dimensions for the time", along, root_.dimensions(along).size()),
          fmt::format("one of one dimension (data.time), such as {}", fmt::join(kUsualTimes, ", ")));
    dimension_ = root_.dimensions(along).front();
    samples_ = root_.shape(along).front();
    along_ = along;
    if (samples_ > kMostForeignCells)
      throw InputError(fmt::format("{}: variable '{}'", columns_.file, along),
                       fmt::format("{} samples", samples_), fmt::format("at most {}", kMostForeignCells));
  }

  std::vector<std::string> time_cells() const {
    if (root_.is_text(time_))
      return root_.texts(time_);
    const std::vector<std::string> numbers = number_cells(time_);
    const std::string units = root_.text_attribute(time_, "units").value_or("");
    const std::size_t since = in_lower_case(units).find(kSince);
    return since == std::string::npos
               ? numbers
               : dates(std::string(without_blanks(units.substr(0, since))),
                       std::string(without_blanks(units.substr(since + kSince.size()))));
  }

  /// Returns the date from which times are counted, in s since 1970, in the calendar that clocks use.
  static double beginning(const std::string& place, const std::string& date) {
    constexpr int kFirstYear = 1583;  // of the Gregorian calendar
    int year = 0;
    const auto [end, error] = std::from_chars(date.data(), date.data() + date.size(), year);
    const bool four_digits = error == std::errc() && end == date.data() + 4;
    if (!four_digits || year < kFirstYear)
      throw InputError(
          place, fmt::format("'{}'", cut_utf8(date, kShownBytes)),
          fmt::format("a date such as 2024-10-27 00:00:00, with a year of four digits from {} on",
                      kFirstYear));
    const std::vector<std::string> cell{with_two_digits(date)};
    const std::vector<std::size_t> line{0};
    if (!is_date(cell.front()))
      throw InputError(place, fmt::format("'{}'", cut_utf8(date, kShownBytes)),
                       "a date, such as 2024-10-27 00:00:00");
    const TimeStamps begin = parse_time_stamps({place, cell, line}, {.order = DateOrder::year_month_day});
    return begin.times.front();
  }

  /// Converts times in CF units, "UNIT since DATE".
  std::vector<std::string> dates(const std::string& unit, const std::string& date) const {
    const std::string place = fmt::format("{}: units of '{}'", columns_.file, time_);
    const std::optional<double> seconds = seconds_in(unit);
    if (!seconds)
      throw InputError(place,
                       fmt::format("'{} since {}'", cut_utf8(unit, kShownBytes), cut_utf8(date, kShownBytes)),
                       "nanoseconds to days since a date");
    const std::string calendar = in_lower_case(root_.text_attribute(time_, "calendar").value_or("standard"));
    if (calendar != "standard" && calendar != "gregorian" && calendar != "proleptic_gregorian")
      throw InputError(fmt::format("{}: calendar of '{}'", columns_.file, time_),
                       fmt::format("'{}'", cut_utf8(calendar, kShownBytes)),
                       "standard, gregorian or proleptic_gregorian");
    const double begin = beginning(place, date);
    const int digits = *seconds <= kMicrosecond ? 6 : 3;
    std::vector<std::string> stamps;
    for (const double time : root_.numbers(time_)) {
      const double at = begin + time * *seconds;
      if (std::isfinite(time) && !(at > kEarliest && at < kLatest))
        throw InputError(place, fmt::format("{:g} {} since {}", time, unit, date),
                         "times of the years 1583 to 9999");
      stamps.push_back(std::isfinite(time) ? utc_text(at, digits) : "");
    }
    return stamps;
  }

  /// Returns the numbers of a variable after its fill values, scale and offset are applied.
  std::vector<std::string> number_cells(const std::string& variable) const {
    const auto attribute = [&](const char* name) { return root_.number_attribute(variable, name); };
    const std::optional<double> fill = attribute("_FillValue"), missing = attribute("missing_value");
    const double scale = attribute("scale_factor").value_or(1.0);
    const double offset = attribute("add_offset").value_or(0.0);
    if (!std::isfinite(scale) || scale == 0.0 || !std::isfinite(offset))
      throw InputError(fmt::format("{}: scale_factor and add_offset of '{}'", columns_.file, variable),
                       fmt::format("{} and {}", scale, offset), "finite numbers, scale_factor not 0");
    const std::vector<double> values = root_.numbers(variable);
    std::vector<std::string> cells;
    cells.reserve(values.size());
    for (const double value : values)
      cells.push_back(!std::isfinite(value) || value == fill || value == missing
                          ? ""
                          : fmt::format("{}", scale * value + offset));
    return cells;
  }

  void add(const std::string& name, std::vector<std::string> cells) {
    cells_ += cells.size();
    if (cells_ > kMostForeignCells)
      throw InputError(columns_.file, fmt::format("more than {} values along the time", kMostForeignCells),
                       "so many: a shorter period, or fewer variables");
    columns_.names.push_back(name);
    columns_.columns.push_back(std::move(cells));
  }

  /// Returns the names of the coordinates of a dimension, or their numbers if it has no names.
  std::vector<std::string> coordinates(const std::string& dimension, std::size_t length) const {
    if (has(dimension) && root_.is_text(dimension) && root_.shape(dimension) == std::vector{length})
      return root_.texts(dimension);
    std::vector<std::string> numbers;
    for (std::size_t i = 1; i <= length; ++i)
      numbers.push_back(fmt::format("{}", i));
    return numbers;
  }

  void add_variable(const std::string& variable) {
    const std::vector<std::string> dimensions = root_.dimensions(variable);
    const std::vector<std::size_t> shape = root_.shape(variable);
    for (std::size_t i = 0; i < shape.size(); ++i)
      if (dimensions[i] == dimension_ && shape[i] != samples_)
        throw InputError(fmt::format("{}: variable '{}'", columns_.file, variable),
                         fmt::format("{} samples", shape[i]),
                         fmt::format("{}, as '{}' has them", samples_, along_));
    if (dimensions.size() == 2 && dimensions.front() == dimension_ && root_.is_text(variable)) {
      add_characters(variable, shape.back());
      return;
    }
    if (variable == dimension_)
      return;
    if (const char* const why = why_no_column(variable, dimensions, shape)) {
      columns_.left_out.emplace(variable, why);
      return;
    }
    std::vector<std::string> cells = root_.is_text(variable) ? root_.texts(variable) : number_cells(variable);
    if (dimensions.size() == 1) {
      add(variable, std::move(cells));
      return;
    }
    const std::size_t rows = shape[shape.size() - 2];
    const std::vector<std::string> names = coordinates(dimensions[dimensions.size() - 2], rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto first = cells.begin() + static_cast<std::ptrdiff_t>(row * samples_);
      add(fmt::format("{}.{}", variable, names[row]), {first, first + static_cast<std::ptrdiff_t>(samples_)});
    }
  }

  /// Returns why a variable gives no columns; null if it does.
  const char* why_no_column(const std::string& variable, const std::vector<std::string>& dimensions,
                            const std::vector<std::size_t>& shape) {
    if (dimensions.empty() || dimensions.back() != dimension_)
      return "its last dimension is not that of the time";
    if (!root_.is_number(variable) && !root_.is_text(variable))
      return "its values are neither real numbers nor texts";
    several_loops_ = several_loops_ || (dimensions.size() == 3 && shape.front() != 1);
    return dimensions.size() > 3 || (dimensions.size() == 3 && shape.front() != 1)
               ? "it has more dimensions than those of one loop"
               : nullptr;
  }

  /// Adds one text per sample, made of single characters along the last dimension.
  void add_characters(const std::string& variable, std::size_t length) {
    const std::vector<std::string> characters = root_.texts(variable);
    if (std::any_of(characters.begin(), characters.end(), [](const auto& each) { return each.size() > 1; })) {
      columns_.left_out.emplace(variable, "its texts have two dimensions");
      return;
    }
    std::vector<std::string> cells(samples_);
    for (std::size_t i = 0; i < characters.size(); ++i)
      cells[i / length] += characters[i].empty() ? " " : characters[i];
    for (std::string& cell : cells)
      cell.erase(cell.find_last_not_of(' ') + 1);
    add(variable, std::move(cells));
  }

  Hdf5Group root_;
  std::vector<std::string> variables_;
  RecordColumns columns_;
  std::string time_;       ///< time variable; empty: none, rows are samples
  std::string dimension_;  ///< dimension of the time
  std::string along_;      ///< the variable that has this dimension
  std::size_t samples_ = 0;
  std::size_t cells_ = 0;
  bool several_loops_ = false;
};

/// The content of a file, or why it is refused.
struct NetcdfAnswer {
  std::string refused;
  RecordColumns columns;
};

NetcdfAnswer read_file(std::vector<std::byte>& content, const std::string& file, const std::string& time) {
  try {
    const auto* const text = reinterpret_cast<const char*>(content.data());
    const bool matlab = is_matlab({text, content.size()});
    const Hdf5File opened = Hdf5File::open_unsealed(std::move(content), file);
    return {{},
            matlab ? matlab_columns(opened.root(), file, time)
                   : NetcdfReader(opened.root(), file, time).columns()};
  } catch (const InputError& error) {
    return {error.what(), {}};
  } catch (const ArchiveError& error) {
    const std::string_view what = error.what(), place = file;
    const bool named = what.starts_with(place) && what.substr(place.size()).starts_with(": ");
    return {InputError(file, std::string(named ? what.substr(place.size() + 2) : what), kAllowed).what(), {}};
  }
}

/// Packs bytes as a forked service returns them: first how many, then the numbers that hold them.
std::vector<double> as_numbers(const std::string& bytes) {
  std::vector<double> numbers(1 + (bytes.size() + sizeof(double) - 1) / sizeof(double));
  numbers.front() = static_cast<double>(bytes.size());
  std::memcpy(numbers.data() + 1, bytes.data(), bytes.size());
  return numbers;
}

std::string_view as_bytes(const std::vector<double>& numbers) {
  const double room = static_cast<double>(numbers.size()) * sizeof(double);
  if (numbers.empty() || !(numbers.front() >= 0.0 && numbers.front() + sizeof(double) <= room))
    throw ForeignFailure("its process gave no valid answer");
  return {reinterpret_cast<const char*>(numbers.data() + 1), static_cast<std::size_t>(numbers.front())};
}

/// Writes or reads the columns, except for the name of the file.
template <class Stream, class Columns>
void transfer_columns(Stream& stream, Columns& columns) {
  std::size_t count = columns.names.size(), rows = columns.rows();
  transfer_all(stream, count, rows);
  if constexpr (!std::is_const_v<Columns>) {
    if (rows > kMostForeignCells || count > kMostForeignCells / std::max<std::size_t>(rows, 1))
      throw std::runtime_error("message between processes: too many columns");
    columns.names.resize(count);
    columns.lines.resize(rows);
    columns.columns.assign(count, std::vector<std::string>(rows));
  }
  std::size_t out = columns.left_out.size();
  transfer(stream, out);
  if constexpr (std::is_const_v<Columns>) {
    for (const auto& [name, why] : columns.left_out)
      transfer_all(stream, name, why);
  } else {
    for (std::string name, why; out > 0; --out) {
      transfer_all(stream, name, why);
      columns.left_out.emplace(name, why);
    }
  }
  for (auto& name : columns.names)
    transfer(stream, name);
  for (auto& line : columns.lines)
    transfer(stream, line);
  for (auto& cells : columns.columns)
    for (auto& cell : cells)
      transfer(stream, cell);
}

/// Unpacks what the process has read. HDF5 may have corrupted it if the file is damaged.
RecordColumns columns_of(std::string_view bytes, const std::string& file) {
  ByteReader reader(bytes);
  NetcdfAnswer answer;
  transfer(reader, answer.refused);
  if (!answer.refused.empty())
    throw InputError(answer.refused);
  answer.columns.file = file;
  transfer_columns(reader, answer.columns);
  reader.require_end();
  return std::move(answer.columns);
}

}  // namespace

bool is_hdf5(std::string_view content) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  return content.starts_with(kSignature) ||
         (is_matlab(content) && content.substr(kMatlabHeading).starts_with(kSignature));
}

RecordColumns netcdf_columns(std::vector<std::byte> content, const std::string& file, const std::string& time,
                             double time_limit) {
  // On some damaged files the library frees and reads memory that it does not own.
  ForkedService reader(
      [&](const auto&) {
        const NetcdfAnswer answer = read_file(content, file, time);
        ByteWriter writer;
        transfer(writer, answer.refused);
        transfer_columns(writer, answer.columns);
        return as_numbers(writer.take());
      },
      time_limit, kMostNumbers);
  try {
    const std::vector<double> answer = reader.ask({});
    return columns_of(as_bytes(answer), file);
  } catch (const ForeignFailure& failure) {
    throw InputError(file, fmt::format("a file that HDF5 cannot read ({})", failure.what()), kAllowed);
  } catch (const std::runtime_error&) {  // the bytes of the answer are invalid
    throw InputError(file, "a file that HDF5 cannot read (its process gave no valid answer)", kAllowed);
  }
}

}  // namespace mpm
