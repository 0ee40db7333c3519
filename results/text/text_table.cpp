#include "results/text/text_table.hpp"

#include <algorithm>
#include <sstream>
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

std::string wrapped(const std::string& sentence, std::size_t width, const std::string& set_in) {
  std::string text, line;
  std::istringstream words(sentence);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > width) {
      text += fmt::format("{}\n", line);
      line = set_in;
    }
    line += fmt::format("{}{}", line.empty() || line == set_in ? "" : " ", word);
  }
  return fmt::format("{}{}\n", text, line);
}

}  // namespace mpm
