#pragma once

#include <filesystem>
#include <string>

#include <toml++/toml.h>

#include "scenarios/study/study.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {

/// Applies `changes` to `target`: tables key by key, everything else as a whole.
void lay_over(toml::table& target, const toml::table& changes);

/// Takes the keys in the list `remove` of `changes` out of `study`, and lays the tables under `set` over it;
/// either may be missing. Errors: InputError "FILE:LINE: KEY: ..." for what `changes` says.
void make_changes(toml::table& study, const TomlTable& changes);

/// The study with this text, which was made of a base study and changes. `name` stands for the file in
/// messages. Errors: as parse_study().
Study study_of(const toml::table& text, const std::string& name,
               std::shared_ptr<const MethodTable> methods = {});

/// The study that the key `study` of `heading` names: a shipped one, or a file relative to `folder`. Errors:
/// InputError as find_study(), with the place of the key in front.
Study read_base_study(const TomlTable& heading, const std::filesystem::path& folder);

/// The study whose text is `base` with the keys in the list `remove` of `variant` taken out and the tables
/// under `set` laid over it key by key. `name` stands for the file in messages about what comes out.
///
/// Errors: InputError "FILE:LINE: KEY: ..." for the variant itself; for one that is no study the same with
/// `name` as the file, where LINE counts in the text of the variant.
Study read_study_variant(const TomlTable& variant, const toml::table& base, const std::string& name);

}  // namespace mpm
