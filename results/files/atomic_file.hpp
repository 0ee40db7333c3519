#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace mpm {

/// Makes `path` a file with this content, all or nothing: the bytes go to a temporary file beside it, are
/// flushed to the disk, and the temporary file is renamed. Whoever opens `path` sees the old file or the new
/// one, also after a crash.
///
/// Throws ArchiveError when that cannot be done (no such folder, no permission, disk full); the temporary
/// file is then removed and a file that was at `path` is as it was.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content);

/// Removes the temporary files of `path` that killed processes have left beside it. No other process may be
/// writing `path`.
void remove_abandoned_files(const std::filesystem::path& path);

}  // namespace mpm
