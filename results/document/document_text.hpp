#pragma once

#include <cstddef>
#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Default width in columns.
inline constexpr std::size_t kTerminalWidth = 100;
/// Width of a table that must not be broken.
inline constexpr std::size_t kUnlimitedWidth = 10000;

/// Breaks a sentence into lines of at most `width` characters where words allow it. All lines but the first
/// begin with `set_in`.
std::string wrapped(const std::string& sentence, std::size_t width, const std::string& set_in = "");

/// Writes the document for a terminal of `width` columns, without figures. A wider table has its columns in
/// blocks, one below the other; only its texts may stick out. Sections of Shown::full are included if `full`;
/// otherwise the last line says how to get them.
std::string document_text(const Document& document, std::size_t width = kTerminalWidth, bool full = true);

/// Writes one table in the same way.
std::string table_text(const Table& table, std::size_t width = kTerminalWidth);

/// Writes one number: "94.1 [90.2, 97.3]  150".
std::string number_text(const Number& number);

}  // namespace mpm
