#include "bench/files/outside_files.hpp"

#include <cstddef>
#include <fstream>
#include <span>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/files/sha256.hpp"

namespace mpm {
namespace {

constexpr std::size_t kDigits = 16;  // enough against accidents, and short enough for a message

}  // namespace

std::string digest_of(std::string_view content) {
  return sha256(std::as_bytes(std::span(content))).substr(0, kDigits);
}

// In pieces: an archive with its loops may be longer than the memory.
std::string digest_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 16);
  Sha256 hash;
  do {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add(std::as_bytes(std::span(piece).first(static_cast<std::size_t>(file.gcount()))));
  } while (file);
  return hash.digits().substr(0, kDigits);
}

std::string command_identity(const std::vector<std::string>& command) {
  std::vector<std::string> files;
  for (std::size_t i = 0; i < command.size(); ++i) {
    std::error_code no_status;
    const bool is_named_by_path = i > 0 || command[i].find('/') != std::string::npos;
    if (is_named_by_path && std::filesystem::is_regular_file(command[i], no_status))
      files.push_back(fmt::format("{} {}", command[i], digest_of_file(command[i])));
  }
  const std::string words = fmt::format("{}", fmt::join(command, " "));
  return files.empty() ? words : fmt::format("{} ({})", words, fmt::join(files, ", "));
}

std::string outside_files(const Study& study) {
  std::vector<std::string> parts;
  if (study.nonlinear && study.nonlinear->model.foreign) {
    const ForeignModel& plant = *study.nonlinear->model.foreign;
    if (const std::filesystem::path file = plant.file(); !file.empty())
      parts.push_back(fmt::format("plant.fmu {} {}", file.filename().string(), digest_of_file(file)));
    else
      parts.push_back(fmt::format("plant.program {}", command_identity(plant.command())));
  }
  if (study.controller_program)
    parts.push_back(
        fmt::format("controller.program {}", command_identity(study.controller_program->command())));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace mpm
