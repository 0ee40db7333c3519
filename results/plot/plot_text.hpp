#pragma once

#include <string>
#include <string_view>

namespace mpm {

// Text for figures and pages. A label is a text in which `_{...}` is a subscript, such as "I_{MPM}". Any
// foreign text (names and titles of a study) must pass through as_label() before it becomes part of a label.

/// Returns foreign text in a form that can be shown: proper UTF-8 in one line, without control characters.
std::string shown_text(std::string_view text);

/// Returns `text` as a label that shows exactly these characters.
std::string as_label(std::string_view text);

/// Returns a label as a gnuplot string with its quotes. These are single quotes: between them gnuplot runs no
/// command and expands no macro. An apostrophe becomes U+2019.
std::string gnuplot_label(std::string_view label);

/// Returns a label as HTML, such as `I<sub>MPM</sub>`.
std::string html_label(std::string_view label);

/// Returns a label without markup, such as "I_MPM".
std::string plain_label(std::string_view label);

/// Escapes `text` (not a label) for HTML, as content or within the quotes of an attribute.
std::string html_text(std::string_view text);

}  // namespace mpm
