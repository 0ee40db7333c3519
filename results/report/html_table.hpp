#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// A number with three decimals, a share as a percentage with one; a dash when it does not exist.
std::string html_number(double value, bool share = false);
/// "0.1 to 0.2", "10.0 to 20.0 %"; a dash when it does not exist.
std::string html_interval(const Interval& interval, bool share = false);

/// HTML without its tags, for the labels that assistive technology reads out.
std::string without_tags(const std::string& html);

/// A table in a box that scrolls by itself on a narrow screen, under a caption that does not: `table` is the
/// whole <table> element.
std::string scrolling_table(const std::string& caption, const std::string& table);

/// A table of cells. All texts are HTML.
class HtmlTable {
 public:
  enum class Align { left, right, text };  ///< text: left, and wide enough for a sentence
  struct Column {
    std::string title;
    Align align = Align::right;
  };

  HtmlTable(std::string caption, std::vector<Column> columns);

  /// One cell a column; the first is the heading of its row. Fewer cells leave the last ones empty.
  /// `anchor`: by which links find the row; empty: none.
  void row(const std::vector<std::string>& cells, const std::string& anchor = {});
  /// A heading across all columns.
  void group(const std::string& title);
  std::string html() const;

 private:
  std::string caption_;
  std::vector<Column> columns_;
  std::string rows_;
};

}  // namespace mpm
