#include "bench/files/output_file.hpp"

#include <span>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

void require_output_folder(const std::filesystem::path& output, std::string_view what) {
  const auto refuse = [&](const char* why) {
    throw ArchiveError(fmt::format("{}: no {} can be written: {}", output.string(), what, why));
  };
  if (is_stream(output)) {  // nothing is made in its folder, which may be anybody's, such as /dev
    if (::access(output.c_str(), W_OK) != 0)
      refuse("it is not writable");
    return;
  }
  const std::filesystem::path target = link_target(output);
  std::error_code error;  // what cannot be looked at is not there
  if (std::filesystem::is_directory(target, error))
    refuse("it is a folder");
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error))
    refuse("it is a device or a socket");
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
    refuse("its folder does not exist or is not writable");
}

void require_no_input(const std::string& option, const std::filesystem::path& output,
                      const std::vector<std::string>& inputs) {
  std::error_code error;  // an output that does not exist is none of the inputs
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, error) && !is_stream(output))
      throw InputError(option, fmt::format("{}, which the command reads", output.string()),
                       "another file: this one would be overwritten");
}

void require_output_archive(const std::filesystem::path& output, std::string_view what) {
  std::error_code error;  // what cannot be looked at is not there
  const auto status = std::filesystem::status(output, error);
  if (is_stream(output) || std::filesystem::is_block_file(status) || std::filesystem::is_socket(status))
    throw InputError("--output", fmt::format("{}, a device or a pipe", output.string()),
                     fmt::format("a regular file: the {} is read again", what));
  require_output_folder(output, what);
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

void write_text(const std::filesystem::path& output, const std::function<void(const TextSink&)>& write) {
  if (is_stream(output)) {
    std::string text;
    write([&text](std::string_view piece) { text += piece; });
    return write_text(output, text);
  }
  write_text_atomically(output, write);
}

}  // namespace mpm
