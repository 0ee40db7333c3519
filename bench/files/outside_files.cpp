#include "bench/files/outside_files.hpp"

#include <cstddef>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/sha256.hpp"

namespace mpm {

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
