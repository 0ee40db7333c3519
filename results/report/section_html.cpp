#include "results/report/section_html.hpp"

#include <variant>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/figure_html.hpp"

namespace mpm {

std::string sections_html(const std::vector<ReportSection>& sections) {
  std::string html;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const ReportSection& section = sections[i];
    html += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\"><span "
        "class=\"index\">{1}</span>{2}</h2>\n",
        section.id, i + 1, html_label(section.title));
    if (!section.answer.empty())
      html += "<p class=\"answer\">" + section.answer + "</p>\n";
    for (const auto& piece : section.content)
      html += std::holds_alternative<Html>(piece) ? std::get<Html>(piece).text
                                                  : figure_html(std::get<Figure>(piece));
    html += "</section>\n";
  }
  return html;
}

std::string contents_html(const std::vector<ReportSection>& sections) {
  std::string items;
  for (std::size_t i = 0; i < sections.size(); ++i)
    items += fmt::format("<li><span>{}</span><a href=\"#{}\">{}</a></li>\n", i + 1, sections[i].id,
                         html_label(sections[i].title));
  return "<nav aria-label=\"Contents\"><ol>\n" + items + "</ol></nav>\n";
}

}  // namespace mpm
