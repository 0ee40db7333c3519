#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

#include "scenarios/study/study.hpp"

namespace mpm {

/// Reads a study from the text of a study file (docs/study_file.md). `file_name` is for messages.
///
/// Every key is checked: an unknown one, a missing one, a wrong type, a number that is not finite and a value
/// that makes no study are refused.
///
/// Errors: InputError whose text is "FILE:LINE: KEY: found ...; allowed: ...". LINE is the line of the value,
/// for a missing key that of its table, and for a text that is no TOML the one where the parser stopped.
///
/// `methods` are those that the study may name and have options of; none: those of this program.
Study parse_study(std::string_view text, const std::string& file_name,
                  std::shared_ptr<const MethodTable> methods = {});

/// Reads a study file of the user, whose programs may be started from now on (study_programs.hpp), and the
/// FMU of its plant if it has one, which parse_study() leaves until a loop is simulated: an archive can be
/// read without it. Errors: as parse_study(), as ForeignModel::load(), and InputError for a file that cannot
/// be read.
Study load_study(const std::filesystem::path& path);

/// The same from a stream that has this name in messages; paths in the study are from the current folder.
Study load_study(std::istream& stream, const std::string& name,
                 std::shared_ptr<const MethodTable> methods = {});

}  // namespace mpm
