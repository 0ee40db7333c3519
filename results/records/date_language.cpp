#include "results/records/date_language.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <unicode/dtfmtsym.h>
#include <unicode/locid.h>
#include <unicode/normalizer2.h>
#include <unicode/smpdtfmt.h>
#include <unicode/uchar.h>
#include <unicode/unistr.h>

#include "results/files/utf8.hpp"

namespace mpm {
namespace {

using icu::UnicodeString;

constexpr int kMonths = 12;
constexpr std::array<const char*, kMonths> kEnglishMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

/// The meaning of a word of a date. A word can have several.
struct DateMeaning {
  int month = 0;  ///< 1 to 12; 0: none
  bool weekday = false, filler = false;
  const char* half = nullptr;  ///< "AM" or "PM"
};

bool is_letter(UChar32 c) {
  return u_isalpha(c) != 0 || u_charType(c) == U_NON_SPACING_MARK ||
         u_charType(c) == U_COMBINING_SPACING_MARK;
}

/// Tells whether a character may be within a word without meaning: blanks, points, marks of text direction.
bool is_silent(UChar32 c) {
  return c == '.' || c == '\'' || u_isUWhiteSpace(c) != 0 || u_charType(c) == U_FORMAT_CHAR;
}

/// Appends a character without its case and accents. A mark alone appends nothing.
void append_folded(UnicodeString& key, UChar32 c) {
  constexpr UChar32 kDotlessI = 0x131;
  UErrorCode error = U_ZERO_ERROR;
  const icu::Normalizer2* const parts = icu::Normalizer2::getNFKDInstance(error);
  UnicodeString folded = UnicodeString(c == kDotlessI ? 'i' : c).foldCase();
  if (parts != nullptr)
    folded = parts->normalize(folded, error);
  for (int32_t at = 0; at < folded.length(); at = folded.moveIndex32(at, 1))
    if (const UChar32 part = folded.char32At(at); u_isalpha(part) != 0)
      key.append(part);
}

/// Returns the value of a digit in any script; -1 for any other character.
int digit_of(UChar32 c) {
  return u_charDigitValue(c);
}

void append_to_key(UnicodeString& key, UChar32 c) {
  if (const int digit = digit_of(c); digit >= 0)
    key.append(static_cast<UChar32>('0' + digit));
  else if (is_letter(c))
    append_folded(key, c);
}

UnicodeString key_of_name(const UnicodeString& name) {
  UnicodeString key;
  for (int32_t at = 0; at < name.length(); at = name.moveIndex32(at, 1))
    append_to_key(key, name.char32At(at));
  return key;
}

}  // namespace

class DateLanguage {
  /// A word of a text, at [begin, end), and its meaning; null: the language does not have it.
  struct Found {
    int32_t begin, end;
    const DateMeaning* meaning;
  };

 public:
  explicit DateLanguage(const icu::Locale& locale) : names_{locale.getName()} {
    UErrorCode error = U_ZERO_ERROR;
    const icu::DateFormatSymbols symbols(locale, "gregorian", error);
    if (U_FAILURE(error))
      return;
    for (const auto context : {icu::DateFormatSymbols::FORMAT, icu::DateFormatSymbols::STANDALONE})
      for (const auto width : {icu::DateFormatSymbols::WIDE, icu::DateFormatSymbols::ABBREVIATED})
        take_names(symbols, context, width);
    int32_t count = 0;
    const UnicodeString* const halves = symbols.getAmPmStrings(count);
    for (int32_t i = 0; i < std::min<int32_t>(count, 2); ++i)
      if (UnicodeString key = key_of_name(halves[i]); !key.isEmpty())
        words_[key].half = i == 0 ? "AM" : "PM";
    take_fillers(locale);
    take_beginnings();
  }

  DateLanguage() = default;

  const std::vector<std::string>& names() const { return names_; }
  void add_names_of(const DateLanguage& other) {
    names_.insert(names_.end(), other.names_.begin(), other.names_.end());
  }
  /// Adds the words of another language, so that each word has its meanings in both.
  void add_words_of(const DateLanguage& other) {
    for (const auto& [key, meaning] : other.words_) {
      DateMeaning& own = words_[key];
      own.month = std::max(own.month, meaning.month);
      own.half = own.half == nullptr ? meaning.half : own.half;
      own.weekday = own.weekday || meaning.weekday;
    }
  }
  /// Tells whether a word means a month, a day of the week, or a half of the day.
  bool tells(const UnicodeString& text) const {
    const std::vector<Found> found = words_in(text);
    return std::any_of(found.begin(), found.end(), [](const Found& word) {
      return word.meaning->month > 0 || word.meaning->half != nullptr || word.meaning->weekday;
    });
  }
  /// Returns all words as one text, by which languages are compared.
  std::string signature() const {
    std::string text;
    for (const auto& [key, meaning] : words_) {
      key.toUTF8String(text);
      text += fmt::format("={}{}{}{};", meaning.month, meaning.weekday, meaning.filler,
                          meaning.half == nullptr ? "" : meaning.half);
    }
    return text;
  }

  /// Returns the text with English words.
  std::string english(const UnicodeString& text) const;

 private:
  void take_names(const icu::DateFormatSymbols& symbols, icu::DateFormatSymbols::DtContextType context,
                  icu::DateFormatSymbols::DtWidthType width) {
    int32_t count = 0;
    const UnicodeString* names = symbols.getMonths(count, context, width);
    for (int32_t i = 0; i < std::min<int32_t>(count, kMonths); ++i)
      if (UnicodeString key = key_of_name(names[i]); !key.isEmpty())
        words_[key].month = i + 1;
    names = symbols.getWeekdays(count, context, width);
    for (int32_t i = 0; i < count; ++i)
      if (UnicodeString key = key_of_name(names[i]); !key.isEmpty())
        words_[key].weekday = true;
  }

  /// Takes the words without a meaning from the pattern of a long date and a time.
  void take_fillers(const icu::Locale& locale) {
    const std::unique_ptr<icu::DateFormat> format(
        icu::DateFormat::createDateTimeInstance(icu::DateFormat::kLong, icu::DateFormat::kShort, locale));
    const auto* const simple = dynamic_cast<const icu::SimpleDateFormat*>(format.get());
    if (simple == nullptr)
      return;
    UnicodeString pattern, word;
    simple->toPattern(pattern);
    bool quoted = false;
    for (int32_t at = 0; at <= pattern.length();
         at = at == pattern.length() ? at + 1 : pattern.moveIndex32(at, 1)) {
      const UChar32 c = at == pattern.length() ? ' ' : pattern.char32At(at);
      quoted = c == '\'' ? !quoted : quoted;
      const bool field = !quoted && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'));
      if (is_letter(c) && !field) {
        word.append(c);
        continue;
      }
      if (const UnicodeString key = key_of_name(word); !key.isEmpty())
        words_[key].filler = true;
      word.remove();
    }
  }

  /// Adds the beginnings of months, of three or more letters, that no other month has.
  void take_beginnings() {
    constexpr int32_t kFewest = 3;
    std::map<UnicodeString, std::set<int>> beginnings;
    for (const auto& [key, meaning] : words_)
      if (meaning.month > 0 && key.indexOf(static_cast<UChar32>('1')) < 0)
        for (int32_t letters = kFewest; letters < key.countChar32(); ++letters)
          beginnings[UnicodeString(key, 0, key.moveIndex32(0, letters))].insert(meaning.month);
    for (const auto& [key, months] : beginnings)
      if (months.size() == 1 && words_[key].month == 0)
        words_[key].month = *months.begin();
  }

  std::vector<Found> words_in(const UnicodeString& text) const;
  Found longest_at(const UnicodeString& text, int32_t begin) const;

  std::vector<std::string> names_;
  std::map<UnicodeString, DateMeaning> words_;
};

/// Returns the longest word that begins at `begin`.
DateLanguage::Found DateLanguage::longest_at(const UnicodeString& text, int32_t begin) const {
  constexpr int32_t kLongestKey = 40;
  Found found{begin, begin, nullptr};
  UnicodeString key;
  for (int32_t at = begin; at < text.length() && key.length() <= kLongestKey;) {
    const UChar32 c = text.char32At(at);
    const int32_t next = text.moveIndex32(at, 1);
    const bool digit = digit_of(c) >= 0;
    if (!digit && !is_letter(c) && !is_silent(c))
      break;
    append_to_key(key, c);
    const UChar32 behind = next < text.length() ? text.char32At(next) : ' ';
    const bool ends = (digit || is_letter(c)) && !is_letter(behind) && !(digit && digit_of(behind) >= 0);
    if (const auto word = ends ? words_.find(key) : words_.end(); word != words_.end())
      found = {begin, next, &word->second};
    at = next;
  }
  // A point after an abbreviated word belongs to it.
  if (found.meaning != nullptr && found.end < text.length() && text.char32At(found.end) == '.')
    ++found.end;
  return found;
}

std::vector<DateLanguage::Found> DateLanguage::words_in(const UnicodeString& text) const {
  std::vector<Found> found;
  for (int32_t at = 0; at < text.length();) {
    const UChar32 c = text.char32At(at);
    const bool digit = digit_of(c) >= 0;
    if (!digit && !is_letter(c)) {
      at = text.moveIndex32(at, 1);
      continue;
    }
    if (Found word = longest_at(text, at); word.meaning != nullptr) {
      at = word.end;
      found.push_back(word);
      continue;
    }
    while (at < text.length() && (digit ? digit_of(text.char32At(at)) >= 0 : is_letter(text.char32At(at))))
      at = text.moveIndex32(at, 1);
  }
  // If two words could be the month ("mar 5 mar 2024"), the one that can be a day of the week is one.
  const auto months =
      std::count_if(found.begin(), found.end(), [](const Found& word) { return word.meaning->month > 0; });
  static constexpr DateMeaning kWeekday{.month = 0, .weekday = true, .filler = false, .half = nullptr};
  for (Found& word : found)
    if (months > 1 && word.meaning->month > 0 && word.meaning->weekday) {
      word.meaning = &kWeekday;
      break;
    }
  return found;
}

std::string DateLanguage::english(const UnicodeString& text) const {
  std::string made, half;
  bool has_colon = false;
  const auto append = [&made](std::string_view more) {  // merges blanks, drops those before a comma
    if (more.front() == ',')
      made.erase(made.find_last_not_of(' ') + 1);
    if (more.front() == ' ' && (made.empty() || made.back() == ' '))
      more.remove_prefix(1);
    made += more;
  };
  const auto append_half = [&] { append(" " + std::exchange(half, "")); };
  const auto copy = [&](int32_t from, int32_t to) {
    for (int32_t at = from; at < to; at = text.moveIndex32(at, 1)) {
      const UChar32 c = text.char32At(at);
      const int digit = digit_of(c);
      if (!half.empty() && has_colon && digit < 0 && c != ':' && c != '.' && c != ',')
        append_half();
      has_colon = has_colon || c == ':';
      std::string one;
      if (digit >= 0)
        one = static_cast<char>('0' + digit);
      else if (u_isUWhiteSpace(c) != 0)
        one = " ";
      else if (u_charType(c) != U_FORMAT_CHAR)
        UnicodeString(c).toUTF8String(one);
      if (!one.empty())
        append(one);
    }
  };
  int32_t at = 0;
  const std::vector<Found> words = words_in(text);
  const bool has_month =
      std::any_of(words.begin(), words.end(), [](const Found& word) { return word.meaning->month > 0; });
  for (const Found& word : words) {
    copy(at, word.begin);
    at = word.end;
    const DateMeaning& meaning = *word.meaning;
    if (meaning.month > 0)
      append(kEnglishMonths[static_cast<std::size_t>(meaning.month - 1)]);
    else if (meaning.half != nullptr)
      half = meaning.half;
    else if (meaning.weekday && made.empty())
      append("Mon");
    else if (has_month && !has_colon)
      append(" ");  // part of a date in words; in other cells it may be a word of another language
    else
      copy(word.begin, word.end);
    if (!half.empty() && has_colon)
      append_half();  // otherwise it comes before its time
  }
  copy(at, text.length());
  if (!half.empty())
    append_half();
  made.erase(made.find_last_not_of(' ') + 1);
  return made;
}

namespace {

/// Returns all languages of CLDR; languages with the same words are one.
const std::vector<DateLanguage>& all_date_languages() {
  static const std::vector<DateLanguage> kAll = [] {
    std::vector<DateLanguage> all;
    std::map<std::string, std::size_t> places;
    int32_t count = 0;
    const icu::Locale* const locales = icu::Locale::getAvailableLocales(count);
    for (int32_t i = 0; i < count; ++i) {
      DateLanguage language(locales[i]);
      const auto [place, is_new] = places.emplace(language.signature(), all.size());
      if (is_new)
        all.push_back(std::move(language));
      else
        all[place->second].add_names_of(language);
    }
    return all;
  }();
  return kAll;
}

/// Returns the words of all languages together.
const DateLanguage& any_date_language() {
  static const DateLanguage kAny = [] {
    DateLanguage any;
    for (const DateLanguage& language : all_date_languages())
      any.add_words_of(language);
    return any;
  }();
  return kAny;
}

/// Returns the possible texts of a cell: in UTF-8, or else in the code pages of Windows.
std::vector<UnicodeString> decoded(std::string_view cell) {
  static constexpr std::array kCodePages{"windows-1252", "windows-1250", "windows-1251", "windows-1253",
                                         "windows-1254", "windows-1255", "windows-1256", "windows-1257",
                                         "windows-1258", "windows-874",  "windows-932",  "windows-936",
                                         "windows-949",  "windows-950"};
  if (proper_utf8(cell) == cell)
    return {UnicodeString::fromUTF8(icu::StringPiece(cell.data(), static_cast<int32_t>(cell.size())))};
  std::vector<UnicodeString> texts;
  for (const char* page : kCodePages)
    texts.emplace_back(cell.data(), static_cast<int32_t>(cell.size()), page);
  return texts;
}

}  // namespace

const std::vector<const DateLanguage*>& date_languages() {
  static const std::vector<const DateLanguage*> kPlaces = [] {
    std::vector<const DateLanguage*> places;
    for (const DateLanguage& language : all_date_languages())
      places.push_back(&language);
    return places;
  }();
  return kPlaces;
}

const std::vector<std::string>& language_names(const DateLanguage& language) {
  return language.names();
}

bool has_date_words(std::string_view cell) {
  const std::vector<UnicodeString> texts = decoded(cell);
  return std::any_of(texts.begin(), texts.end(),
                     [](const UnicodeString& each) { return any_date_language().tells(each); });
}

std::string read_in(const DateLanguage& language, const std::string& cell,
                    const std::function<bool(const std::string&)>& reads) {
  for (const UnicodeString& text : decoded(cell))
    if (std::string english = language.english(text); reads(english))
      return english;
  return "";
}

}  // namespace mpm
