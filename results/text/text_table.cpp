#include "results/text/text_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace mpm {

void TextTable::add(Row row) {
  widths_.resize(std::max(widths_.size(), row.size()));
  for (std::size_t i = 0; i < row.size(); ++i)
    widths_[i] = std::max(widths_[i], row[i].size());
  rows_.push_back(std::move(row));
}

std::string TextTable::text(LastColumn last) const {
  std::string text;
  for (const Row& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == 0)
        text += fmt::format("{:<{}}", row[i], widths_[i]);
      else if (i + 1 < row.size() || last == LastColumn::number)
        text += fmt::format("  {:>{}}", row[i], widths_[i]);
      else
        text += "  " + row[i];
    }
    text += '\n';
  }
  return text;
}

}  // namespace mpm
