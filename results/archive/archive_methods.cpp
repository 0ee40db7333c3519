// Describes the methods whose answers an archive has: the dimension `method` and the attributes of their
// groups.

#include <cmath>

#include <fmt/format.h>

#include "analysis/methods/method_words.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/method_json.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr const char* kMethodsGroup = "methods";

}  // namespace

void write_methods(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings) {
  const Hdf5Group methods = root.group(kMethodsGroup);
  for (const CampaignMethod& method : campaign.methods) {
    const MethodDescription& description = method.form->method();
    Hdf5Group group = methods.group(description.name);
    group.write_attribute("verdict", description.verdict);
    group.write_attribute("needs", needs_text(description));
    group.write_attribute("answers", answers_text(description));
    group.write_attribute("description", method_description_json(description));
    group.write_attribute("milliseconds", findings.of(description.name)->rates.milliseconds);
    group.write_attribute("mpmbench_version", method.mpmbench_version);
    group.write_attribute("git_sha", method.git_sha);
    group.write_attribute("command", method.command);
  }
}

std::vector<CampaignMethod> read_methods(const Hdf5Group& root, const Study& study, const std::string& file) {
  std::vector<CampaignMethod> methods;
  for (const std::string& name : root.read_list<std::string>("method")) {
    const Hdf5Group group = root.group(kMethodsGroup).group(name);
    MethodDescription description = method_description(group.attribute<std::string>("description"), file);
    if (description.name != name)
      throw ArchiveError(
          fmt::format("{}: attribute '/{}/{}/description': found a description of '{}'; allowed: "
                      "one of '{}'",
                      file, kMethodsGroup, name, description.name, name));
    methods.push_back({std::make_shared<const AssessmentForm>(std::move(description), study),
                       group.attribute<std::string>("mpmbench_version"),
                       group.attribute<std::string>("git_sha"), group.attribute<std::string>("command")});
  }
  return methods;
}

std::vector<double> read_method_times(const Hdf5Group& root, const AssessmentForms& forms) {
  std::vector<double> milliseconds;
  for (const auto& form : forms)
    milliseconds.push_back(
        root.group(kMethodsGroup).group(form->method().name).attribute<double>("milliseconds"));
  return milliseconds;
}

}  // namespace mpm
