#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// Cells with dates in a language of CLDR, as written_date() reads them: names of months and days, words for
/// before and after noon (also in front of the time), words between the parts ("2 de agosto de 2024") and
/// digits become those of English. Capitals, accents and points count for nothing, and three letters or more
/// of a month stand for it where no other month begins so. Bytes that are no UTF-8 are read in the code pages
/// of Windows.
///
/// `language` is a name such as "it" or "pt_BR"; empty: the one in which `reads` reads the most cells. Where
/// languages differ on what a cell says, that of four times as many regions as all others together is taken.
/// None where English reads all of them, and where no language reads one. Errors: InputError at `place` for a
/// language that CLDR does not have, and where languages differ and nothing decides.
std::optional<std::vector<std::string>> dates_in_english(
    const std::vector<std::string>& cells, const std::string& language, const std::string& place,
    const std::function<bool(const std::string&)>& reads);

/// Is there a date in this cell, in any language?
bool is_date(std::string_view cell);
/// Is there a time of day without a date?
bool is_time_of_day(std::string_view cell);

}  // namespace mpm
