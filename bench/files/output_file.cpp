#include "bench/files/output_file.hpp"

#include <span>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "plants/error.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"

namespace mpm {

void require_output_folder(const std::filesystem::path& output, std::string_view what) {
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (!std::filesystem::is_directory(folder) || ::access(folder.c_str(), W_OK) != 0)
    throw ArchiveError(fmt::format("{}: no {} can be written: its folder does not exist or is not writable",
                                   output.string(), what));
  if (std::filesystem::is_directory(output))
    throw ArchiveError(fmt::format("{}: no {} can be written: it is a folder", output.string(), what));
}

void require_output_archive(const std::filesystem::path& output, std::string_view what) {
  require_output_folder(output, what);
  std::error_code error;  // what cannot be looked at is not there
  if (std::filesystem::exists(output, error) && !std::filesystem::is_regular_file(output, error))
    throw InputError("--output", fmt::format("{}, a device or a pipe", output.string()),
                     fmt::format("a file: the {} is read again", what));
}

void make_output_folder(const std::filesystem::path& folder, std::string_view what) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw ArchiveError(fmt::format("{}: no {} can be written: {}", folder.string(), what, error.message()));
}

void write_text(const std::filesystem::path& output, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  if (is_stream(output))
    write_through(output, bytes);
  else
    write_file_atomically(output, bytes);
}

}  // namespace mpm
