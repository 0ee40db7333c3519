#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The date words of one language of CLDR, or of several languages that share the same words.
class DateLanguage;

/// Returns all languages of CLDR; languages with the same words are one.
const std::vector<const DateLanguage*>& date_languages();

/// Returns names such as "it" or "pt_BR".
const std::vector<std::string>& language_names(const DateLanguage& language);

/// Returns a cell with English words in place of those of the language. Tries the code pages in turn and
/// takes the first in which `reads` can read the cell; empty if there is none.
std::string read_in(const DateLanguage& language, const std::string& cell,
                    const std::function<bool(const std::string&)>& reads);

/// Tells whether a word of the cell means a month, a day of the week, or a half of the day (AM or PM) in any
/// language.
bool has_date_words(std::string_view cell);

}  // namespace mpm
