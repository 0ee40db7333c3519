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
/// Every key is checked. Refuses an unknown or missing key, a wrong type, a number that is not finite, and a
/// value with which the study makes no sense.
///
/// Errors: InputError whose text is "FILE:LINE: KEY: found ...; allowed: ...". LINE is the line of the value;
/// for a missing key, that of its table; for a text that is not valid TOML, the line where the parser
/// stopped.
///
/// `methods` are the methods that the study may name and set options of (default: those of this program).
Study parse_study(std::string_view text, const std::string& file_name,
                  std::shared_ptr<const MethodTable> methods = {});

/// Reads a study file of the user, whose programs may be started from now on (study_programs.hpp). Also loads
/// the FMU of its plant, if it has one. parse_study() leaves this until a loop is simulated, so that an
/// archive can be read without the FMU. Errors: as parse_study(), as ForeignModel::load(), and InputError for
/// a file that cannot be read.
Study load_study(const std::filesystem::path& path);

/// Reads the study from a stream, which is called `name` in messages. Paths in the study are relative to the
/// current folder.
Study load_study(std::istream& stream, const std::string& name,
                 std::shared_ptr<const MethodTable> methods = {});

}  // namespace mpm
