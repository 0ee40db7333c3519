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

/// A sentence in lines of at most `width` characters where a word allows it, all but the first set in.
std::string wrapped(const std::string& sentence, std::size_t width, const std::string& set_in = "");

}  // namespace mpm
