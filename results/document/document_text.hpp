#pragma once

#include <cstddef>
#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Columns.
inline constexpr std::size_t kTerminalWidth = 100;
/// Width of a table that must not be broken.
inline constexpr std::size_t kUnlimitedWidth = 10000;

/// A sentence in lines of at most `width` characters where a word allows it, all but the first set in.
std::string wrapped(const std::string& sentence, std::size_t width, const std::string& set_in = "");

/// The document for a terminal of this many columns, without figures. A table that is wider has its columns
/// one block below the other; only its texts may stick out. Sections of Shown::full are there if `full`; else
/// the last line says how to have them.
std::string document_text(const Document& document, std::size_t width = kTerminalWidth, bool full = true);

/// One table in the same way.
std::string table_text(const Table& table, std::size_t width = kTerminalWidth);

/// One number: "94.1 [90.2, 97.3]  150".
std::string number_text(const Number& number);

}  // namespace mpm
