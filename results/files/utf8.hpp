#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// `text` as HDF5, netCDF and JSON take it: UTF-8 without NUL. Each sequence of bytes that is none of UTF-8,
/// and each NUL, is replaced by U+FFFD; a proper text comes back as it is.
std::string proper_utf8(std::string_view text);

/// `text` as XML 1.0 and a terminal take it: UTF-8 in which each control character (C0 and C1) but tab and
/// line feed, and each of the non-characters U+FFFE and U+FFFF, is replaced by U+FFFD. No escape of XML can
/// stand for these. So is what turns the direction of the text behind it (U+202A to U+202E, U+2066 to
/// U+2069): a name could make the rest of a line read as something else.
std::string plain_text(std::string_view text);

/// Is it a text in UTF-16: with its byte order mark, or with a NUL as one of its first two bytes?
bool is_utf16(std::string_view bytes);

/// A text in UTF-16 as UTF-8, without its byte order mark; without one the byte that is NUL tells the order.
/// Halves of characters are replaced by U+FFFD, and so is a last odd byte.
std::string utf8_of_utf16(std::string_view bytes);

/// The same with small letters instead of the capitals of ASCII.
std::string in_lower_case(std::string text);

/// Without the blanks, tabs and carriage returns around it.
std::string_view without_blanks(std::string_view text);

/// The first `most` bytes of `text`, less what would be half a character of UTF-8.
std::string_view cut_utf8(std::string_view text, std::size_t most);

}  // namespace mpm
