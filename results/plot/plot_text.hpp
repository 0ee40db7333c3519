#pragma once

#include <string>
#include <string_view>

namespace mpm {

// Text for figures and for the page. A label is a text in which `_{...}` is a subscript, such as "I_{MPM}";
// any foreign text (names and titles of a study) goes through as_label() before it becomes part of one.

/// Foreign text as it can be shown: proper UTF-8 in one line, without control characters.
std::string shown_text(std::string_view text);

/// `text` as a label that shows just these characters.
std::string as_label(std::string_view text);

/// A label as a string of gnuplot, quotes included. Single quotes: between them gnuplot runs no command and
/// expands no macro. An apostrophe becomes U+2019.
std::string gnuplot_label(std::string_view label);

/// A label as HTML, `I<sub>MPM</sub>`.
std::string html_label(std::string_view label);

/// A label without markup, "I_MPM".
std::string plain_label(std::string_view label);

/// `text` (not a label) for HTML, as content or within the quotes of an attribute.
std::string html_text(std::string_view text);

}  // namespace mpm
