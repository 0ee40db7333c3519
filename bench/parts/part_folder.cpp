#include "bench/parts/part_folder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <set>
#include <span>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system/input_file.hpp"
#include "base/system/json_entry.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/shards/shard_folder.hpp"
#include "results/files/atomic_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPartType = "mpmbench part";
constexpr std::int64_t kMostWhole = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

std::uint64_t seed_in(const JsonEntry& entry) {
  entry.require(entry.json().is_number_unsigned(), "a whole number from 0 on");
  return entry.json().get<std::uint64_t>();
}

CampaignPart part_in(const JsonEntry& entry, std::int64_t loops) {
  CampaignPart part;
  if (const std::string text = entry.at("loops").text(kAnyLength); !text.empty())
    part.loops = parse_loop_ranges(text, loops);
  if (entry.has("shard")) {
    const JsonEntry shard = entry.at("shard");
    const std::int64_t of = shard.at("of").whole(1, kMostWhole);
    part.number = {shard.at("number").whole(1, of), of, ""};
  }
  return part;
}

PartFolder part_folder_in(const JsonEntry& entry, const fs::path& folder, const std::string& file) {
  entry.require_keys({"filetype", "loops", "campaign_loops", "experiments", "seed", "methods", "solver",
                      "audit_share", "store", "allow_unhealthy_basis", "scenario", "shard"});
  entry.at("filetype").require(entry.at("filetype").json() == kPartType, kPartType);
  PartFolder part;
  part.path = folder;
  part.study = parse_study(entry.at("scenario").text(kAnyLength), file);
  part.study.seed = seed_in(entry.at("seed"));
  part.study.methods = entry.at("methods").texts();
  RunOptions& options = part.options;
  options.experiments = entry.at("experiments").whole(1, kMostWhole);
  options.seed = part.study.seed;
  options.methods = part.study.methods;
  options.solver = entry.at("solver").text();
  options.audit_share = entry.at("audit_share").number(0.0, 1.0);
  options.store = store_policy(entry.at("store").text(), file + ": store");
  options.allow_unhealthy_basis = entry.at("allow_unhealthy_basis").flag();
  part.loops = entry.at("campaign_loops").whole(1, kMostWhole);
  part.part = part_in(entry, part.loops);
  return part;
}

}  // namespace

fs::path parts_folder_of(const fs::path& output) {
  return output.string() + ".parts";
}

std::string part_name(const std::string& range, const std::optional<PartNumber>& number) {
  std::string name = range;
  std::replace(name.begin(), name.end(), ':', '-');
  std::replace(name.begin(), name.end(), ',', '+');
  constexpr std::size_t kLongest = 100;  // limit of the ranges in a file name, with room for the rest
  if (name.size() > kLongest)
    name = fmt::format("{}-{}", name.substr(0, name.find('+')), digest_of(range));
  if (number)
    name += fmt::format("{}{}-of-{}", name.empty() ? "" : "_", number->number, number->of);
  return name;
}

void write_part_description(const PartFolder& part) {
  Json json{{"filetype", kPartType},
            {"loops", to_string(part.part.loops)},
            {"campaign_loops", part.loops},
            {"experiments", *part.options.experiments},
            {"seed", part.study.seed},
            {"methods", part.study.methods},
            {"solver", part.options.solver},
            {"audit_share", part.options.audit_share},
            {"store", name_of(part.options.store)},
            {"allow_unhealthy_basis", part.options.allow_unhealthy_basis},
            {"scenario", part.study.source}};
  if (part.part.number)
    json["shard"] = Json{{"number", part.part.number->number}, {"of", part.part.number->of}};
  const std::string text = json.dump(2) + '\n';
  write_file_atomically(part.path / kCampaignDescription, std::as_bytes(std::span(text)));
}

PartFolder read_part(const fs::path& folder) {
  const std::string file = (folder / kCampaignDescription).string();
  std::ifstream stream = open_input(file, "a description of a part");
  const Json json = parsed_json(content_of(stream), file,
                                "the description that `mpmbench run` writes into the folder of a part");
  return part_folder_in({json, file}, folder, file);
}

std::set<fs::path> parts_in(const fs::path& folder) {
  std::set<fs::path> found;
  std::error_code error;
  if (fs::exists(folder / kCampaignDescription, error))
    found.insert(folder.lexically_normal());
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().filename() == kCampaignDescription)
      found.insert(entry->path().parent_path().lexically_normal());
  if (error)
    throw InputError(folder.string(), error.message(), "a folder with parts of a campaign");
  return found;
}

std::vector<fs::path> find_parts(const std::vector<std::string>& folders) {
  std::set<fs::path> found;
  for (const std::string& folder : folders) {
    std::set<fs::path> parts = parts_in(folder);
    if (parts.empty())
      throw InputError(
          folder, "a folder without parts of a campaign",
          fmt::format("folders with {}, as `mpmbench run --shard` makes them", kCampaignDescription));
    found.merge(parts);
  }
  return {found.begin(), found.end()};
}

}  // namespace mpm
