#pragma once

#include <string>
#include <string_view>

// The marks in the words of a document, which its writers interpret. Foreign text has no marks: as_label()
// removes its control characters.

namespace mpm {

inline constexpr char kStrong = 1, kStrongEnd = 2, kCode = 3, kCodeEnd = 4, kLink = 5, kLinkTarget = 6,
                      kLinkEnd = 7;

/// Returns words as HTML.
std::string words_html(std::string_view words);
/// Returns words without marks.
std::string words_text(std::string_view words);

}  // namespace mpm
