#include "results/document/words.hpp"

#include "results/plot/plot_text.hpp"

namespace mpm {

std::string words_html(std::string_view words) {
  std::string html;
  for (const char c : html_label(words))
    switch (c) {
      case kStrong:
        html += "<strong>";
        break;
      case kStrongEnd:
        html += "</strong>";
        break;
      case kCode:
        html += "<code>";
        break;
      case kCodeEnd:
        html += "</code>";
        break;
      case kLink:
        html += "<a href=\"#";
        break;
      case kLinkTarget:
        html += "\">";
        break;
      case kLinkEnd:
        html += "</a>";
        break;
      default:
        html += c;
    }
  return html;
}

std::string words_text(std::string_view words) {
  std::string text;
  bool target = false;
  for (const char c : plain_label(words)) {
    target = c == kLink || (target && c != kLinkTarget);
    if (!target && (c < kStrong || c > kLinkEnd))
      text += c;
  }
  return text;
}

}  // namespace mpm
