#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/run_change.hpp"
#include "analysis/study_files/study_differences.hpp"
#include "results/archive/campaign_differences.hpp"
#include "results/document/document_html.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/change_report.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostRows = 500;  // experiments listed one by one

/// What the sections are made from. The first archive is A, and the second B.
struct Change {
  const Campaign &before, &now;
  std::string before_file, now_file;  ///< how commands name the archives
  RunPairing pairing;
  std::vector<MethodChange> methods;

  bool is_beyond_chance(double p) const { return p < 1.0 - now.study.aggregate.confidence; }
};

std::string p_text(double p) {
  return std::isnan(p) ? "-" : fmt::format("{:.2g}", p);
}

/// A share in percentage points with its sign: "+1.2".
std::string points(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:+.1f}", 100.0 * share);
}

/// Says which experiments are compared, and how.
std::string pairing_words(const Change& change) {
  const std::int64_t loops = change.pairing.loops;
  if (!change.pairing.paired())
    return strong(fmt::format("Compared as unrelated runs, not experiment by experiment, because {}.",
                              as_label(change.pairing.obstacle))) +
           " Each difference then carries the chance of both draws, and no single experiment can be said to "
           "have "
           "changed.";
  const std::int64_t left_out =
      std::ssize(records_of(change.before)) + std::ssize(records_of(change.now)) - 2 * loops;
  return fmt::format(
      "Compared experiment by experiment: both ran the same {} with seed {}, each with the same fault{}. In "
      "{} of these loops the outcome or Ivar_{{basis}} differs, if only in the last bit.",
      loops, change.now.study.seed,
      left_out == 0 ? "" : fmt::format("; the {} that only one of them has are left out", left_out),
      loops - change.pairing.same_loops);
}

void add_words(std::string& list, const std::string& words) {
  list += (list.empty() ? "" : "; ") + words;
}

/// Adds the verdict on paired runs.
void add_paired(Section& section, const Change& change) {
  std::string worse, better;
  std::size_t lost = 0, gained = 0;
  for (const MethodChange& method : change.methods)
    for (const VerdictChange& verdict : method.verdicts) {
      const JudgementChanges& changes = verdict.changes;
      lost += changes.lost.size();
      gained += changes.gained.size();
      if (change.is_beyond_chance(verdict.p_holm))
        add_words(changes.lost.size() > changes.gained.size() ? worse : better,
                  fmt::format("{}, {}: {} lost, {} gained of {} (p = {} corrected)", as_label(method.name),
                              verdict.question->name, changes.lost.size(), changes.gained.size(),
                              changes.pairs, p_text(verdict.p_holm)));
    }
  if (std::none_of(change.methods.begin(), change.methods.end(), [](const auto& m) { return m.changed(); }))
    return section.say(strong("Nothing changed.") +
                           " Every verdict and every number of the methods in both archives is the same in "
                           "all of these experiments.",
                       Paragraph::Kind::passed);
  std::string words = fmt::format("{} answers are right in A only, and {} in B only. ", lost, gained);
  if (!worse.empty())
    words += fmt::format("{} at {}. ", strong("B is worse beyond chance"), worse);
  if (!better.empty())
    words += fmt::format("{} at {}. ", strong("B is better beyond chance"), better);
  if (worse.empty() && better.empty())
    words += strong("For no question is the difference beyond chance.");
  section.say(words, worse.empty() ? Paragraph::Kind::passed : Paragraph::Kind::failed);
}

/// Adds the verdict on unpaired runs.
void add_unpaired(Section& section, const Change& change) {
  std::size_t rates = 0, different = 0;
  for (const MethodChange& method : change.methods)
    for (const RateChange& rate : method.rates) {
      ++rates;
      different += change.is_beyond_chance(rate.p_holm) ? 1 : 0;
    }
  section.say(strong(fmt::format("{} of {} rates differ beyond chance.", different, rates)),
              different == 0 ? Paragraph::Kind::passed : Paragraph::Kind::failed);
}

Section changes_section(const Change& change) {
  Section section{"changes", "What changed?"};
  if (change.methods.empty())
    section.say(
        strong("The archives have no method of assessment in common") + ", so there is nothing to compare.",
        Paragraph::Kind::failed);
  else if (change.pairing.paired())
    add_paired(section, change);
  else
    add_unpaired(section, change);
  section.say(pairing_words(change));
  return section;
}

std::string listed_or_none(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Section studies_section(const Change& change) {
  Section section{"studies", "What differs between the studies?"};
  Table table(
      "What ran, and the keys of the study and of methods from outside whose values differ, including "
      "defaults "
      "of the study. Differences are marked.",
      {{"", Table::Align::left}, {"A", Table::Align::left}, {"B", Table::Align::left}});
  const Campaign &a = change.before, &b = change.now;
  const auto row = [&](const char* what, const std::string& before, const std::string& now) {
    table.row(
        {before == now ? Cell(what) : Cell(what).toned(Cell::Tone::strong), as_label(before), as_label(now)});
  };
  row("archive", change.before_file, change.now_file);
  row("study", a.study.name, b.study.name);
  row("experiments", fmt::format("{}", records_of(a).size()), fmt::format("{}", records_of(b).size()));
  row("mpmbench", a.info.mpmbench_version, b.info.mpmbench_version);
  row("revision", a.info.git_sha, b.info.git_sha);
  row("solver", a.info.solver, b.info.solver);
  row("programs and FMUs", a.info.outside_files, b.info.outside_files);
  row("finished", a.info.created, b.info.created);
  row("methods here alone", listed_or_none(methods_alone(a, b)), listed_or_none(methods_alone(b, a)));
  const std::vector<StudyDifference> differences = campaign_differences(a, b);
  table.group(differences.empty() ? "No key of the study or of a method from outside differs"
                                  : "Keys of the study and of methods from outside that differ");
  const auto value = [](const std::string& of) { return of.empty() ? "not there" : code(of); };
  for (const StudyDifference& each : differences)
    table.row({Cell(code(each.key)).toned(Cell::Tone::strong), value(each.before), value(each.now)});
  section.add(std::move(table));
  return section;
}

/// Tells whether a rate is shown: a loop changed for it, or the runs are unpaired.
bool is_shown(const RateChange& change, bool paired) {
  return !paired || change.counts.first + change.counts.second > 0 || change.before.hits != change.now.hits ||
         change.before.total != change.now.total;
}

Section rates_section(const Change& change) {
  Section section{"rates", "Rates of A and B"};
  const bool paired = change.pairing.paired();
  Table table(
      fmt::format("Rates of the methods{} Corrected by Holm for the rates of the method.",
                  paired ? " over the experiments in common in which some loop changed. The difference is "
                           "over the loops that the rate counts in both archives (below it: those that count "
                           "in A alone, and in B alone), with the interval of Newcombe (1998, paired, method "
                           "10) and p of McNemar's exact test."
                         : ", each over all experiments of its archive. The difference is that of "
                           "independent shares: interval "
                           "of Newcombe (1998, method 10), p of Fisher's exact test."),
      {{"Share of loops", Table::Align::left},
       {"A"},
       {"B"},
       {"Counted in both"},
       {"B - A, points"},
       {fmt::format("{:g} % interval", 100.0 * change.now.study.aggregate.confidence)},
       {"p"},
       {"p, corrected"}});
  const auto share = [](const Rate& rate) {
    return Cell(Number{rate.value, NumberForm::share}).with(fmt::format("{} of {}", rate.hits, rate.total));
  };
  for (const MethodChange& method : change.methods) {
    if (std::any_of(method.rates.begin(), method.rates.end(),
                    [&](const auto& rate) { return is_shown(rate, paired); }))
      table.group(as_label(method.name));
    for (const RateChange& rate : method.rates)
      if (const ShareDifference& difference = rate.difference; is_shown(rate, paired))
        table.row(
            {as_label(rate.row->heading), share(rate.before), share(rate.now),
             paired ? Cell(rate.counts.total())
                          .with(fmt::format("-{}, +{}", rate.counts.first, rate.counts.second))
                    : Cell("-"),
             points(difference.value),
             fmt::format("{} to {}", points(difference.interval.lower), points(difference.interval.upper)),
             p_text(difference.p), p_text(rate.p_holm)});
  }
  section.add(std::move(table));
  return section;
}

/// Says briefly what the method answered.
std::string answer_text(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  if (!said.answered())
    return said.reason.empty() ? "no verdict" : "no verdict: " + as_label(said.reason);
  if (!said.flagged)
    return "not flagged";
  return fmt::format(
      "flagged{}{}", said.predicted_cv < 0 ? "" : " " + as_label(cv_name(study, said.predicted_cv)),
      said.predicted_source == FaultSource::none ? ""
                                                 : fmt::format(" ({})", source_name(said.predicted_source)));
}

Table count_table(const Change& change) {
  Table table(
      "For each question and method: how often the answer is right in both archives, in A only, and in B "
      "only. An answer that is no longer judged counts as lost. p is that of McNemar's exact test, "
      "two-sided, and corrected by Holm for all rows.",
      {{"Question", Table::Align::left},
       {"Judged"},
       {"Right in both"},
       {"Right, then not"},
       {"Not, then right"},
       {"p"},
       {"p, corrected"}});
  for (const MethodChange& method : change.methods) {
    if (!method.changed())
      continue;
    table.group(as_label(method.name));
    for (const VerdictChange& verdict : method.verdicts)
      table.row({as_label(verdict.question->name), verdict.changes.pairs, verdict.changes.clusters.sum().both,
                 verdict.changes.lost.size(), verdict.changes.gained.size(),
                 p_text(verdict.changes.test().p_two_sided), p_text(verdict.p_holm)});
  }
  return table;
}

/// Lists for each experiment the questions whose answer became right or is no longer right: "flag, impact
/// lost; CV gained".
std::map<std::int64_t, std::string> changed_experiments(const MethodChange& method) {
  std::map<std::int64_t, std::string> experiments;
  for (const VerdictChange& verdict : method.verdicts) {
    for (const JudgementPair& pair : verdict.changes.lost)
      add_words(experiments[pair.index], fmt::format("{} lost", verdict.question->name));
    for (const JudgementPair& pair : verdict.changes.gained)
      add_words(experiments[pair.index], fmt::format("{} gained", verdict.question->name));
  }
  return experiments;
}

/// Lists the experiments whose answers changed, one by one.
Table experiment_table(const Change& change) {
  Table table("Experiments with an answer that became right or wrong.",
              {{"No."},
               {"Kind", Table::Align::left},
               {"Fault, and how to replay it", Table::Align::text},
               {"A says", Table::Align::left},
               {"B says", Table::Align::left},
               {"Questions", Table::Align::left}});
  std::vector<std::map<std::int64_t, std::string>> wanted;
  for (const MethodChange& method : change.methods)
    wanted.push_back(changed_experiments(method));
  std::vector<std::vector<std::vector<Cell>>> rows(wanted.size());
  each_in_both(
      records_of(change.before), records_of(change.now),
      [&](const ExperimentRecord& before, const ExperimentRecord& now) {
        const std::int64_t index = now.draw.index;
        for (std::size_t m = 0; m < wanted.size(); ++m)
          if (const auto found = wanted[m].find(index); found != wanted[m].end())
            rows[m].push_back(
                {index, kind_name(now.draw.kind),
                 Cell(as_label(fault_text(change.now.study, now.draw)))
                     .with(code(fmt::format("mpmbench replay {} {}", change.before_file, index)) + " " +
                           code(fmt::format("mpmbench replay {} {}", change.now_file, index))),
                 answer_text(change.before.study, before, before.assessments[change.methods[m].before]),
                 answer_text(change.now.study, now, now.assessments[change.methods[m].now]), found->second});
      });
  for (std::size_t m = 0; m < rows.size(); ++m) {
    if (rows[m].empty() || table.rows.size() > kMostRows)
      continue;
    table.group(as_label(change.methods[m].name));
    for (std::vector<Cell>& row : rows[m])
      if (table.rows.size() <= kMostRows)
        table.row(std::move(row));
  }
  return table;
}

Section verdicts_section(const Change& change) {
  Section section{"verdicts", "Which experiments changed their verdict?"};
  if (!change.pairing.paired()) {
    section.leave_out("the runs are not paired: " + change.pairing.obstacle + ".");
    return section;
  }
  section.add(count_table(change));
  std::string meanings;
  for (const VerdictQuestion& question : verdict_questions())
    meanings += fmt::format("{}: {}. ", strong(question.name), question.meaning);
  section.say(meanings, Paragraph::Kind::small);
  section.add(experiment_table(change));
  return section;
}

Section numbers_section(const Change& change) {
  Section section{"numbers", "Numbers and scores, A against B"};
  Table table(
      fmt::format(
          "Numbers of the methods that changed, over the experiments in which both give a verdict; a number "
          "that each CV has is averaged over the CVs. {:g} % interval of the mean: Student's t.",
          100.0 * change.now.study.aggregate.confidence),
      {{"Number", Table::Align::left},
       {"Experiments"},
       {"Unchanged"},
       {"Mean of B - A"},
       {"Largest change"},
       {"in experiment"}});
  for (const MethodChange& method : change.methods)
    for (const NumberChange& number : method.numbers)
      if (number.same < number.experiments)
        table.row({as_label(method.name) + ": " + number.label, number.experiments, number.same,
                   Number{number.difference.mean, NumberForm::digits, number.difference.mean_interval},
                   Number{number.largest}, number.index < 0 ? Cell("-") : Cell(number.index)});
  if (table.rows.empty())
    section.leave_out("no number of a method in both archives changed in any common experiment.");
  else
    section.add(std::move(table));
  return section;
}

}  // namespace

std::string change_html(const Campaign& before, const std::filesystem::path& before_file, const Campaign& now,
                        const std::filesystem::path& now_file) {
  const bool same_name = before_file.filename() == now_file.filename();
  const auto shown = [&](const std::filesystem::path& file) {
    return same_name ? file.string() : file.filename().string();
  };
  const AssessmentForms before_forms = forms_of(before), now_forms = forms_of(now);
  const StudyRun first = study_run(before, before_forms), second = study_run(now, now_forms);
  Change change{before, now, shown(before_file), shown(now_file), pair_runs(first, second), {}};
  change.methods = method_changes(first, second, change.pairing);
  const std::string names = fmt::format("A {}, B {}", code(change.before_file), code(change.now_file));
  return document_html(
      {.title = fmt::format("{} and {}", change.before_file, change.now_file),
       .heading = fmt::format("From {} to {}", code(change.before_file), code(change.now_file)),
       .lead = "Archives " + names + ".",
       .footer = fmt::format("Made by {} from {}. Intervals have a confidence of {:g} %.",
                             code("mpmbench report"), names, 100.0 * now.study.aggregate.confidence),
       .version = now.info.mpmbench_version,
       .sections = {changes_section(change), studies_section(change), rates_section(change),
                    verdicts_section(change), numbers_section(change)}});
}

}  // namespace mpm
