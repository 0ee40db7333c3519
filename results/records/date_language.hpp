#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The words of the dates of one language of CLDR, or of several in which they are the same.
class DateLanguage;

/// Those of CLDR, each kind of words once.
const std::vector<const DateLanguage*>& date_languages();

/// Such as "it" or "pt_BR".
const std::vector<std::string>& language_names(const DateLanguage& language);

/// A cell with English words instead of those of the language, by the first code page in which it can be
/// read; empty: by none.
std::string read_in(const DateLanguage& language, const std::string& cell,
                    const std::function<bool(const std::string&)>& reads);

/// Does a word of the cell say the month, the day of the week or which half of the day it is, in any
/// language?
bool has_date_words(std::string_view cell);

}  // namespace mpm
