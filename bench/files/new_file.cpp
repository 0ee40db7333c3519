#include "bench/files/new_file.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.hpp"

namespace mpm {
namespace {

[[noreturn]] void refuse_existing(const std::filesystem::path& path) {
  throw InputError(path.string(), "a file that is there", "a name for a new one");
}

}  // namespace

void require_new(const std::filesystem::path& path) {
  std::error_code no_status;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, no_status)))
    refuse_existing(path);
}

void write_new(const std::filesystem::path& path, std::string_view text) {
  constexpr mode_t kAnybody = 0666;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAnybody);
  if (file < 0 && errno == EEXIST)
    refuse_existing(path);
  bool whole = file >= 0;
  while (whole && !text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    whole = written > 0;
    if (whole)
      text.remove_prefix(static_cast<std::size_t>(written));
  }
  const int error = errno;
  if (file >= 0 && ::close(file) == 0 && whole)
    return;
  if (file >= 0)
    ::unlink(path.c_str());
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", path.string(), std::generic_category().message(error)));
}

std::string name_of_file(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; },
      '-');
  constexpr std::size_t kLongest = 64;
  return name.substr(0, kLongest);
}

}  // namespace mpm
