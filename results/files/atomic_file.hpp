#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace mpm {

/// Makes `path` a file with this content, all or nothing: the bytes go to a temporary file beside it, are
/// flushed to the disk, and the temporary file is renamed. Whoever opens `path` sees the old file or the new
/// one, also after a crash. A link stays, and what it leads to is replaced. Temporary files of `path` that
/// killed processes have left are removed.
///
/// Throws ArchiveError when that cannot be done (no such folder, no permission, disk full, a device or a pipe
/// in its place); the temporary file is then removed and a file that was at `path` is as it was.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content);

/// The same with a file that `fill` writes, at the path that it is given: an empty file is there. What `fill`
/// throws goes on, and the temporary file is removed.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& fill);

/// The same of a text that `write` gives in pieces, so that it is not in memory as a whole.
using TextSink = std::function<void(std::string_view)>;
void write_text_atomically(const std::filesystem::path& path,
                           const std::function<void(const TextSink&)>& write);

/// Where a path leads that may be a link, also one to nothing: what write_file_atomically() replaces. Throws
/// ArchiveError for links that go in a circle.
std::filesystem::path link_target(std::filesystem::path path);

/// Removes the temporary files of `target` that killed processes have left: those that nobody has locked.
void remove_abandoned_files(const std::filesystem::path& target);

/// Whether `path` is, or leads to, something that takes bytes and is no file of ours to replace: a terminal,
/// /dev/null, a FIFO, and what this process has open already (/dev/stdout, /dev/fd/3), a file or not.
bool is_stream(const std::filesystem::path& path);

/// Writes the content into the stream `path`, and waits for the reader of a FIFO; into a file that is open
/// already, where it has been written to. Throws ArchiveError.
void write_through(const std::filesystem::path& path, std::span<const std::byte> content);

}  // namespace mpm
