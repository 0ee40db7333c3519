#include "results/plot/svg_text.hpp"

#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "results/plot/gnuplot.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// The elements to remove: gnuplot's own titles and descriptions (it calls its series "gnuplot_plot_1"),
/// unused effects, and empty groups.
constexpr const char* kWaste = "//title | //desc | //filter | //g[not(@id) and not(*)]";

void remove_waste(const pugi::xml_document& drawing) {
  for (const pugi::xpath_node& found : drawing.select_nodes(kWaste))
    found.parent().remove_child(found.node());
}

void put_before_ids(const pugi::xml_document& drawing, const std::string& id) {
  for (const pugi::xpath_node& found : drawing.select_nodes("//@id"))
    found.attribute() = fmt::format("{}-{}", id, found.attribute().value()).c_str();
  for (const pugi::xpath_node& found : drawing.select_nodes("//@xlink:href"))
    if (const std::string_view target = found.attribute().value(); target.starts_with('#'))
      found.attribute() = fmt::format("#{}-{}", id, target.substr(1)).c_str();
}

/// Returns the hypertext of a point, which gnuplot writes as gnuplot_svg.showHypertext(evt,'...').
std::string hypertext(std::string_view call) {
  const std::size_t begin = call.find('\'');
  const std::size_t end = call.rfind('\'');
  return begin == end ? std::string() : std::string(call.substr(begin + 1, end - begin - 1));
}

/// Makes the content of a point a link. The keyboard skips it: keyboard users reach its row in the table
/// without passing hundreds of points.
void link_point(pugi::xml_node point, const std::string& anchor) {
  pugi::xml_node link = point.append_child("a");
  link.append_attribute("href") = ("#" + anchor).c_str();
  link.append_attribute("tabindex") = "-1";
  while (point.first_child() != link)
    link.append_move(point.first_child());
}

void name_points(const pugi::xml_document& drawing, const SvgText& text) {
  for (const pugi::xpath_node& found : drawing.select_nodes("//g[@onmousemove]")) {
    pugi::xml_node point = found.node();
    const std::string key = hypertext(point.attribute("onmousemove").value());
    const auto name = text.names.find(key);
    point.remove_attributes();
    point.append_attribute("class") = "point";
    point.prepend_child("title").text() = shown_text(name == text.names.end() ? key : name->second).c_str();
    if (const auto anchor = text.anchors.find(key); anchor != text.anchors.end())
      link_point(point, anchor->second);
  }
}

/// Replaces the attributes of a drawing by those that it needs in a page, and adds its description.
void describe(pugi::xml_node svg, const std::string& description) {
  std::istringstream box(svg.attribute("viewBox").value());
  std::string left, top, width, height;
  box >> left >> top >> width >> height;
  svg.remove_attributes();
  svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
  svg.append_attribute("xmlns:xlink") = "http://www.w3.org/1999/xlink";
  svg.append_attribute("width") = width.c_str();
  svg.append_attribute("height") = height.c_str();
  svg.append_attribute("viewBox") = fmt::format("{} {} {} {}", left, top, width, height).c_str();
  svg.append_attribute("role") = "img";
  svg.append_attribute("aria-label") = shown_text(description).c_str();
}

}  // namespace

std::string svg_element(const std::string& drawing, const SvgText& text) {
  pugi::xml_document document;
  // Blanks are kept, because a text may consist of blanks; between elements they mean nothing.
  const auto parsed =
      document.load_buffer(drawing.data(), drawing.size(), pugi::parse_default | pugi::parse_ws_pcdata_single,
                           pugi::encoding_utf8);
  const pugi::xml_node svg = document.child("svg");
  if (!parsed || !svg.attribute("viewBox"))
    throw GnuplotError("gnuplot drew something that is no SVG");

  remove_waste(document);
  put_before_ids(document, text.id);
  name_points(document, text);
  describe(svg, text.description);
  std::ostringstream element;
  svg.print(element, "", pugi::format_raw, pugi::encoding_utf8);
  return element.str();
}

}  // namespace mpm
