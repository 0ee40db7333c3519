#pragma once

#include <filesystem>
#include <istream>
#include <string>

namespace mpm {

/// The text of a file, for parse_toml(). If a file is longer than kMaxTomlBytes, only one byte more than that
/// is read, which shows it. `allowed` says what the file should be. Errors: InputError for a file that cannot
/// be read.
std::string read_toml_file(const std::filesystem::path& path, const std::string& allowed);

/// The same for a stream, which is called `name` in messages.
std::string read_toml_stream(std::istream& stream, const std::string& name, const std::string& allowed);

}  // namespace mpm
