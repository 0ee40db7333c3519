#include "base/system/input_file.hpp"

#include <cerrno>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

std::ifstream open_input(const std::filesystem::path& path, const std::string& allowed) {
  const auto refuse = [&](const std::string& found) { throw InputError(path.string(), found, allowed); };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    refuse("no such file");
  if (status.type() == std::filesystem::file_type::none)
    refuse(fmt::format("a file that cannot be looked at ({})", error.message()));
  if (std::filesystem::is_directory(status))
    refuse("a folder");
  if (!std::filesystem::is_regular_file(status))
    refuse("a device or a pipe");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    refuse(fmt::format("a file that cannot be opened ({})", std::generic_category().message(errno)));
  return file;
}

std::string content_of(std::istream& stream) {
  std::ostringstream content;
  content << stream.rdbuf();
  return std::move(content).str();
}

}  // namespace mpm
