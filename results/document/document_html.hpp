#pragma once

#include <string>
#include <vector>

#include "results/document/document.hpp"

namespace mpm {

/// Writes the document as a self-contained page: no network, figures as SVG, and one script of its own. The
/// page is complete without the script. A policy in its head enforces this. Errors: GnuplotError.
std::string document_html(const Document& document);

/// Writes a number, with its interval and count below it in small type.
std::string number_html(const Number& number);

/// Puts a whole <table> element in a box that scrolls by itself on a narrow screen. The caption (words) above
/// it does not scroll.
std::string scrolling_table(const std::string& caption, const std::string& table);

/// Writes links to the sections.
std::string contents_html(const std::vector<Section>& sections);

}  // namespace mpm
