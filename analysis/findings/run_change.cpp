#include "analysis/findings/run_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/holm.hpp"

namespace mpm {
namespace {

std::vector<std::string> names_of(const std::vector<PlantModel::Variable>& variables) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& variable : variables)
    names.push_back(variable.name);
  return names;
}

bool same_variables(const PlantModel& a, const PlantModel& b) {
  return names_of(a.cvs) == names_of(b.cvs) && names_of(a.mvs) == names_of(b.mvs) &&
         names_of(a.mds) == names_of(b.mds);
}

/// Is the same wrong, of the same size?
bool same_fault(const ExperimentDraw& a, const ExperimentDraw& b) {
  return a.kind == b.kind && a.mismatches == b.mismatches && a.disturbances == b.disturbances &&
         a.named == b.named && a.affected_cvs == b.affected_cvs && a.parameters == b.parameters &&
         a.tuning == b.tuning && a.other == b.other && a.onset == b.onset && a.scales == b.scales &&
         a.noise_factor == b.noise_factor;
}

/// As numbers in a file are the same: a NaN is itself.
bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_loop(const LoopPair& loop) {
  const ExperimentRecord &a = *loop.before, &b = *loop.now;
  return a.status == b.status && std::equal(a.ivar_basis.begin(), a.ivar_basis.end(), b.ivar_basis.begin(),
                                            b.ivar_basis.end(), same_number);
}

std::vector<LoopPair> loops_in_common(const StudyRun& before, const StudyRun& now) {
  std::vector<LoopPair> loops;
  auto next = before.records.begin();
  for (const ExperimentRecord& record : now.records) {
    while (next != before.records.end() && next->draw.index < record.draw.index)
      ++next;
    if (next != before.records.end() && next->draw.index == record.draw.index)
      loops.push_back({&*next, &record});
  }
  return loops;
}

std::string obstacle_of(const StudyRun& before, const StudyRun& now, const std::vector<LoopPair>& loops) {
  if (!same_variables(before.study.plant, now.study.plant))
    return "the plants have different variables";
  if (before.study.seed != now.study.seed)
    return fmt::format("the seeds differ, {} and {}", before.study.seed, now.study.seed);
  if (loops.empty())
    return "they have no experiment in common";
  for (const LoopPair& loop : loops)
    if (!same_fault(loop.before->draw, loop.now->draw))
      return fmt::format("experiment {} does not have the same fault in both", loop.now->draw.index);
  return {};
}

Correctness right_if(bool right) {
  return right ? Correctness::right : Correctness::wrong;
}

template <FlagTruth truth>
Correctness ask_flag(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  if (record.status != ExperimentStatus::ok || !said.answered())
    return Correctness::not_judged;
  return right_if(said.flagged == to_be_flagged(study, record, truth));
}

Correctness ask_location(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  return judge(study, record, said).location();
}

Correctness ask_source(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  return judge(study, record, said).source();
}

Correctness ask_channel(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  return judge(study, record, said).channel;
}

Correctness ask_parameter(const Study& study, const ExperimentRecord& record, const AssessmentRecord& said) {
  return judge(study, record, said).parameter;
}

constexpr std::array<VerdictQuestion, 6> kQuestions{{
    {"flag, fault", "a loop with a fault is flagged, and no other", &ask_flag<FlagTruth::fault>},
    {"flag, impact", "a loop with a fault that has an impact is flagged, and no other",
     &ask_flag<FlagTruth::impact>},
    {"CV", "the affected CV of a flagged loop is located; in a named scenario every CV is judged rightly",
     &ask_location},
    {"source", "mismatch or disturbance is told where there is one of them", &ask_source},
    {"channel", "the channel of a single mismatch is named", &ask_channel},
    {"parameter", "channel and parameter of a single mismatch are the named ones", &ask_parameter},
}};

// --- Rates ---

/// What is counted of one run of a method.
struct MethodRun {
  const StudyRun& run;
  std::size_t place;

  MethodRates rates(std::span<const ExperimentRecord> records) const {
    return rate_collector(run.study, place, run.calibration).of(records);
  }
};

/// The rate of a single loop is 0 of 0, 0 of 1 or 1 of 1: what it adds to that of all.
std::vector<RateChange> paired_rates(const MethodRun& before, const MethodRun& now,
                                     const std::vector<LoopPair>& loops, double confidence) {
  struct Sums {
    std::int64_t hits_before = 0, before = 0, hits_now = 0, now = 0;
    PairedCounts both;
  };
  const std::span<const MethodRateInfo> infos = method_rate_infos();
  std::vector<Sums> sums(infos.size());
  for (const LoopPair& loop : loops) {
    const MethodRates a = before.rates({loop.before, 1}), b = now.rates({loop.now, 1});
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const Rate &was = a.*infos[i].rate, &is = b.*infos[i].rate;
      sums[i].hits_before += was.hits;
      sums[i].before += was.total;
      sums[i].hits_now += is.hits;
      sums[i].now += is.total;
      if (was.total == 1 && is.total == 1)
        sums[i].both.add(was.hits == 1, is.hits == 1);
    }
  }
  std::vector<RateChange> changes;
  for (std::size_t i = 0; i < infos.size(); ++i)
    changes.push_back({&infos[i], rate(sums[i].hits_before, sums[i].before, confidence),
                       rate(sums[i].hits_now, sums[i].now, confidence), sums[i].both,
                       paired_difference(sums[i].both, confidence)});
  return changes;
}

std::vector<RateChange> unpaired_rates(const MethodRun& before, const MethodRun& now, double confidence) {
  const MethodRates a = before.rates(before.run.records), b = now.rates(now.run.records);
  std::vector<RateChange> changes;
  for (const MethodRateInfo& info : method_rate_infos()) {
    const Rate &was = a.*info.rate, &is = b.*info.rate;
    changes.push_back({&info, was, is, {}, independent_difference(was, is, confidence)});
  }
  return changes;
}

/// Those that something was counted for, with corrected p-values.
std::vector<RateChange> corrected(std::vector<RateChange> changes) {
  std::erase_if(changes,
                [](const RateChange& change) { return change.before.total == 0 && change.now.total == 0; });
  std::vector<double> p;
  for (const RateChange& change : changes)
    if (!std::isnan(change.difference.p))
      p.push_back(change.difference.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (RateChange& change : changes)
    change.p_holm = std::isnan(change.difference.p) ? kNaN : *next++;
  return changes;
}

// --- Verdicts ---

VerdictChange verdict_change(const VerdictQuestion& question, const MethodRun& before, const MethodRun& now,
                             const std::vector<LoopPair>& loops) {
  VerdictChange verdict{&question};
  JudgementChanges& changes = verdict.changes;
  for (const LoopPair& loop : loops) {
    const JudgementPair pair{
        loop.now->draw.index,
        question.ask(before.run.study, *loop.before, loop.before->assessments[before.place]),
        question.ask(now.run.study, *loop.now, loop.now->assessments[now.place])};
    if (pair.before == Correctness::not_judged && pair.now == Correctness::not_judged)
      continue;
    ++changes.pairs;
    const bool was = pair.before == Correctness::right, is = pair.now == Correctness::right;
    verdict.right_in_both += was && is ? 1 : 0;
    if (was && !is)
      changes.lost.push_back(pair);
    if (is && !was)
      changes.gained.push_back(pair);
  }
  changes.test = mcnemar_test(static_cast<std::int64_t>(changes.lost.size()),
                              static_cast<std::int64_t>(changes.gained.size()));
  return verdict;
}

// --- Numbers ---

/// Collects one number over experiments.
class NumberCollection {
 public:
  explicit NumberCollection(std::string label) { change_.label = std::move(label); }

  /// The values of one experiment in both runs.
  void add(std::int64_t index, const Eigen::MatrixXd& before, const Eigen::MatrixXd& now) {
    if (before.size() == 0 || before.rows() != now.rows() || before.cols() != now.cols())
      return;
    double sum = 0.0;
    Eigen::Index finite = 0;
    bool same = true;
    for (Eigen::Index i = 0; i < now.size(); ++i) {
      const double was = before.data()[i], is = now.data()[i];
      same = same && same_number(was, is);
      const double difference = same_number(was, is) ? 0.0 : is - was;
      if (!std::isfinite(was) || !std::isfinite(is))
        continue;
      sum += difference;
      ++finite;
      if (std::abs(difference) > std::abs(change_.largest)) {
        change_.largest = difference;
        change_.index = index;
      }
    }
    if (finite == 0 && same)
      return;  // there is no value in either
    ++change_.experiments;
    change_.same += same ? 1 : 0;
    if (finite > 0)
      differences_.push_back(sum / static_cast<double>(finite));
  }

  NumberChange finish(double confidence) && {
    change_.difference = summarise(differences_, confidence);
    return std::move(change_);
  }

 private:
  NumberChange change_;
  std::vector<double> differences_;
};

Eigen::MatrixXd single(double value) {
  return Eigen::MatrixXd::Constant(1, 1, value);
}

/// The score, and each quantity of loops and CVs that the method has in both runs.
std::vector<NumberChange> number_changes(const MethodRun& before, const MethodRun& now,
                                         const std::vector<LoopPair>& loops, double confidence) {
  std::vector<std::string> names;
  std::vector<NumberCollection> collections{NumberCollection("score")};
  for (const NumberPlace& place : now.run.forms[now.place]->places()) {
    const AssessmentNumberInfo& info = place.info;
    const bool is_of_cv = info.scope == NumberScope::cv;
    if ((!is_of_cv && info.scope != NumberScope::loop) || !info.words.empty() ||
        before.run.forms[before.place]->find(info.name) == nullptr)
      continue;
    names.push_back(info.name);
    collections.emplace_back(info.label.empty() ? info.name : info.label);
  }
  for (const LoopPair& loop : loops) {
    const AssessmentRecord& was = loop.before->assessments[before.place];
    const AssessmentRecord& is = loop.now->assessments[now.place];
    if (!was.answered() || !is.answered())
      continue;
    collections[0].add(loop.now->draw.index, single(was.score), single(is.score));
    for (std::size_t i = 0; i < names.size(); ++i)
      collections[i + 1].add(loop.now->draw.index, was.values(names[i]), is.values(names[i]));
  }
  std::vector<NumberChange> changes;
  for (NumberCollection& collection : collections)
    if (NumberChange change = std::move(collection).finish(confidence); change.experiments > 0)
      changes.push_back(std::move(change));
  return changes;
}

MethodChange method_change(const MethodRun& before, const MethodRun& now, const RunPairing& pairing) {
  const double confidence = now.run.study.aggregate.confidence;
  MethodChange change{now.run.forms[now.place]->method().name, before.place, now.place, {}, {}, {}};
  if (!pairing.paired()) {
    change.rates = corrected(unpaired_rates(before, now, confidence));
    return change;
  }
  change.rates = corrected(paired_rates(before, now, pairing.loops, confidence));
  for (const VerdictQuestion& question : kQuestions)
    if (VerdictChange verdict = verdict_change(question, before, now, pairing.loops);
        verdict.changes.pairs > 0)
      change.verdicts.push_back(std::move(verdict));
  change.numbers = number_changes(before, now, pairing.loops, confidence);
  return change;
}

/// Corrects the p-values of all questions.
void correct_questions(std::vector<MethodChange>& methods) {
  std::vector<double> p;
  for (const MethodChange& method : methods)
    for (const VerdictChange& verdict : method.verdicts)
      p.push_back(verdict.changes.test.p_two_sided);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (MethodChange& method : methods)
    for (VerdictChange& verdict : method.verdicts)
      verdict.p_holm = *next++;
}

}  // namespace

RunPairing pair_runs(const StudyRun& before, const StudyRun& now) {
  std::vector<LoopPair> loops = loops_in_common(before, now);
  RunPairing pairing{obstacle_of(before, now, loops)};
  if (!pairing.paired())
    return pairing;
  pairing.same_loops = std::count_if(loops.begin(), loops.end(), same_loop);
  pairing.loops = std::move(loops);
  return pairing;
}

std::span<const VerdictQuestion> verdict_questions() {
  return kQuestions;
}

bool MethodChange::changed() const {
  return std::any_of(verdicts.begin(), verdicts.end(),
                     [](const VerdictChange& each) {
                       return !each.changes.lost.empty() || !each.changes.gained.empty();
                     }) ||
         std::any_of(numbers.begin(), numbers.end(),
                     [](const NumberChange& each) { return each.same < each.experiments; });
}

std::vector<MethodChange> method_changes(const StudyRun& before, const StudyRun& now,
                                         const RunPairing& pairing) {
  std::vector<MethodChange> changes;
  for (std::size_t place = 0; place < now.forms.size(); ++place)
    for (std::size_t old = 0; old < before.forms.size(); ++old)
      if (before.forms[old]->method().name == now.forms[place]->method().name)
        changes.push_back(method_change({before, old}, {now, place}, pairing));
  correct_questions(changes);
  return changes;
}

}  // namespace mpm
