#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/archive.hpp"
#include "results/archive_error.hpp"
#include "results/archive_groups.hpp"
#include "scenarios/study_file.hpp"

namespace mpm {
namespace {

constexpr const char* kFileType = "mpmbench archive";

}  // namespace

void write_heading(Hdf5Group& root, const Campaign& campaign) {
  const CampaignInfo& info = campaign.info;
  root.write_attribute("Conventions", std::string("CF-1.10"));
  root.write_attribute("title", campaign.study.title);
  root.write_attribute("filetype", std::string(kFileType));
  root.write_attribute("format_version",
                       std::vector<std::int32_t>{kArchiveMajorVersion, kArchiveMinorVersion});
  root.write_attribute("mpmbench_version", info.mpmbench_version);
  root.write_attribute("git_sha", info.git_sha);
  root.write_attribute("created", info.created);
  root.write_attribute("command", info.command);
  root.write_attribute("study", campaign.study.name);
  root.write_attribute("scenario", campaign.study.source);
  // A text: netCDF readers differ in what they make of unsigned 64-bit attributes.
  root.write_attribute("master_seed", std::to_string(campaign.study.seed));
  root.write_attribute("solver", info.solver);
  root.write_attribute("seconds", info.seconds);
  root.write_attribute("jobs", static_cast<std::int32_t>(info.jobs));
}

Campaign read_heading(const Hdf5Group& root, const std::string& file) {
  if (root.attribute<std::string>("filetype") != kFileType)
    throw ArchiveError(fmt::format("{}: attribute 'filetype': found \"{}\"; allowed: \"{}\"", file,
                                   root.attribute<std::string>("filetype"), kFileType));
  const auto version = root.attribute<std::vector<std::int32_t>>("format_version");
  if (version.size() != 2 || version[0] != kArchiveMajorVersion)
    throw ArchiveError(fmt::format("{}: attribute 'format_version': found {}; allowed: {}.x", file,
                                   version.empty() ? -1 : version[0], kArchiveMajorVersion));
  Campaign campaign;
  try {
    campaign.study = parse_study(root.attribute<std::string>("scenario"), file + " (attribute 'scenario')");
    campaign.study.seed = std::stoull(root.attribute<std::string>("master_seed"));
  } catch (const InputError& error) {
    throw ArchiveError(error.what());
  } catch (const std::logic_error&) {  // of stoull
    throw ArchiveError(fmt::format("{}: attribute 'master_seed': found \"{}\"; allowed: a whole number", file,
                                   root.attribute<std::string>("master_seed")));
  }
  CampaignInfo& info = campaign.info;
  info.mpmbench_version = root.attribute<std::string>("mpmbench_version");
  info.git_sha = root.attribute<std::string>("git_sha");
  info.created = root.attribute<std::string>("created");
  info.command = root.attribute<std::string>("command");
  info.solver = root.attribute<std::string>("solver");
  info.seconds = root.attribute<double>("seconds");
  info.jobs = root.attribute<std::int32_t>("jobs");
  return campaign;
}

}  // namespace mpm
