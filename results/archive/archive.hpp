#pragma once

#include <filesystem>

#include "results/archive/campaign.hpp"

namespace mpm {

/// Version of the archive format. A reader refuses another major version; a minor version adds to the format
/// without changing what was there.
inline constexpr int kArchiveMajorVersion = 2;
inline constexpr int kArchiveMinorVersion = 6;

/// Writes a run and its findings as an archive (docs/file_format.md), all or nothing
/// (write_file_atomically()): HDF5 that also opens as netCDF-4. The data sets depend on the study and the
/// records only; what differs between two runs of a study (time, command, jobs) is in attributes.
///
/// Errors: ArchiveError when the file cannot be written; what was at `path` is then as it was.
void write_archive(const std::filesystem::path& path, const Campaign& campaign,
                   const StudyFindings& findings);

/// Reads an archive. All numbers come back bit for bit; the study is read again from the attribute `scenario`
/// and gets the seed in `master_seed`.
///
/// Errors: ArchiveError, which names the file and what is wrong or missing in it, for a file that is no
/// archive, is not whole, is damaged, or has another major version.
Campaign read_archive(const std::filesystem::path& path);

/// The same, for callers that do not need all records at once: except in a study that names its scenarios,
/// they stay in the file (Campaign::streamed). What is wrong in a single one is thrown when it is read.
Campaign stream_archive(const std::filesystem::path& path);

}  // namespace mpm
