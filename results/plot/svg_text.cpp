#include "results/plot/svg_text.hpp"

#include <string_view>

#include <fmt/format.h>

#include "results/plot/gnuplot.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// What stands between `open` and `close`, from `from` on; empty when that is not there.
std::string_view between(std::string_view text, std::string_view open, std::string_view close) {
  const std::size_t begin = text.find(open);
  if (begin == std::string_view::npos)
    return {};
  const std::size_t end = text.find(close, begin + open.size());
  if (end == std::string_view::npos)
    return {};
  return text.substr(begin + open.size(), end - begin - open.size());
}

/// `text` with every `open`...`close` replaced by what `replacement` makes of the part between.
template <class Replacement>
std::string replaced(std::string_view text, std::string_view open, std::string_view close,
                     Replacement replacement) {
  std::string result;
  for (;;) {
    const std::size_t begin = text.find(open);
    const std::size_t end = begin == std::string_view::npos ? begin : text.find(close, begin + open.size());
    if (end == std::string_view::npos)
      return result.append(text);
    result.append(text.substr(0, begin));
    result.append(replacement(text.substr(begin + open.size(), end - begin - open.size())));
    text.remove_prefix(end + close.size());
  }
}

std::string without(std::string_view text, std::string_view open, std::string_view close) {
  return replaced(text, open, close, [](std::string_view) { return std::string_view(); });
}

std::string exchanged(std::string_view text, std::string_view from, std::string_view to) {
  return replaced(text, from, "", [&](std::string_view) { return to; });
}

/// Without titles and descriptions of gnuplot's own (its series would all be called "gnuplot_plot_1"),
/// effects that are not used, and groups that hold nothing.
std::string without_waste(std::string_view drawing) {
  std::string text = without(drawing, "<title>", "</title>");
  text = without(text, "<desc>", "</desc>");
  text = without(text, "<filter ", "</filter>");
  for (const char* colour : {"black", "white"})
    text =
        exchanged(text,
                  fmt::format("<g fill=\"none\" color=\"{}\" stroke=\"currentColor\" stroke-width=\"1.00\" "
                              "stroke-linecap=\"butt\" stroke-linejoin=\"miter\">\n</g>\n",
                              colour),
                  "");
  return text;
}

}  // namespace

std::string svg_element(const std::string& drawing, const SvgText& text) {
  const std::string_view box = between(drawing, "viewBox=\"0 0 ", "\"");
  const std::size_t blank = box.find(' ');
  const std::size_t tag = drawing.find("<svg");
  const std::size_t body = drawing.find('>', tag);
  if (blank == std::string_view::npos || tag == std::string::npos || body == std::string::npos)
    throw GnuplotError("gnuplot drew something that is no SVG");

  std::string content = without_waste(std::string_view(drawing).substr(body + 1));
  for (const char* quote : {"\"", "'"})  // in this order: new ids have double quotes
    content = replaced(content, fmt::format(" id={}", quote), quote,
                       [&](std::string_view id) { return fmt::format(" id=\"{}-{}\"", text.id, id); });
  content = exchanged(content, "xlink:href='#", fmt::format("xlink:href='#{}-", text.id));
  content = replaced(content, "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'",
                     "')\" onmouseout=\"gnuplot_svg.hideHypertext()\">", [&](std::string_view key) {
                       const auto name = text.names.find(std::string(key));
                       return fmt::format("<g class=\"point\"><title>{}</title>",
                                          html_text(name == text.names.end() ? key : name->second));
                     });
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "width=\"{}\" height=\"{}\" viewBox=\"0 0 {}\" role=\"img\" aria-label=\"{}\">{}",
      box.substr(0, blank), box.substr(blank + 1), box, html_text(text.description), content);
}

}  // namespace mpm
