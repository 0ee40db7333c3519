#pragma once

#include <string>
#include <vector>

#include "results/document/document.hpp"

namespace mpm {

/// The document as a page that needs nothing else: no network, figures as SVG, and one script of its own,
/// without which it is complete. A policy in its head keeps that promise. Errors: GnuplotError.
std::string document_html(const Document& document);

/// A number with its interval and count below it in small type.
std::string number_html(const Number& number);

/// A whole <table> element in a box that scrolls by itself on a narrow screen, under a caption (words) that
/// does not.
std::string scrolling_table(const std::string& caption, const std::string& table);

/// Links to the sections.
std::string contents_html(const std::vector<Section>& sections);

}  // namespace mpm
