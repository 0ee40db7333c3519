#include "results/summary/summary.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/campaign/part_merge.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard_folder.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct SummaryArguments {
  std::string archive;
  std::vector<std::string> method_files;
  bool json = false;
};

/// The folders with the finished work of a run that has written no archive yet: the named folder, or those
/// beside the named archive. None if the archive is there, or if nothing is.
std::vector<std::string> unfinished_folders(const std::string& named) {
  std::error_code no_status;
  if (fs::is_directory(named, no_status))
    return {named};
  std::vector<std::string> folders;
  if (!fs::exists(named, no_status))
    for (const fs::path& folder : {shard_folder_of(named), parts_folder_of(named)})
      if (fs::is_directory(folder, no_status))
        folders.push_back(folder.string());
  return folders;
}

/// The archive beside which the named folder of shards or parts lies; otherwise the name itself.
std::string archive_of(const std::string& named) {
  fs::path path = fs::path(named).has_filename() ? fs::path(named) : fs::path(named).parent_path();
  return path.extension() == ".shards" || path.extension() == ".parts" ? path.replace_extension().string()
                                                                       : named;
}

std::string summary_of(const SummaryArguments& options, const Campaign& campaign,
                       const std::optional<Unfinished>& unfinished) {
  const StudyFindings findings = findings_of(campaign);
  const Document document = summary_document(campaign, findings, archive_of(options.archive), unfinished);
  return options.json ? document_json(document) : document_text(document);
}

std::string partial_summary(const SummaryArguments& options, const std::vector<std::string>& folders) {
  const auto methods = take_method_files(options.method_files).table;
  Progress progress(false);
  const PartMerge parts(folders, methods, [&progress](const std::string& text) { progress.warn(text); });
  if (parts.experiments_done() == 0)
    throw std::runtime_error(
        fmt::format("{}: none of {} experiments is done yet", folders.front(), parts.experiments()));
  try {
    return summary_of(options, parts.merge(hooks_of(progress)),
                      Unfinished{parts.experiments_done(), parts.experiments()});
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error));
  }
}

ExitCode summary(const SummaryArguments& options) {
  if (const std::vector<std::string> folders = unfinished_folders(options.archive); !folders.empty()) {
    print_result(partial_summary(options, folders));
    return ExitCode::done;
  }
  const Campaign campaign = stream_input(options.archive);
  if (has_shards(options.archive))
    print_note(
        fmt::format("{0}: a later run is not finished; `mpmbench summary {0}` says what it has found\n",
                    shard_folder_of(options.archive).string()));
  print_result(summary_of(options, campaign, std::nullopt));
  return ExitCode::done;
}

}  // namespace

void add_summary(CommandSet& commands) {
  const auto options = std::make_shared<SummaryArguments>();
  CLI::App& app = commands.add(
      "summary",
      "Print the results of a study beside reported values; also the results so far of an unfinished run",
      [options] { return summary(*options); });
  add_path(app, "ARCHIVE", options->archive,
           "Archive, also one that is not written yet, or a folder with the shards or parts of a run")
      ->required();
  add_method_files(app, options->method_files);
  add_trust(app);
  add_json(app, options->json);
}

}  // namespace mpm
