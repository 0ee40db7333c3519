#pragma once

#include <string>
#include <string_view>

#include "results/document/document.hpp"

namespace mpm {

/// Writes a table for a paper: a `tabular` with the rules of booktabs in small type, headings in two lines,
/// and numbers with their intervals, "89 (86--90)". `comment` (one or more lines of words) stands above it.
std::string table_latex(const Table& table, std::string_view comment);

/// Escapes words, so that LaTeX prints them as they are.
std::string words_latex(std::string_view words);

}  // namespace mpm
