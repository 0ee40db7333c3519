#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mpm {

/// Words in columns, each as wide as its longest entry, for people who read a terminal. The first column
/// stands left, the others are numbers and stand right.
class TextTable {
 public:
  using Row = std::vector<std::string>;
  enum class LastColumn { number, words };  ///< words stand left

  void add(Row row);
  std::string text(LastColumn last = LastColumn::number) const;

 private:
  std::vector<Row> rows_;
  std::vector<std::size_t> widths_;
};

}  // namespace mpm
