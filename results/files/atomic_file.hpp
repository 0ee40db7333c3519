#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace mpm {

/// Makes `path` a file with this content, completely or not at all: the bytes go to a temporary file beside
/// it and are flushed to the disk, and the temporary file is renamed. Whoever opens `path` sees the old file
/// or the new one, even after a crash. If `path` is a link, the link stays and its target is replaced.
/// Temporary files of `path` that killed processes have left are removed.
///
/// Throws ArchiveError if that cannot be done (no such folder, no permission, disk full, a device or a pipe
/// in its place). The temporary file is then removed, and a file that was at `path` stays as it was.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content);

/// Does the same with a file that `fill` writes: it gets the path of an empty file. If `fill` throws, the
/// temporary file is removed and the exception passes on.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& fill);

/// Does the same with a text that `write` gives in pieces, so that the text is never in memory as a whole.
using TextSink = std::function<void(std::string_view)>;
void write_text_atomically(const std::filesystem::path& path,
                           const std::function<void(const TextSink&)>& write);

/// Follows links, including a link to nothing, and returns the path that write_file_atomically() replaces.
/// Throws ArchiveError if links form a circle.
std::filesystem::path link_target(std::filesystem::path path);

/// Removes the temporary files of `target` that killed processes have left: those that nobody has locked.
void remove_abandoned_files(const std::filesystem::path& target);

/// Tells whether `path` is, or leads to, something that takes bytes but is not a file to replace: a terminal,
/// /dev/null, a FIFO, or anything that this process has open already (/dev/stdout, /dev/fd/3), even a file.
bool is_stream(const std::filesystem::path& path);

/// Writes the content into the stream `path`. It waits for the reader of a FIFO. In a file that is already
/// open it continues where writing stopped. Throws ArchiveError.
void write_through(const std::filesystem::path& path, std::span<const std::byte> content);

}  // namespace mpm
