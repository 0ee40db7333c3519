#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/files/atomic_file.hpp"

namespace mpm {

/// Refuses an output that is sure to fail, before work is spent on it. `what` is to be written; the output
/// may be a device or a pipe. Throws ArchiveError.
void require_output_folder(const std::filesystem::path& output, std::string_view what);

/// Refuses an output that would replace one of the files that the command reads; `option` names it. Throws
/// InputError.
void require_no_input(const std::string& option, const std::filesystem::path& output,
                      const std::vector<std::string>& inputs);

/// require_output_folder() for an archive, and InputError for a device or a pipe.
void require_output_archive(const std::filesystem::path& output, std::string_view what);

/// Makes the folder unless it is there; `what` names the files to be written into it. Throws ArchiveError.
void make_output_folder(const std::filesystem::path& folder, std::string_view what);

/// Writes a page, a table or another text, all or nothing; through a device or a pipe if `output` is one.
/// Throws ArchiveError if it cannot be written.
void write_text(const std::filesystem::path& output, std::string_view text);
/// The same for a text that `write` gives in pieces. Only a device or a pipe needs all of the text in memory.
void write_text(const std::filesystem::path& output, const std::function<void(const TextSink&)>& write);

}  // namespace mpm
