#include "results/document/figure_html.hpp"

#include <fmt/format.h>

#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// The mark of a pen in the middle of a drawing of 30 x 14 pixels.
std::string mark_svg(const Pen& pen) {
  const auto shape = [&](const char* points) {
    return fmt::format("<polygon points=\"{}\" fill=\"{}\"/>", points, pen.colour);
  };
  switch (pen.mark) {
    case Mark::none:
      return {};
    case Mark::dot:
      return fmt::format("<circle cx=\"15\" cy=\"7\" r=\"4\" fill=\"{}\"/>", pen.colour);
    case Mark::circle:
      return fmt::format(
          "<circle cx=\"15\" cy=\"7\" r=\"3.5\" fill=\"#fff\" stroke=\"{}\" stroke-width=\"1.5\"/>",
          pen.colour);
    case Mark::triangle:
      return shape("15,2 20,11 10,11");
    case Mark::square:
      return shape("11,3 19,3 19,11 11,11");
    case Mark::hollow_diamond:
      return fmt::format(
          "<polygon points=\"15,1.5 20.5,7 15,12.5 9.5,7\" fill=\"#fff\" stroke=\"{}\" "
          "stroke-width=\"1.5\"/>",
          pen.colour);
    case Mark::diamond:
      return shape("15,1.5 20.5,7 15,12.5 9.5,7");
  }
  return {};
}

std::string legend_html(const std::vector<LegendEntry>& legend) {
  std::string items;
  for (const LegendEntry& entry : legend) {
    const Pen& pen = entry.pen;
    const char* dash = pen.dash == Dash::dashed ? "7 4" : pen.dash == Dash::dotted ? "2 3" : "none";
    const std::string line =
        pen.dash == Dash::none
            ? ""
            : fmt::format("<path d=\"M1,7H29\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>",
                          pen.colour, pen.width, dash);
    items +=
        fmt::format("<li><svg viewBox=\"0 0 30 14\" aria-hidden=\"true\">{}{}</svg><span>{}</span></li>\n",
                    line, mark_svg(pen), html_label(entry.label));
  }
  return items.empty() ? items : "<ul class=\"legend\">\n" + items + "</ul>\n";
}

}  // namespace

std::string figure_html(const Figure& figure) {
  std::string html = fmt::format("<figure id=\"figure-{}\">\n{}<div class=\"panels{}\">\n", figure.name,
                                 legend_html(figure.legend),
                                 figure.panels.size() != 1                   ? ""
                                 : figure.panels.front().width > kPanelWidth ? " one wide"
                                                                             : " one");
  for (const std::string& panel : draw_panels(figure))
    html += panel;
  html += "</div>\n";
  if (!figure.caption.empty())
    html += "<figcaption>" + html_label(figure.caption) + "</figcaption>\n";
  return html + "</figure>\n";
}

}  // namespace mpm
