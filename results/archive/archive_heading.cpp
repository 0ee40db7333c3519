#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/resolved_study.hpp"
#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr const char* kFileType = "mpmbench archive";
constexpr const char* kConventions = "CF-1.8";

/// For an archive of an earlier format, returns the command that made it and can make it again.
std::string how_to_make_anew(const Hdf5Group& root, const std::vector<std::int32_t>& version) {
  if (version.empty() || version.front() >= kArchiveMajorVersion)
    return "";
  return fmt::format("; to make it again with this program: {}", root.attribute<std::string>("command"));
}

void require_archive(const Hdf5Group& root, const std::string& file) {
  const auto file_type = root.attribute<std::string>("filetype");
  if (file_type != kFileType)
    throw ArchiveError(
        fmt::format("{}: attribute '/filetype': found '{}'; allowed: '{}'", file, file_type, kFileType));
  const auto version = root.attribute<std::vector<std::int32_t>>("format_version");
  if (version.size() != 2 || version.front() != kArchiveMajorVersion)
    throw ArchiveError(fmt::format("{}: attribute '/format_version': found {}; allowed: {}.x{}", file,
                                   fmt::join(version, "."), kArchiveMajorVersion,
                                   how_to_make_anew(root, version)));
}

Study read_study(const Hdf5Group& root, const std::string& file) {
  try {
    Study study = parse_study(root.attribute<std::string>("scenario"), "scenario");
    study.seed = root.attribute<std::uint64_t>("master_seed");
    return study;
  } catch (const InputError& error) {
    throw ArchiveError(fmt::format("{}: the study in attribute '/scenario': {}", file, error.what()));
  }
}

}  // namespace

void write_heading(Hdf5Group& root, const Campaign& campaign) {
  const CampaignInfo& info = campaign.info;
  Study study = campaign.study;
  study.methods = method_names(campaign);  // some may have been added after the run
  const Attributes list{
      {"filetype", kFileType},
      {"format_version", std::vector{std::int32_t{kArchiveMajorVersion}, std::int32_t{kArchiveMinorVersion}}},
      {"Conventions", kConventions},
      {"title", campaign.study.title},
      {"mpmbench_version", info.mpmbench_version},
      {"git_sha", info.git_sha},
      {"created", info.created},
      {"command", info.command},
      {"outside_files", info.outside_files},
      {"master_seed", std::uint64_t{campaign.study.seed}},
      {"solver", info.solver},
      {"seconds", info.seconds},
      {"jobs", std::int32_t{info.jobs}},
      {"audit_share", info.audit_share},
      {"audit_seconds", info.audit_seconds},
      {"scenario", campaign.study.source},
      {"study_resolved", resolved_study(study)}};
  for (const auto& [name, value] : list)
    root.write_attribute(name, value);
}

Campaign read_heading(const Hdf5Group& root, const std::string& file) {
  require_archive(root, file);
  Campaign campaign;
  campaign.study = read_study(root, file);
  CampaignInfo& info = campaign.info;
  info.mpmbench_version = root.attribute<std::string>("mpmbench_version");
  info.git_sha = root.attribute<std::string>("git_sha");
  info.created = root.attribute<std::string>("created");
  info.command = root.attribute<std::string>("command");
  if (root.has_attribute("outside_files"))  // from 2.1 on
    info.outside_files = root.attribute<std::string>("outside_files");
  info.solver = root.attribute<std::string>("solver");
  info.seconds = root.attribute<double>("seconds");
  info.jobs = root.attribute<std::int32_t>("jobs");
  info.audit_share = root.attribute<double>("audit_share");
  info.audit_seconds = root.attribute<double>("audit_seconds");
  return campaign;
}

}  // namespace mpm
