#include "results/files/foreign_content.hpp"

#include <cstdint>
#include <fstream>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/system/input_file.hpp"

namespace mpm {
namespace {

constexpr std::uintmax_t kMostBytes = 2'000'000'000;

}  // namespace

std::string foreign_content(const std::filesystem::path& path, const std::string& allowed) {
  std::ifstream file = open_input(path, allowed);
  if (const std::uintmax_t bytes = std::filesystem::file_size(path); bytes > kMostBytes)
    throw InputError(path.string(), fmt::format("a file of {} bytes", bytes),
                     fmt::format("at most {} bytes: use a shorter period, or fewer columns", kMostBytes));
  return content_of(file);
}

}  // namespace mpm
