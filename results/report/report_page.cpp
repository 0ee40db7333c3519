#include <span>
#include <system_error>

#include <fmt/format.h>

#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_page.hpp"
#include "results/report/report.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_glossary.hpp"
#include "results/report/report_sections.hpp"
#include "results/report/section_html.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::vector<Figure> all_figures(const ReportSection& section) {
  std::vector<Figure> figures;
  for (const auto& piece : section.content)
    if (const Figure* const figure = std::get_if<Figure>(&piece))
      figures.push_back(*figure);
  figures.insert(figures.end(), section.file_figures.begin(), section.file_figures.end());
  return figures;
}

}  // namespace

std::string report_html(const Campaign& campaign, const StudyFindings& findings,
                        const std::filesystem::path& file, const std::vector<LoopView>& loops) {
  const SummaryContent parts = summary_content(campaign, findings, kMostVerdictRows);
  const ReportInput input{campaign, parts, file.filename().string(), loops, listed_below(campaign)};
  const std::vector<ReportSection> sections = report_sections(input);
  const std::string file_name = html_text(file.filename().string());
  const std::string study = html_text(campaign.study.name);
  return html_page(
      {campaign.study.name, html_text(campaign.study.title),
       fmt::format("<p>Study <strong>{}</strong>, archive <code>{}</code>. <span class=\"hint\">Rest a mouse "
                   "on a point to "
                   "see its experiment, press it to get there.</span></p>\n{}{}",
                   study, file_name, verdict_html(input), contents_html(sections)),
       fmt::format("Made by <code>mpmbench report</code> from {}; written by mpmbench {}. Intervals have a "
                   "confidence level of {:g}&nbsp;%.",
                   file_name, html_text(campaign.info.mpmbench_version),
                   100.0 * campaign.study.aggregate.confidence),
       campaign.info.mpmbench_version, glossary_html(findings.chain() != nullptr)},
      sections_html(sections));
}

std::vector<std::filesystem::path> write_figures(const Campaign& campaign, const StudyFindings& findings,
                                                 const std::filesystem::path& folder, FigureFormat format) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw ArchiveError(fmt::format("{}: cannot make the folder for the figures{}{}", folder.string(),
                                   error ? ": " : "", error ? error.message() : ""));
  const SummaryContent parts = summary_content(campaign, findings, kMostVerdictRows);
  std::vector<std::filesystem::path> files;
  for (const ReportSection& section : report_sections({campaign, parts, "", {}, listed_below(campaign)}))
    for (const Figure& figure : all_figures(section)) {
      files.push_back(folder / fmt::format("{}.{}", figure.name, to_string(format)));
      const std::string drawing = draw_figure(figure, format);
      write_file_atomically(files.back(), std::as_bytes(std::span(drawing)));
    }
  return files;
}

}  // namespace mpm
