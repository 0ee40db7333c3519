#include "results/report/html_page.hpp"

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/page_script.hpp"
#include "results/report/report_style.hpp"

namespace mpm {

std::string html_page(const HtmlFrame& frame, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:; script-src {7}\">\n"
      "<meta name=\"generator\" content=\"mpmbench {0}\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>mpmbench: {1}</title>\n<style>{2}</style>\n</head>\n<body>\n<header>\n"
      "<p class=\"eyebrow\">mpmbench report</p>\n<h1>{3}</h1>\n{4}</header>\n<main>\n{5}</main>\n{8}"
      "<footer>{6}</footer>\n<script>{9}</script>\n</body>\n</html>\n",
      html_text(frame.version), html_text(frame.title), kReportStyle, frame.heading, frame.lead, body,
      frame.footer, page_script_policy(), frame.aside, kPageScript);
}

}  // namespace mpm
