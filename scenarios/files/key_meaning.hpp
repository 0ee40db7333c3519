#pragma once

#include <string>
#include <string_view>

namespace mpm {

/// What the document of the study file says of a key, as plain text; empty where it says nothing.
struct KeyMeaning {
  std::string unit;
  std::string fallback;  ///< "required", or the default
  std::string allowed;
  std::string meaning;
};

/// The pages docs/study_file*.md, one after the other.
std::string_view study_file_pages();

/// Of a key of one of study_file_tables(). The text is that of the document: there is no second one.
KeyMeaning key_meaning(std::string_view table, std::string_view key);

/// The text of a study file, as TomlDraft writes it, with a comment above each key and table, which says its
/// meaning, unit and what is allowed; of those that come several times above the first.
std::string commented_study(std::string_view text);

}  // namespace mpm
