#pragma once

#include <filesystem>
#include <string_view>

namespace mpm {

/// Refuses an output that is sure to fail before work is spent on it; `what` is to be written. Throws
/// ArchiveError.
void require_output_folder(const std::filesystem::path& output, std::string_view what);

/// The same for an archive: InputError for a device or a pipe.
void require_output_archive(const std::filesystem::path& output, std::string_view what);

/// Makes the folder unless it is there; `what` are to be written into it. Throws ArchiveError.
void make_output_folder(const std::filesystem::path& folder, std::string_view what);

/// Writes a page, a table or another text, all or nothing; through a device or a pipe where
/// `output` is one. Throws ArchiveError when it cannot be written.
void write_text(const std::filesystem::path& output, std::string_view text);

}  // namespace mpm
