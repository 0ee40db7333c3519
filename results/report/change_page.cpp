#include <algorithm>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/report/change_report.hpp"
#include "results/report/change_sections.hpp"
#include "results/report/html_page.hpp"
#include "results/report/section_html.hpp"

namespace mpm {
namespace {

StudyRun run_of(const Campaign& campaign, const AssessmentForms& forms) {
  return {campaign.study, forms, records_of(campaign), campaign.calibration};
}

std::string paragraph(const std::string& html) {
  return "<p>" + html + "</p>\n";
}

std::string p_text(double p) {
  return fmt::format("{:.2g}", p);
}

/// Which experiments are compared, and how.
std::string pairing_html(const ChangeInput& input) {
  const std::int64_t loops = input.pairing.loops;
  if (!input.pairing.paired())
    return paragraph(fmt::format(
        "<strong>Compared as unrelated runs, not experiment by experiment, because {}.</strong> Each "
        "difference then carries the chance of both draws, and no single experiment can be said to have "
        "changed.",
        html_text(input.pairing.obstacle)));
  const std::int64_t left_out =
      std::ssize(records_of(input.before)) + std::ssize(records_of(input.now)) - 2 * loops;
  std::string html = fmt::format(
      "Compared experiment by experiment: both ran the same {} with seed {}, each with the same fault{}. ",
      loops, input.now.study.seed,
      left_out == 0 ? std::string()
                    : fmt::format("; the {} that only one of them has are left out", left_out));
  html += input.pairing.same_loops == loops
              ? std::string(
                    "All of these loops ended in the same way and with the same Ivar<sub>basis</sub> to "
                    "the last bit: what differs is what the methods say of them.")
              : fmt::format(
                    "In {} of these loops the end or Ivar<sub>basis</sub> is not the same: the loops "
                    "themselves changed, and with them what is right to say of them.",
                    loops - input.pairing.same_loops);
  return paragraph(html);
}

/// A question whose answers became worse or better beyond chance, in words.
std::string verdict_words(const MethodChange& method, const VerdictChange& verdict) {
  return fmt::format("{}, {}: {} lost, {} gained of {} (p&nbsp;=&nbsp;{} corrected)", html_text(method.name),
                     verdict.question->name, verdict.changes.lost.size(), verdict.changes.gained.size(),
                     verdict.changes.pairs, p_text(verdict.p_holm));
}

void add_words(std::string& list, const std::string& words) {
  list += (list.empty() ? "" : "; ") + words;
}

/// The verdict on paired runs.
std::string paired_html(const ChangeInput& input) {
  if (std::none_of(input.methods.begin(), input.methods.end(), [](const auto& m) { return m.changed(); }))
    return "<p class=\"check passed\"><strong>Nothing changed.</strong> Every verdict and every number of "
           "the "
           "methods that both have is the same in all of these experiments.</p>\n";
  std::string worse, better;
  std::size_t lost = 0, gained = 0, questions = 0;
  for (const MethodChange& method : input.methods)
    for (const VerdictChange& verdict : method.verdicts) {
      ++questions;
      lost += verdict.changes.lost.size();
      gained += verdict.changes.gained.size();
      if (verdict.p_holm < 1.0 - input.now.study.aggregate.confidence)
        add_words(verdict.changes.lost.size() > verdict.changes.gained.size() ? worse : better,
                  verdict_words(method, verdict));
    }
  std::string html = fmt::format(
      "{} answers that were right in A are not in B, and {} that were not are now, of {} question{} to {} "
      "method{}. ",
      lost, gained, questions, questions == 1 ? "" : "s", input.methods.size(),
      input.methods.size() == 1 ? "" : "s");
  if (!worse.empty())
    html += fmt::format("<strong>B is worse beyond chance</strong> at {}. ", worse);
  if (!better.empty())
    html += fmt::format("<strong>B is better beyond chance</strong> at {}. ", better);
  if (worse.empty() && better.empty())
    html +=
        "<strong>No question has so many more of the one than of the other that chance is ruled "
        "out.</strong> ";
  return fmt::format("<p class=\"check {}\">{}</p>\n", worse.empty() ? "passed" : "failed", html);
}

/// The verdict on unpaired runs.
std::string unpaired_html(const ChangeInput& input) {
  constexpr std::size_t kMost = 10;
  std::size_t rates = 0, different = 0;
  std::string list;
  for (const MethodChange& method : input.methods)
    for (const RateChange& change : method.rates) {
      ++rates;
      if (!(change.p_holm < 1.0 - input.now.study.aggregate.confidence))
        continue;
      if (++different <= kMost)
        add_words(list, fmt::format("{}, {}: {:.1f} to {:.1f}&nbsp;%", html_text(method.name),
                                    html_text(change.info->title), 100.0 * change.before.value,
                                    100.0 * change.now.value));
    }
  return fmt::format("<p class=\"check {}\"><strong>{} of {} rates differ beyond chance</strong>{}{}.</p>\n",
                     different == 0 ? "passed" : "failed", different, rates, list.empty() ? "" : ": " + list,
                     different > kMost ? fmt::format("; and {} more below", different - kMost) : "");
}

}  // namespace

ReportSection changes_section(const ChangeInput& input) {
  ReportSection section{"changes", "What changed?", {}};
  if (input.methods.empty())
    section.add(
        "<p class=\"check failed\"><strong>No method of assessment is in both archives</strong>, so that "
        "nothing can be compared.</p>\n");
  else
    section.add(input.pairing.paired() ? paired_html(input) : unpaired_html(input));
  section.add(pairing_html(input));
  return section;
}

std::string change_html(const Campaign& before, const std::filesystem::path& before_file, const Campaign& now,
                        const std::filesystem::path& now_file) {
  const bool same_name = before_file.filename() == now_file.filename();
  const auto shown = [&](const std::filesystem::path& file) {
    return same_name ? file.string() : file.filename().string();
  };
  const AssessmentForms before_forms = forms_of(before), now_forms = forms_of(now);
  const StudyRun first = run_of(before, before_forms), second = run_of(now, now_forms);
  ChangeInput input{before, now, shown(before_file), shown(now_file), pair_runs(first, second), {}};
  input.methods = method_changes(first, second, input.pairing);
  const std::vector<ReportSection> sections{changes_section(input), change_studies_section(input),
                                            change_rates_section(input), change_verdicts_section(input),
                                            change_numbers_section(input)};
  const std::string names = fmt::format("A <code>{}</code>, B <code>{}</code>", html_text(input.before_file),
                                        html_text(input.now_file));
  return html_page(
      {fmt::format("{} and {}", input.before_file, input.now_file),
       fmt::format("From <code>{}</code> to <code>{}</code>", html_text(input.before_file),
                   html_text(input.now_file)),
       fmt::format("<p>Archives {}. <span class=\"hint\">Rest a mouse on a point to see its "
                   "experiment.</span></p>\n{}",
                   names, contents_html(sections)),
       fmt::format("Made by <code>mpmbench report</code> from {}. Intervals have a confidence level of "
                   "{:g}&nbsp;%.",
                   names, 100.0 * now.study.aggregate.confidence),
       now.info.mpmbench_version},
      sections_html(sections));
}

}  // namespace mpm
