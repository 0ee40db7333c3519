#pragma once

#include <string>
#include <string_view>

#include "results/document/document.hpp"

namespace mpm {

/// A table for a paper: a `tabular` with the rules of booktabs in small type, headings in two lines, numbers
/// with their intervals, "89 (86--90)". `comment`, words of one or more lines, stands above it.
std::string table_latex(const Table& table, std::string_view comment);

/// Words that mean themselves in LaTeX.
std::string words_latex(std::string_view words);

}  // namespace mpm
