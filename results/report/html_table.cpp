#include "results/report/html_table.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

constexpr const char* kNothing = "<span class=\"none\">&ndash;</span>";

const char* class_of(HtmlTable::Align align) {
  switch (align) {
    case HtmlTable::Align::left:
      return "";
    case HtmlTable::Align::right:
      return " class=\"number\"";
    case HtmlTable::Align::text:
      return " class=\"text\"";
  }
  return "";
}

}  // namespace

std::string without_tags(const std::string& html) {
  std::string text;
  bool tag = false;
  for (const char c : html) {
    tag = tag || c == '<';
    if (!tag)
      text += c;
    tag = tag && c != '>';
  }
  return text;
}

std::string scrolling_table(const std::string& caption, const std::string& table) {
  return fmt::format(
      "<div class=\"table\"><p class=\"caption\">{}</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" "
      "aria-label=\"{}\">{}</div></div>\n",
      caption, without_tags(caption), table);
}

std::string html_number(double value, bool share) {
  if (!std::isfinite(value))
    return std::isnan(value) ? kNothing : value > 0 ? "&infin;" : "&minus;&infin;";
  const double shown = share ? 100.0 * value : value;
  const std::string digits =
      share ? fmt::format("{:.1f}&nbsp;%", std::abs(shown)) : fmt::format("{:.3f}", std::abs(shown));
  return (std::signbit(shown) && shown != 0.0 ? "&minus;" : "") + digits;
}

std::string html_interval(const Interval& interval, bool share) {
  if (std::isnan(interval.lower) || std::isnan(interval.upper))
    return kNothing;
  if (share)
    return fmt::format("{:.1f} to {:.1f}&nbsp;%", 100.0 * interval.lower, 100.0 * interval.upper);
  return html_number(interval.lower) + " to " + html_number(interval.upper);
}

HtmlTable::HtmlTable(std::string caption, std::vector<Column> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {}

void HtmlTable::row(const std::vector<std::string>& cells, const std::string& anchor) {
  rows_ += anchor.empty() ? "<tr>" : fmt::format("<tr id=\"{}\">", anchor);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::string cell = i < cells.size() ? cells[i] : "";
    rows_ += i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", class_of(columns_[i].align), cell)
                    : fmt::format("<td{}>{}</td>", class_of(columns_[i].align), cell);
  }
  rows_ += "</tr>\n";
}

void HtmlTable::group(const std::string& title) {
  rows_ += fmt::format("<tr class=\"group\"><th colspan=\"{}\" scope=\"rowgroup\">{}</th></tr>\n",
                       columns_.size(), title);
}

std::string HtmlTable::html() const {
  std::string head;
  for (const Column& column : columns_)
    head += fmt::format("<th scope=\"col\"{}>{}</th>", class_of(column.align), column.title);
  return scrolling_table(caption_,
                         fmt::format("<table aria-label=\"{}\">\n<thead><tr>{}</tr></thead>\n<tbody>\n{}"
                                     "</tbody></table>",
                                     without_tags(caption_), head, rows_));
}

}  // namespace mpm
