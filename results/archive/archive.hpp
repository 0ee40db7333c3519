#pragma once

#include <filesystem>

#include "results/archive/campaign.hpp"

namespace mpm {

/// Version of the archive format. A reader refuses another major version; a minor version adds to the format
/// without changing what was there.
inline constexpr int kArchiveMajorVersion = 2;
inline constexpr int kArchiveMinorVersion = 6;

/// Writes a run and its findings as an archive (docs/file_format.md): an HDF5 file that also opens as
/// netCDF-4. The file is written completely or not at all (write_file_atomically()). The data sets depend
/// only on the study and the records; whatever differs between two runs of a study (time, command, jobs) is
/// in attributes.
///
/// Errors: ArchiveError if the file cannot be written; a file that was at `path` then stays as it was.
void write_archive(const std::filesystem::path& path, const Campaign& campaign,
                   const StudyFindings& findings);

/// Reads an archive. All numbers come back bit for bit. The study is parsed again from the attribute
/// `scenario` and gets the seed in `master_seed`.
///
/// Errors: ArchiveError, which names the file and what is wrong or missing in it, if the file is no archive,
/// is incomplete or damaged, or has another major version.
Campaign read_archive(const std::filesystem::path& path);

/// Reads an archive for callers that do not need all records at once: the records stay in the file
/// (Campaign::streamed), except in a study that names its scenarios. An error in a single record is thrown
/// when that record is read.
Campaign stream_archive(const std::filesystem::path& path);

}  // namespace mpm
