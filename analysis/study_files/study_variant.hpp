#pragma once

#include <filesystem>
#include <string>

#include <toml++/toml.h>

#include "scenarios/study/study.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {

/// Applies `changes` to `target`. Tables are changed key by key; any other value is replaced as a whole.
void lay_over(toml::table& target, const toml::table& changes);

/// Removes the keys in the list `remove` of `changes` from `study`, and lays the tables under `set` over it;
/// either may be missing. Errors: InputError "FILE:LINE: KEY: ..." for a mistake in `changes`.
void make_changes(toml::table& study, const TomlTable& changes);

/// Reads the study in this text, which was made from a base study and changes. `name` stands for the file in
/// messages. Errors: as parse_study().
Study study_of(const toml::table& text, const std::string& name,
               std::shared_ptr<const MethodTable> methods = {});

/// Reads the study that the key `study` of `heading` names: a shipped one, or a file relative to `folder`.
/// Errors: InputError as find_study(), with the place of the key in front.
Study read_base_study(const TomlTable& heading, const std::filesystem::path& folder);

/// Returns the study whose text is `base` with the keys in the list `remove` of `variant` removed and the
/// tables under `set` laid over it key by key. `name` stands for the file in messages about the resulting
/// study.
///
/// Errors: InputError "FILE:LINE: KEY: ..." for a mistake in the variant itself. If the result is not a valid
/// study, the file is `name`, and LINE counts in the text of the variant.
Study read_study_variant(const TomlTable& variant, const toml::table& base, const std::string& name);

}  // namespace mpm
