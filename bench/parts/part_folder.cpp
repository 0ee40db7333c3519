#include "bench/parts/part_folder.hpp"

#include <algorithm>
#include <exception>
#include <fstream>
#include <set>
#include <span>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system/input_file.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/shards/shard_folder.hpp"
#include "results/files/atomic_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPartType = "mpmbench part";

CampaignPart part_in(const Json& json, std::int64_t loops) {
  CampaignPart part;
  if (const auto text = json.at("loops").get<std::string>(); !text.empty())
    part.loops = parse_loop_ranges(text, loops);
  if (json.contains("shard"))
    part.number = {json.at("shard").at("number").get<std::int64_t>(),
                   json.at("shard").at("of").get<std::int64_t>(), ""};
  return part;
}

PartFolder part_folder_in(const Json& json, const fs::path& folder, const std::string& file) {
  if (json.at("filetype") != kPartType)
    throw InputError(fmt::format("{}: filetype", file), json.at("filetype").dump(), kPartType);
  PartFolder part;
  part.path = folder;
  part.study = parse_study(json.at("scenario").get<std::string>(), file);
  part.study.seed = json.at("seed").get<std::uint64_t>();
  part.study.methods = json.at("methods").get<std::vector<std::string>>();
  RunOptions& options = part.options;
  options.experiments = json.at("experiments").get<std::int64_t>();
  options.seed = part.study.seed;
  options.methods = part.study.methods;
  options.solver = json.at("solver").get<std::string>();
  options.audit_share = json.at("audit_share").get<double>();
  options.store = store_policy(json.at("store").get<std::string>(), file + ": store");
  options.allow_unhealthy_basis = json.at("allow_unhealthy_basis").get<bool>();
  part.loops = json.at("campaign_loops").get<std::int64_t>();
  part.part = part_in(json, part.loops);
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
  constexpr std::size_t kLongest = 100;  // of a name of a file, with room for the rest
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
  const std::string text = content_of(stream);
  try {
    return part_folder_in(Json::parse(text), folder, file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(file, fmt::format("a file that does not describe a part ({})", error.what()),
                     "the description that `mpmbench run` writes into a folder of shards");
  }
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
