#include "results/document/document_html.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "results/document/figure_html.hpp"
#include "results/document/page_script.hpp"
#include "results/document/report_style.hpp"
#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

std::string value_html(double value, NumberForm form) {
  if (!std::isfinite(value))
    return std::isnan(value) ? "<span class=\"none\">&ndash;</span>"
           : value > 0       ? "&infin;"
                             : "&minus;&infin;";
  std::string digits;
  switch (form) {
    case NumberForm::share:
    case NumberForm::percent:
      digits = fmt::format("{:.1f}&nbsp;%", std::abs(100.0 * value));
      break;
    case NumberForm::whole_percent:
      digits = fmt::format("{:.0f}", std::abs(100.0 * value));
      break;
    case NumberForm::fixed:
      digits = fmt::format("{:.3f}", std::abs(value));
      break;
    case NumberForm::digits:
      digits = fmt::format("{:.3g}", std::abs(value));
      break;
  }
  return (value < 0.0 ? "&minus;" : "") + digits;
}

std::string cell_html(const Cell& cell) {
  const Number* const number = std::get_if<Number>(&cell.content);
  std::string html =
      number != nullptr ? number_html(*number) : words_html(std::get<std::string>(cell.content));
  html.insert(std::min(html.find("<br>"), html.size()), cell.mark);
  switch (cell.tone) {
    case Cell::Tone::plain:
      break;
    case Cell::Tone::good:
      html = "<span class=\"yes\">" + html + "</span>";
      break;
    case Cell::Tone::bad:
      html = "<span class=\"no\">" + html + "</span>";
      break;
    case Cell::Tone::strong:
      html = "<strong>" + html + "</strong>";
      break;
  }
  if (!cell.note.empty())
    html += fmt::format("{}<small>{}</small>", html.empty() ? "" : "<br>", words_html(cell.note));
  constexpr double kDeepest = 0.55;  // black text stays readable on it
  return std::isnan(cell.ground)
             ? html
             : fmt::format(
                   "<div style=\"background:rgba({},{:.3f});padding:0.2rem 0.4rem\" title=\"{}\">{}</div>",
                   cell.low_is_good ? "213,94,0" : "0,114,178", kDeepest * cell.ground, html_text(cell.hover),
                   html);
}

const char* class_of(Table::Align align) {
  switch (align) {
    case Table::Align::left:
      return "";
    case Table::Align::right:
      return " class=\"number\"";
    case Table::Align::text:
      return " class=\"text\"";
  }
  return "";
}

std::string row_html(const Table& table, const Table::Row& row) {
  if (row.is_group)
    return fmt::format("<tr class=\"group\"><th colspan=\"{}\" scope=\"rowgroup\">{}</th></tr>\n",
                       table.columns.size(), cell_html(row.cells.front()));
  std::string html = row.anchor.empty() ? "<tr>" : fmt::format("<tr id=\"{}\">", row.anchor);
  bool first = true;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].shown == Shown::text)
      continue;
    const std::string cell = i < row.cells.size() ? cell_html(row.cells[i]) : "";
    html += fmt::format("<{0}{1}{2}>{3}</{0}>", first ? "th" : "td", first ? " scope=\"row\"" : "",
                        class_of(table.columns[i].align),
                        table.wraps ? "<span class=\"wraps\">" + cell + "</span>" : cell);
    first = false;
  }
  return html + "</tr>\n";
}

std::string table_html(const Table& table) {
  std::string head, rows;
  for (const Table::Column& column : table.columns)
    if (column.shown != Shown::text)
      head += fmt::format("<th scope=\"col\"{}>{}</th>", class_of(column.align), words_html(column.title));
  for (const Table::Row& row : table.rows)
    rows += row_html(table, row);
  return scrolling_table(
      table.caption,
      fmt::format("<table aria-label=\"{}\">\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table>",
                  html_text(words_text(table.caption)), head, rows));
}

std::string paragraph_html(const Paragraph& paragraph) {
  const std::string html = words_html(paragraph.words);
  switch (paragraph.kind) {
    case Paragraph::Kind::plain:
      break;
    case Paragraph::Kind::passed:
      return "<p class=\"check passed\">" + html + "</p>\n";
    case Paragraph::Kind::failed:
      return "<p class=\"check failed\">" + html + "</p>\n";
    case Paragraph::Kind::absent:
      return "<p class=\"absent\">" + html + "</p>\n";
    case Paragraph::Kind::small:
      return "<p><small>" + html + "</small></p>\n";
  }
  return "<p>" + html + "</p>\n";
}

struct PieceHtml {
  std::string operator()(const Html& html) const { return html.text; }
  std::string operator()(const Figure& figure) const { return figure_html(figure); }
  std::string operator()(const Table& table) const { return table_html(table); }
  std::string operator()(const Paragraph& paragraph) const { return paragraph_html(paragraph); }
  std::string operator()(const Facts& facts) const {
    std::string items;
    for (const Facts::Fact& fact : facts.list)
      items +=
          fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", words_html(fact.name), words_html(fact.words),
                      fact.note.empty() ? "" : "<br><small>" + words_html(fact.note) + "</small>");
    return "<dl class=\"facts\">\n" + items + "</dl>\n";
  }
  std::string operator()(const Sentences& sentences) const {
    std::string items;
    for (const std::string& words : sentences.words)
      items += "<li>" + words_html(words) + "</li>\n";
    return "<ul>\n" + items + "</ul>\n";
  }
};

std::string sections_html(const std::vector<Section>& sections) {
  std::string html;
  int index = 0;
  for (const Section& section : sections) {
    if (section.shown == Shown::text)
      continue;
    html += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\"><span "
        "class=\"index\">{1}</span>{2}</h2>\n",
        section.id, ++index, words_html(section.title));
    if (!section.answer.empty())
      html += "<p class=\"answer\">" + words_html(section.answer) + "</p>\n";
    for (const auto& piece : section.content)
      html += std::visit(PieceHtml(), piece);
    html += "</section>\n";
  }
  return html;
}

}  // namespace

std::string number_html(const Number& number) {
  std::string html = value_html(number.value, number.form);
  if (!std::isnan(number.interval.lower)) {
    const std::string lower = value_html(number.interval.lower, number.form);
    html += fmt::format("<br><small>{} to {}</small>", lower.substr(0, lower.find("&nbsp;%")),
                        value_html(number.interval.upper, number.form));
  }
  return number.of < 0 ? html : fmt::format("{}<br><small>of {}</small>", html, number.of);
}

std::string scrolling_table(const std::string& caption, const std::string& table) {
  return fmt::format(
      "<div class=\"table\"><p class=\"caption\">{}</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" "
      "aria-label=\"{}\">{}</div></div>\n",
      words_html(caption), html_text(words_text(caption)), table);
}

std::string contents_html(const std::vector<Section>& sections) {
  std::string items;
  int index = 0;
  for (const Section& section : sections)
    if (section.shown != Shown::text)
      items += fmt::format("<li><span>{}</span><a href=\"#{}\">{}</a></li>\n", ++index, section.id,
                           words_html(section.title));
  return "<nav aria-label=\"Contents\"><ol>\n" + items + "</ol></nav>\n";
}

std::string document_html(const Document& document) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:; script-src {7}\">\n"
      "<meta name=\"generator\" content=\"mpmbench {0}\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>mpmbench: {1}</title>\n<style>{2}</style>\n</head>\n<body>\n<header>\n"
      "<p class=\"eyebrow\">mpmbench "
      "report</p>\n<h1>{3}</h1>\n<p>{4}</p>\n{10}</header>\n<main>\n{5}</main>\n{8}"
      "<footer>{6}</footer>\n<script>{9}</script>\n</body>\n</html>\n",
      html_text(document.version), html_text(document.title), kReportStyle, words_html(document.heading),
      words_html(document.lead), sections_html(document.sections), words_html(document.footer),
      page_script_policy(), document.aside_html, kPageScript, document.lead_html);
}

}  // namespace mpm
