#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// Translates cells with dates in a language of CLDR into the form that written_date() reads. It puts English
/// in place of names of months and days, words for before and after noon (also in front of the time), words
/// between the parts ("2 de agosto de 2024") and digits. Capitals, accents and points do not matter. Three or
/// more letters stand for a month if no other month begins with them. Bytes that are no UTF-8 are read in the
/// code pages of Windows.
///
/// `language` is a name such as "it" or "pt_BR". If it is empty, the language is used in which `reads` reads
/// the most cells. If languages differ on the meaning of a cell, a meaning counts if at least four times as
/// many regions have it as all others together. Returns none if English reads all cells, or if no language
/// reads any. Errors: InputError at `place` if CLDR does not have the language, or if languages differ and
/// nothing decides.
std::optional<std::vector<std::string>> dates_in_english(
    const std::vector<std::string>& cells, const std::string& language, const std::string& place,
    const std::function<bool(const std::string&)>& reads);

/// Tells whether the cell has a date, in any language.
bool is_date(std::string_view cell);
/// Tells whether the cell has a time of day without a date.
bool is_time_of_day(std::string_view cell);

}  // namespace mpm
