#include "results/records/matlab_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

constexpr std::array kTimesOfMatlab{"time", "timestamp", "datetime", "date", "t"};

/// A variable with its dimensions in MATLAB.
struct MatlabArray {
  std::string name;
  bool text = false;
  std::size_t rows = 0, columns = 0;
  std::vector<std::string> cells;  ///< column by column; characters: one column, a text per row

  bool vector() const { return rows == 1 || columns == 1; }
  std::size_t length() const { return vector() ? std::max(rows, columns) : rows; }
};

std::string text_of_codes(const std::vector<double>& codes) {
  std::string bytes{"\xFE\xFF"};
  for (const double code : codes) {
    const auto unit = static_cast<std::uint16_t>(code >= 0.0 && code < 65536.0 ? code : 0xFFFD);
    bytes += static_cast<char>(unit >> 8U);
    bytes += static_cast<char>(unit & 0xFFU);
  }
  return proper_utf8(utf8_of_utf16(bytes));
}

class MatlabReader {
 public:
  MatlabReader(const Hdf5Group& root, std::string file) : file_(std::move(file)) {
    take_group(root, "");
    for (const std::string& name : root.groups()) {
      if (name.starts_with('#'))
        continue;
      const Hdf5Group group = root.group(name);
      if (group.has_attribute("MATLAB_sparse")) {
        left_out_.emplace(name, "it is sparse: save full(...) of it");
        continue;
      }
      take_group(group, name + ".");
      left_out_.emplace(name, "it is a struct, whose fields are columns");
    }
  }

  RecordColumns columns(const std::string& time) const {
    const std::size_t rows = row_count(time);
    RecordColumns made;
    made.file = file_;
    made.left_out = left_out_;
    for (const MatlabArray& array : arrays_)
      if (rows > 1 && array.length() == rows)
        add(made, array, rows);
      else
        made.left_out.emplace(
            array.name, rows > 1 ? fmt::format("it has {} rows, and others have {}", array.length(), rows)
                                 : fmt::format("it has {} rows", array.length()));
    made.lines.resize(rows);
    std::iota(made.lines.begin(), made.lines.end(), std::size_t{1});
    if (made.names.empty())
      throw InputError(
          file_, "no arrays of numbers with a row a sample" + left_out_text(made),
          "vectors, matrices with names in a cell array, or the fields of a struct; a table or timetable as "
          "table2struct(T, \"ToScalar\", true)");
    return made;
  }

 private:
  /// `prefix` goes before names that occur elsewhere as well.
  void take_group(const Hdf5Group& group, const std::string& prefix) {
    for (const std::string& name : group.variables())
      take(group, name, prefix);
  }

  void take(const Hdf5Group& group, const std::string& name, const std::string& prefix) {
    const std::vector<std::size_t> shape = group.shape(name);
    const std::string kind = group.text_attribute(name, "MATLAB_class").value_or("");
    const bool empty = group.number_attribute(name, "MATLAB_empty").value_or(0.0) != 0.0;
    const auto leave_out = [&](const char* why) { left_out_.emplace(name, why); };
    if (shape.size() != 2 || empty || kind.empty())
      return leave_out(empty          ? "it is empty"
                       : kind.empty() ? "it has no MATLAB_class"
                                      : "it has not two dimensions");
    MatlabArray array;
    array.name = names_.insert(name).second ? name : prefix + name;
    array.rows = shape[1];  // MATLAB's first dimension is HDF5's last
    array.columns = shape[0];
    if (group.is_reference(name)) {
      if (kind != "cell" || !take_texts(group, name, array))
        return leave_out("its cells are not all texts");
    } else if (kind == "char") {
      take_characters(group.numbers(name), array);
    } else if (group.is_number(name) && !group.number_attribute(name, "MATLAB_object_decode")) {
      for (const double value : group.numbers(name))
        array.cells.push_back(std::isfinite(value) ? fmt::format("{}", value) : "");
    } else {
      return leave_out("its values are neither real numbers nor texts");
    }
    count_ += array.cells.size();
    if (count_ > kMostForeignCells)
      throw InputError(file_, fmt::format("more than {} values", kMostForeignCells),
                       "so many: a shorter period, or fewer variables");
    arrays_.push_back(std::move(array));
  }

  /// Reads a cell array of texts; returns false if it holds anything else.
  static bool take_texts(const Hdf5Group& group, const std::string& name, MatlabArray& array) {
    array.text = true;
    const std::vector<std::string> paths = group.references(name);
    try {
      for (const std::string& path : paths) {
        if (path.empty() || group.text_attribute(path, "MATLAB_class") != "char")
          return false;
        const bool empty = group.number_attribute(path, "MATLAB_empty").value_or(0.0) != 0.0;
        array.cells.push_back(empty ? "" : text_of_codes(group.numbers(path)));
      }
    } catch (const ArchiveError&) {  // a group, so it is a struct
      return false;
    }
    return true;
  }

  static void take_characters(const std::vector<double>& codes, MatlabArray& array) {
    array.text = true;
    for (std::size_t row = 0; row < array.rows; ++row) {
      std::vector<double> of_row;
      for (std::size_t column = 0; column < array.columns; ++column)
        of_row.push_back(codes[column * array.rows + row]);
      std::string text = text_of_codes(of_row);
      text.erase(text.find_last_not_of(' ') + 1);
      array.cells.push_back(std::move(text));
    }
    array.columns = 1;
  }

  std::size_t row_count(const std::string& time) const {
    std::size_t most = 0;
    for (const MatlabArray& array : arrays_) {
      if (array.name == time)
        return array.length();
      most = array.text ? most : std::max(most, array.length());
    }
    if (!time.empty())
      throw InputError(fmt::format("{}: data.time", file_), fmt::format("no variable '{}'", time),
                       "a vector of the file");
    for (const char* usual : kTimesOfMatlab)
      for (const MatlabArray& array : arrays_)
        if (array.name == usual)
          return array.length();
    return most;
  }

  /// Finds an array with as many texts as there are columns, unless that is also the number of rows.
  const MatlabArray* names_of(std::size_t columns, std::size_t rows) const {
    const auto found = std::find_if(arrays_.begin(), arrays_.end(), [&](const MatlabArray& array) {
      return array.text && array.vector() && array.cells.size() == columns && columns != rows;
    });
    return found == arrays_.end() ? nullptr : &*found;
  }

  void add(RecordColumns& made, const MatlabArray& array, std::size_t rows) const {
    const std::size_t columns = array.cells.size() / rows;
    const MatlabArray* const names = columns > 1 ? names_of(columns, rows) : nullptr;
    for (std::size_t column = 0; column < columns; ++column) {
      made.names.push_back(columns == 1       ? array.name
                           : names != nullptr ? names->cells[column]
                                              : fmt::format("{}.{}", array.name, column + 1));
      const auto first = array.cells.begin() + static_cast<std::ptrdiff_t>(column * rows);
      made.columns.emplace_back(first, first + static_cast<std::ptrdiff_t>(rows));
    }
  }

  std::string file_;
  std::vector<MatlabArray> arrays_;
  std::set<std::string> names_;
  std::map<std::string, std::string> left_out_;
  std::size_t count_ = 0;
};

}  // namespace

bool is_matlab(std::string_view content) {
  return content.starts_with("MATLAB 7.3 MAT-file") && content.size() > kMatlabHeading;
}

RecordColumns matlab_columns(const Hdf5Group& root, const std::string& file, const std::string& time) {
  return MatlabReader(root, file).columns(time);
}

}  // namespace mpm
