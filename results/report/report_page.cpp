#include <span>
#include <system_error>

#include <fmt/format.h>

#include "results/document/document_html.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report.hpp"
#include "results/report/report_answers.hpp"
#include "results/report/report_glossary.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::vector<Figure> all_figures(const Section& section) {
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
  const std::vector<Section> sections = report_sections(input);
  const std::string name = file.filename().string();
  return document_html(
      {.title = campaign.study.name,
       .heading = as_label(campaign.study.title),
       .lead = fmt::format("Study {}, archive {}.", strong(as_label(campaign.study.name)), code(name)),
       .footer =
           fmt::format("Made by {} from {}; written by mpmbench {}. Intervals have a confidence of {:g} %.",
                       code("mpmbench report"), as_label(name), as_label(campaign.info.mpmbench_version),
                       100.0 * campaign.study.aggregate.confidence),
       .version = campaign.info.mpmbench_version,
       .sections = sections,
       .lead_html = "<p class=\"hint\">Hover over a point to see its experiment; click to go there.</p>\n" +
                    verdict_html(input) + contents_html(sections),
       .aside_html = glossary_html(findings.chain() != nullptr)});
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
  for (const Section& section : report_sections({campaign, parts, "", {}, listed_below(campaign)}))
    for (const Figure& figure : all_figures(section)) {
      files.push_back(folder / fmt::format("{}.{}", figure.name, to_string(format)));
      const std::string drawing = draw_figure(figure, format);
      write_file_atomically(files.back(), std::as_bytes(std::span(drawing)));
    }
  return files;
}

}  // namespace mpm
