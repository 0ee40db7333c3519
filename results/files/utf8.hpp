#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// Returns `text` as HDF5, netCDF and JSON accept it: UTF-8 without NUL. U+FFFD replaces each invalid
/// sequence of bytes and each NUL. A proper text is returned unchanged.
std::string proper_utf8(std::string_view text);

/// Returns `text` as XML 1.0 and terminals accept it, in UTF-8. U+FFFD replaces each control character (C0
/// and C1) except tab and line feed, and the non-characters U+FFFE and U+FFFF, for which XML has no escape.
/// U+FFFD also replaces the characters that turn the direction of the text after them (U+202A to U+202E,
/// U+2066 to U+2069): a name with them could make the rest of a line read as something else.
std::string plain_text(std::string_view text);

/// Tells whether a text is in UTF-16: it has a byte order mark, or exactly one of its first two bytes is NUL.
bool is_utf16(std::string_view bytes);

/// Converts a text from UTF-16 to UTF-8 and removes its byte order mark. Without a mark, the byte that is NUL
/// tells the order. U+FFFD replaces halves of characters and an odd last byte.
std::string utf8_of_utf16(std::string_view bytes);

/// Returns `text` with its ASCII capitals as small letters.
std::string in_lower_case(std::string text);

/// Returns `text` without the blanks, tabs and carriage returns around it.
std::string_view without_blanks(std::string_view text);

/// Returns the first `most` bytes of `text`, without a cut-off UTF-8 character at the end.
std::string_view cut_utf8(std::string_view text, std::size_t most);

}  // namespace mpm
