#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/files/atomic_file.hpp"

namespace mpm {

/// Refuses an output that is sure to fail before work is spent on it; `what` is to be written, and a device
/// or a pipe takes it. Throws ArchiveError.
void require_output_folder(const std::filesystem::path& output, std::string_view what);

/// Refuses an output that would replace one of the files that the command reads; `option` names it. Throws
/// InputError.
void require_no_input(const std::string& option, const std::filesystem::path& output,
                      const std::vector<std::string>& inputs);

/// The same for an archive: InputError for a device or a pipe.
void require_output_archive(const std::filesystem::path& output, std::string_view what);

/// Makes the folder unless it is there; `what` are to be written into it. Throws ArchiveError.
void make_output_folder(const std::filesystem::path& folder, std::string_view what);

/// Writes a page, a table or another text, all or nothing; through a device or a pipe where
/// `output` is one. Throws ArchiveError when it cannot be written.
void write_text(const std::filesystem::path& output, std::string_view text);
/// The same of a text that `write` gives in pieces, which no file but a device or a pipe needs in memory.
void write_text(const std::filesystem::path& output, const std::function<void(const TextSink&)>& write);

}  // namespace mpm
