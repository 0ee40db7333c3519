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

/// Whether both experiments have the same fault, of the same size.
bool same_fault(const ExperimentDraw& a, const ExperimentDraw& b) {
  return a.kind == b.kind && a.mismatches == b.mismatches && a.disturbances == b.disturbances &&
         a.named == b.named && a.affected_cvs == b.affected_cvs && a.parameters == b.parameters &&
         a.tuning == b.tuning && a.other == b.other && a.onset == b.onset && a.scales == b.scales &&
         a.noise_factor == b.noise_factor;
}

/// Whether two numbers are the same as they are in a file, where a NaN equals a NaN.
bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_loop(const ExperimentRecord& a, const ExperimentRecord& b) {
  return a.status == b.status && std::equal(a.ivar_basis.begin(), a.ivar_basis.end(), b.ivar_basis.begin(),
                                            b.ivar_basis.end(), same_number);
}

/// Returns what keeps the runs from being paired, whatever their experiments are; empty: nothing.
std::string obstacle_of(const Study& before, const Study& now) {
  if (!same_variables(before.plant, now.plant))
    return "the plants have different variables";
  if (before.seed != now.seed)
    return fmt::format("the seeds differ, {} and {}", before.seed, now.seed);
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
    {"flag_fault", "flag, fault", "loops with a fault are flagged, and no others",
     &ask_flag<FlagTruth::fault>},
    {"flag_impact", "flag, impact", "loops with a fault that has an impact are flagged, and no others",
     &ask_flag<FlagTruth::impact>},
    {"located", "CV",
     "the affected CV of a flagged loop is located; in a named scenario, every CV is judged correctly",
     &ask_location},
    {"source", "source", "the source is right in loops with either a mismatch or a disturbance", &ask_source},
    {"channel", "channel", "the channel of a single mismatch is named", &ask_channel},
    {"parameter", "parameter", "the channel and parameter of a single mismatch are named", &ask_parameter},
}};

// --- Rates ---

/// One run of a method.
struct MethodRun {
  const StudyRun& run;
  std::size_t place;

  const AssessmentRecord& said(const ExperimentRecord& record) const { return record.assessments[place]; }
  Collector<MethodRates> rates() const { return rate_collector(run.study, place, run.calibration); }
};

/// Counts the loops of paired runs. The rate of a single loop is 0 of 0, 0 of 1 or 1 of 1, which is what the
/// loop adds to the rate of all loops.
class PairedRates {
 public:
  void add(int world, const MethodRates& before, const MethodRates& now) {
    for (const RateRow& row : rate_rows()) {
      const Rate &was = before.rates.of(row), &is = now.rates.of(row);
      Sums& sums = sums_.of(row);
      sums.before.add(world, {was.hits, was.total});
      sums.now.add(world, {is.hits, is.total});
      if (was.total == 1 && is.total == 1)
        sums.both.add(world, was.hits == 1, is.hits == 1);
    }
  }

  std::vector<RateChange> changes(double confidence) const {
    std::vector<RateChange> changes;
    for (const RateRow& row : rate_rows()) {
      const Sums& sums = sums_.of(row);
      changes.push_back({&row, sums.before.rate(confidence), sums.now.rate(confidence), sums.both.sum(),
                         sums.both.difference(confidence)});
    }
    return changes;
  }

 private:
  struct Sums {
    WorldCount before, now;
    WorldPairs both;
  };

  RowValues<RateRow, Sums> sums_{rate_rows()};
};

std::vector<RateChange> unpaired_rates(const MethodRates& before, const MethodRates& now, double confidence) {
  std::vector<RateChange> changes;
  for (const RateRow& row : rate_rows()) {
    const Rate &was = before.rates.of(row), &is = now.rates.of(row);
    changes.push_back({&row, was, is, {}, independent_difference(was, is, confidence)});
  }
  return changes;
}

/// Keeps the changes of rates that count a loop in at least one run, and corrects their p-values.
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

/// Asks every question about a method that both runs have, one paired experiment after the other.
class VerdictComparison {
 public:
  VerdictComparison(const MethodRun& before, const MethodRun& now) : before_(before), now_(now) {
    for (const VerdictQuestion& question : kQuestions)
      verdicts_.push_back({&question});
  }

  void add_pair(const ExperimentRecord& before, const ExperimentRecord& now) {
    for (VerdictChange& verdict : verdicts_)
      verdict.changes.add(
          {now.draw.index, verdict.question->ask(before_.run.study, before, before_.said(before)),
           verdict.question->ask(now_.run.study, now, now_.said(now))},
          now.draw.world);
  }

  /// Returns the questions that were judged.
  std::vector<VerdictChange> finish() && {
    std::erase_if(verdicts_, [](const VerdictChange& verdict) { return verdict.changes.pairs == 0; });
    return std::move(verdicts_);
  }

 private:
  MethodRun before_, now_;
  std::vector<VerdictChange> verdicts_;
};

// --- Numbers ---

/// Collects one number over experiments.
class NumberCollection {
 public:
  explicit NumberCollection(std::string label) { change_.label = std::move(label); }

  /// Adds the values of one experiment in both runs.
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

/// Collects the score, and each quantity of loops and CVs that the method has in both runs.
class NumberChanges {
 public:
  NumberChanges(const AssessmentForm& before, const AssessmentForm& now) {
    for (const NumberPlace& place : now.places()) {
      const AssessmentNumberInfo& info = place.info;
      const bool is_of_cv = info.scope == NumberScope::cv;
      if ((!is_of_cv && info.scope != NumberScope::loop) || !info.words.empty() ||
          before.find(info.name) == nullptr)
        continue;
      names_.push_back(info.name);
      collections_.emplace_back(info.heading.empty() ? info.name : info.heading);
    }
  }

  void add(std::int64_t index, const AssessmentRecord& was, const AssessmentRecord& is) {
    if (!was.answered() || !is.answered())
      return;
    collections_[0].add(index, single(was.score), single(is.score));
    for (std::size_t i = 0; i < names_.size(); ++i)
      collections_[i + 1].add(index, was.values(names_[i]), is.values(names_[i]));
  }

  std::vector<NumberChange> finish(double confidence) && {
    std::vector<NumberChange> changes;
    for (NumberCollection& collection : collections_)
      if (NumberChange change = std::move(collection).finish(confidence); change.experiments > 0)
        changes.push_back(std::move(change));
    return changes;
  }

 private:
  std::vector<std::string> names_;
  std::vector<NumberCollection> collections_{NumberCollection("score")};
};

/// Compares a method that both runs have, one experiment after the other.
class MethodComparison {
 public:
  MethodComparison(const MethodRun& before, const MethodRun& now)
      : before_(before),
        now_(now),
        verdicts_(before, now),
        numbers_(*before.run.forms[before.place], *now.run.forms[now.place]),
        rates_before_(before.rates()),
        rates_now_(now.rates()) {}

  /// Adds an experiment that both runs have; only for paired runs.
  void add_pair(const ExperimentRecord& before, const ExperimentRecord& now) {
    rates_.add(now.draw.world, before_.rates().of(std::span(&before, 1)),
               now_.rates().of(std::span(&now, 1)));
    verdicts_.add_pair(before, now);
    numbers_.add(now.draw.index, before_.said(before), now_.said(now));
  }

  /// Adds an experiment of one of the runs; only for runs that are not paired.
  void add_before(const ExperimentRecord& record) { rates_before_.add(record); }
  void add_now(const ExperimentRecord& record) { rates_now_.add(record); }

  MethodChange finish(bool paired) && {
    const double confidence = now_.run.study.aggregate.confidence;
    MethodChange change{now_.run.forms[now_.place]->method().name, before_.place, now_.place, {}, {}, {}};
    if (!paired) {
      change.rates = corrected(unpaired_rates(rates_before_.result(), rates_now_.result(), confidence));
      return change;
    }
    change.rates = corrected(rates_.changes(confidence));
    change.verdicts = std::move(verdicts_).finish();
    change.numbers = std::move(numbers_).finish(confidence);
    return change;
  }

 private:
  MethodRun before_, now_;
  PairedRates rates_;
  VerdictComparison verdicts_;
  NumberChanges numbers_;
  Collector<MethodRates> rates_before_, rates_now_;
};

/// Returns every method that both runs have, with its place in each, in the order of the second run.
std::vector<std::pair<MethodRun, MethodRun>> methods_in_both(const StudyRun& before, const StudyRun& now) {
  std::vector<std::pair<MethodRun, MethodRun>> methods;
  for (std::size_t place = 0; place < now.forms.size(); ++place)
    for (std::size_t old = 0; old < before.forms.size(); ++old)
      if (before.forms[old]->method().name == now.forms[place]->method().name)
        methods.emplace_back(MethodRun{before, old}, MethodRun{now, place});
  return methods;
}

/// Corrects the p-values of all questions.
void correct_questions(std::vector<MethodChange>& methods) {
  std::vector<double> p;
  for (const MethodChange& method : methods)
    for (const VerdictChange& verdict : method.verdicts)
      p.push_back(verdict.changes.test().p_two_sided);
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (MethodChange& method : methods)
    for (VerdictChange& verdict : method.verdicts)
      verdict.p_holm = *next++;
}

}  // namespace

RunPairing pair_runs(const StudyRun& before, const StudyRun& now) {
  if (std::string obstacle = obstacle_of(before.study, now.study); !obstacle.empty())
    return {std::move(obstacle)};
  RunPairing pairing;
  each_in_both(before.records, now.records, [&](const ExperimentRecord& a, const ExperimentRecord& b) {
    ++pairing.loops;
    pairing.same_loops += same_loop(a, b) ? 1 : 0;
    if (pairing.paired() && !same_fault(a.draw, b.draw))
      pairing.obstacle = fmt::format("experiment {} does not have the same fault in both", b.draw.index);
  });
  if (pairing.loops == 0)
    pairing.obstacle = "they have no experiment in common";
  return pairing.paired() ? pairing : RunPairing{std::move(pairing.obstacle)};
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
  std::vector<MethodComparison> methods;
  for (const auto& [was, is] : methods_in_both(before, now))
    methods.emplace_back(was, is);
  const auto for_all = [&methods](auto add) {
    return [&methods, add](const auto&... records) {
      for (MethodComparison& method : methods)
        (method.*add)(records...);
    };
  };
  if (pairing.paired()) {
    each_in_both(before.records, now.records, for_all(&MethodComparison::add_pair));
  } else {
    before.records.each(for_all(&MethodComparison::add_before));
    now.records.each(for_all(&MethodComparison::add_now));
  }
  std::vector<MethodChange> changes;
  for (MethodComparison& method : methods)
    changes.push_back(std::move(method).finish(pairing.paired()));
  correct_questions(changes);
  return changes;
}

std::vector<MethodChange> verdict_changes(const StudyRun& before, const StudyRun& now) {
  const std::vector<std::pair<MethodRun, MethodRun>> methods = methods_in_both(before, now);
  std::vector<VerdictComparison> comparisons;
  for (const auto& [was, is] : methods)
    comparisons.emplace_back(was, is);
  each_in_both(before.records, now.records, [&](const ExperimentRecord& was, const ExperimentRecord& is) {
    for (VerdictComparison& comparison : comparisons)
      comparison.add_pair(was, is);
  });
  std::vector<MethodChange> changes;
  for (std::size_t i = 0; i < methods.size(); ++i)
    changes.push_back({now.forms[methods[i].second.place]->method().name,
                       methods[i].first.place,
                       methods[i].second.place,
                       {},
                       std::move(comparisons[i]).finish(),
                       {}});
  correct_questions(changes);
  return changes;
}

}  // namespace mpm
