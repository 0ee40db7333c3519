#pragma once

#include <string>

namespace mpm {

/// What stands around the body of a page. All but `title` and `version` are HTML.
struct HtmlFrame {
  std::string title;    ///< after "mpmbench: " in the title bar, as text
  std::string heading;  ///< <h1>
  std::string lead;     ///< the paragraph below it, and what follows in the header
  std::string footer;
  std::string version;     ///< of the program that made the numbers, as text
  std::string aside = {};  ///< beside the body where there is room, below it elsewhere
};

/// A whole page in the style of the report that needs nothing else: no network, and one script of its own,
/// without which it is complete. A policy in its head keeps that promise.
std::string html_page(const HtmlFrame& frame, const std::string& body);

}  // namespace mpm
