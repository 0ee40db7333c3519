#pragma once

#include <filesystem>

#include "scenarios/study/study.hpp"

namespace mpm {

/// What becomes of a file at the path of an output if it cannot be read as an archive.
enum class Unreadable { kept, replaced };

/// Refuses to replace the archive of another study or seed and, if `unreadable` is `kept`, a file that this
/// program cannot read as an archive. An empty file counts as no file. `study` is that of the new archive,
/// with its seed, as study_to_run() gives it. An archive of the same study and seed may be replaced: it can
/// be made again by the same command. Throws InputError, which says what is there and names `--overwrite`.
void require_replaceable(const std::filesystem::path& output, const Study& study,
                         Unreadable unreadable = Unreadable::kept);

}  // namespace mpm
