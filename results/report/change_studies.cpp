#include <algorithm>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/change_sections.hpp"
#include "results/report/html_table.hpp"
#include "scenarios/files/study_differences.hpp"

namespace mpm {
namespace {

/// Methods of `campaign` that `other` has not.
std::string methods_alone(const Campaign& campaign, const Campaign& other) {
  const std::vector<std::string> others = method_names(other);
  std::string names;
  for (const std::string& name : method_names(campaign))
    if (std::find(others.begin(), others.end(), name) == others.end())
      names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

std::string value_cell(const std::string& value) {
  return value.empty() ? "<span class=\"none\">not there</span>" : "<code>" + html_text(value) + "</code>";
}

}  // namespace

ReportSection change_studies_section(const ChangeInput& input) {
  ReportSection section{"studies", "What differs between the studies?", {}};
  HtmlTable table(
      "What ran, and the keys of the study that have other values, with every default written out; "
      "what differs is marked.",
      {{"", HtmlTable::Align::left}, {"A", HtmlTable::Align::left}, {"B", HtmlTable::Align::left}});
  const Campaign &a = input.before, &b = input.now;
  const auto row = [&](const char* what, const std::string& before, const std::string& now) {
    table.row({before == now ? std::string(what) : fmt::format("<strong>{}</strong>", what),
               html_text(before), html_text(now)});
  };
  row("archive", input.before_file, input.now_file);
  row("study", a.study.name, b.study.name);
  row("experiments", fmt::format("{}", records_of(a).size()), fmt::format("{}", records_of(b).size()));
  row("mpmbench", a.info.mpmbench_version, b.info.mpmbench_version);
  row("revision", a.info.git_sha, b.info.git_sha);
  row("solver", a.info.solver, b.info.solver);
  row("programs and FMUs", a.info.outside_files, b.info.outside_files);
  row("finished", a.info.created, b.info.created);
  row("methods here alone", methods_alone(a, b), methods_alone(b, a));
  const std::vector<StudyDifference> differences = study_differences(a.study, b.study);
  table.group(differences.empty() ? "No key of the study differs" : "Keys of the study that differ");
  for (const StudyDifference& each : differences)
    table.row({fmt::format("<strong><code>{}</code></strong>", html_text(each.key)), value_cell(each.before),
               value_cell(each.now)});
  section.add(table.html());
  return section;
}

}  // namespace mpm
