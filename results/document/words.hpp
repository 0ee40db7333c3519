#pragma once

#include <string>
#include <string_view>

// The marks in the words of a document, which its writers take apart. Foreign text has none: as_label() takes
// control characters away.

namespace mpm {

inline constexpr char kStrong = 1, kStrongEnd = 2, kCode = 3, kCodeEnd = 4, kLink = 5, kLinkTarget = 6,
                      kLinkEnd = 7;

/// Words as HTML.
std::string words_html(std::string_view words);
/// Words without marks.
std::string words_text(std::string_view words);

}  // namespace mpm
