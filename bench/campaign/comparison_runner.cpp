#include "bench/campaign/comparison_runner.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/cache/loop_memory.hpp"
#include "bench/campaign/revisited_loops.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "results/files/byte_stream.hpp"
#include "scenarios/loop/calibration.hpp"

namespace mpm {
namespace {

/// Changes every record: at once if the records are in memory, whenever one is read if they are streamed.
void change_records(Campaign& campaign, const std::function<RecordChange()>& begin) {
  if (campaign.streamed) {
    campaign.streamed = changed(*campaign.streamed, begin);
    return;
  }
  const RecordChange change = begin();
  for (ExperimentRecord& record : campaign.records)
    change(record);
}

/// The entries of a list at these places.
template <class List>
List chosen(const List& all, const std::vector<std::size_t>& places) {
  List list;
  for (const std::size_t place : places)
    list.push_back(all[place]);
  return list;
}

/// The places of the methods of a campaign that are not among `forms`.
std::vector<std::size_t> places_of_others(const Campaign& campaign, const AssessmentForms& forms) {
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < campaign.methods.size(); ++place)
    if (std::none_of(forms.begin(), forms.end(), [&](const auto& form) {
          return form->method().name == campaign.methods[place].form->method().name;
        }))
      places.push_back(place);
  return places;
}

/// Returns the answers of further methods about a record; none about a loop that they were not asked about.
/// The records must come one after the other, in the order of their index.
using Answers = std::function<std::vector<AssessmentRecord>(const ExperimentRecord&)>;

/// The answers in `assessed`, which has records of the same experiments or of some of them.
Answers answers_in(const RecordRange& assessed) {
  RecordRange::Next next = assessed.one_by_one();
  const ExperimentRecord* const first = next();
  return [next = std::move(next), at = first](const ExperimentRecord& record) mutable {
    while (at != nullptr && (at->draw.index < record.draw.index || at->assessments.empty()))
      at = next();
    return at != nullptr && at->draw.index == record.draw.index ? at->assessments
                                                                : std::vector<AssessmentRecord>();
  };
}

/// Appends the answers of further methods to those of the campaign, and replaces answers that it already has
/// of these methods. `begin` gives the answers for one pass through the records.
void append(Campaign& campaign, const AssessmentForms& forms, const std::function<Answers()>& begin,
            const std::string& command) {
  const std::vector<std::size_t> others = places_of_others(campaign, forms);
  campaign.methods = chosen(campaign.methods, others);
  for (const auto& form : forms)
    campaign.methods.push_back({form, mpmbench_version(), source_revision(), command});
  change_records(campaign, [forms, others, begin]() -> RecordChange {
    return [forms, others, answers = begin()](ExperimentRecord& record) {
      std::vector<AssessmentRecord> further = answers(record);
      if (further.empty())
        further = unassessed(forms);
      record.assessments = chosen(record.assessments, others);
      std::move(further.begin(), further.end(), std::back_inserter(record.assessments));
    };
  });
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores = chosen(loop.scores, others);
}

}  // namespace

ComparedLoops compared_loops(const Campaign& campaign, const std::vector<std::string>& asked,
                             const std::optional<std::int64_t>& experiments) {
  ComparedLoops loops;
  const std::vector<std::string> names = method_names(campaign);
  std::vector<bool> whole(names.size(), true);
  records_of(campaign).each([&](const ExperimentRecord& record) {
    loops.end = record.draw.index + 1;
    if (record.status != ExperimentStatus::ok || (experiments && record.draw.index >= *experiments))
      return;
    loops.experiments.push_back(record.draw.index);
    for (std::size_t place = 0; place < names.size(); ++place)
      if (record.assessments[place].status == AssessmentStatus::not_assessed)
        whole[place] = false;
  });
  for (const std::string& method : asked)
    if (const auto place =
            static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin());
        place == names.size() || !whole[place])
      loops.missing.push_back(method);
  return loops;
}

std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command) {
  std::vector<CampaignMethod> methods;
  for (auto& form : assessment_forms(study, study_methods(study)))
    methods.push_back({std::move(form), mpmbench_version(), source_revision(), command});
  return methods;
}

namespace {

/// The study of an archive, with the further methods instead of its own.
Study study_with(Study study, const std::vector<std::string>& methods) {
  study.methods = methods;
  return study;
}

RunOptions run_options(const Campaign& campaign, const ComparedLoops& loops,
                       const ComparisonOptions& options) {
  return {.experiments = loops.end,
          .solver = campaign.info.solver,
          .audit_share = 0.0,
          .store = StorePolicy::none,
          .archive = options.archive,
          .jobs = std::max(1, options.jobs),
          .leftovers = options.kept.leftovers,
          .shard_interval = options.kept.interval,
          .cache = options.cache,
          .fresh = options.fresh,
          .threshold_options = options.threshold_options};
}

/// The numbers of blind loops in the order in which the loops are made: experiments in the order of the
/// records, then calibration loops.
std::vector<std::int64_t> numbers_in_turn(const std::vector<BlindLoop>& order) {
  std::vector<std::int64_t> numbers(order.size());
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  const auto turn = [&](std::int64_t number) {
    const BlindLoop& loop = order[static_cast<std::size_t>(number)];
    return std::pair(loop.of_calibration, loop.place);
  };
  std::sort(numbers.begin(), numbers.end(),
            [&](std::int64_t one, std::int64_t other) { return turn(one) < turn(other); });
  return numbers;
}

/// Converts a loop, as methods see it, to bytes or back.
template <class Stream, class Loop>
void transfer_loop(Stream& stream, Loop& loop) {
  for (const LoopSignal& signal : loop_signals())
    transfer(stream, loop.*signal.member);
}

}  // namespace

Comparison::Comparison(const Campaign& campaign, const ComparedLoops& loops, const ComparisonOptions& options)
    : campaign_(campaign),
      loops_(study_with(campaign.study, options.methods), run_options(campaign, loops, options)),
      store_(options.shards ? loops_.open(*options.shards, options.kept.warn) : loops_.in_memory()) {
  std::vector<std::int64_t> all = loops.experiments;
  for (std::int64_t index = 0; index < std::ssize(campaign.calibration.loops); ++index)
    all.push_back(kCalibrationKeys + index);
  for (std::size_t place = 0; place < all.size(); ++place)
    if (is_in_part(place, options.part))
      keys_.push_back(all[place]);
  for (const std::filesystem::path& part : options.parts)
    store_.take_stock(shards_in(part), options.kept.warn);
}

template <class Assess>
LoopResult Comparison::kept_answers(std::int64_t key, ExperimentRecord record, const Assess& assess) const {
  if (key < kCalibrationKeys) {
    record.assessments = assess(record);
    record.loop.reset();  // the archive has both
    record.truth.reset();
  }
  return loops_.result(key, {.record = std::move(record), .samples = {}, .audited = {}});
}

std::vector<AssessmentRecord> Comparison::lost_answers(const std::string& why) const {
  std::vector<AssessmentRecord> answers =
      unassessed(assessment_forms(loops_.study(), loops_.study().methods));
  for (AssessmentRecord& answer : answers) {
    answer.status = AssessmentStatus::failed;
    answer.reason = why;
  }
  return answers;
}

void Comparison::run(const CampaignHooks& hooks) {
  std::optional<LoopMemory> memory;
  if (loops_.options().cache && LoopMemory::may_keep(loops_.study(), loops_.options()))
    memory.emplace(loops_.study(), loops_.calibrates() ? &loops_.calibration() : nullptr, loops_.options());
  const RevisitedLoops revisited{
      .campaign = campaign_,
      .study = loops_.study(),
      .calibration = campaign_.calibration.loops.empty() ? nullptr : &loops_.calibration(),
      .methods = loops_.study().methods,
      .calibration_store = StorePolicy::none,
      .place =
          [](std::int64_t key) {
            return LoopPlace{key % kCalibrationKeys, key >= kCalibrationKeys};
          },
      .make =
          [this](std::int64_t key, ExperimentRunner& runner, ExperimentRecord record) {
            return kept_answers(key, std::move(record), [&](const ExperimentRecord& of) {
              return of.assessments.empty() ? runner.assess(of) : of.assessments;
            });
          },
      .lost =
          [this](std::int64_t key, ExperimentRecord record, const std::string& why) {
            return kept_answers(key, std::move(record), [&](const auto&) { return lost_answers(why); });
          },
      .memory = memory ? &*memory : nullptr};
  const KeepAtEnd keeper(revisited.memory, hooks.on_warning);
  run_revisited(store_, keys_, revisited, loops_.options().jobs, hooks);
}

void Comparison::add_to(Campaign& campaign, const std::string& command, const StopRequest& stop) {
  append(
      campaign, assessment_forms(loops_.study(), loops_.study().methods),
      [assessed = loops_.experiment_records(store_, stop)] { return answers_in(assessed); }, command);
  if (campaign.calibration.loops.empty())
    return;
  const Calibration scored = calibration_of(loops_.calibration(), loops_.calibration_records(store_, stop));
  for (std::size_t i = 0; i < scored.loops.size(); ++i) {
    std::vector<double>& scores = campaign.calibration.loops[i].scores;
    scores.insert(scores.end(), scored.loops[i].scores.begin(), scored.loops[i].scores.end());
  }
}

void run_blind_loops(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                     const CampaignHooks& hooks, ShardStore& store) {
  std::optional<Study> calibration;
  if (campaign.study.calibration)
    calibration = calibration_study(campaign.study);
  const auto place = [&](std::int64_t number) {
    const BlindLoop& loop = order[static_cast<std::size_t>(number)];
    return LoopPlace{loop.index, loop.of_calibration};
  };
  const auto make = [has_own_benchmark = campaign.study.world.has_value()](
                        std::int64_t, ExperimentRunner& runner, const ExperimentRecord& record) {
    const bool ran = record.status == ExperimentStatus::ok;
    const AssessedLoop loop = ran ? runner.loop_of(record) : AssessedLoop(),
                       benchmark = ran && has_own_benchmark ? runner.benchmark_of(record) : AssessedLoop();
    ByteWriter writer;
    transfer_loop(writer, loop);
    transfer_loop(writer, benchmark);
    return LoopResult{.bytes = writer.take()};
  };
  const auto lost = [&](std::int64_t number, const ExperimentRecord& record,
                        const std::string& why) -> LoopResult {
    throw std::runtime_error(fmt::format("{} {}: {}",
                                         place(number).of_calibration ? "calibration loop" : "experiment",
                                         record.draw.index, why));
  };
  run_revisited(store, numbers_in_turn(order),
                {.campaign = campaign,
                 .study = campaign.study,
                 .calibration = calibration ? &*calibration : nullptr,
                 .methods = {},
                 .calibration_store = StorePolicy::all,
                 .place = place,
                 .make = make,
                 .lost = lost},
                jobs, hooks);
}

namespace {

/// The loops at this place in each result: 0 for the blind loops, 1 for their benchmarks.
BlindLoops loops_at(int place, const ShardStore& store, std::size_t count) {
  return {count, [place, &store, count]() -> BlindLoops::Next {
            return [place, next = store.in_order(0, static_cast<std::int64_t>(count))] {
              ByteReader reader(next()->bytes);
              AssessedLoop loop;
              for (int at = 0; at <= place; ++at)
                transfer_loop(reader, loop);
              return loop;
            };
          }};
}

}  // namespace

BlindLoops blind_loops_in(const ShardStore& store, std::size_t count) {
  return loops_at(0, store, count);
}

BlindLoops blind_benchmarks_in(const ShardStore& store, std::size_t count) {
  return loops_at(1, store, count);
}

void add_verdicts(Campaign& campaign, OutsideVerdicts verdicts, const std::string& command) {
  const auto answers = std::make_shared<const std::vector<AssessmentRecord>>(std::move(verdicts.answers));
  append(
      campaign, {verdicts.form},
      [answers]() -> Answers {
        return [answers, place = std::size_t{0}](const ExperimentRecord&) mutable {
          return std::vector<AssessmentRecord>{(*answers)[place++]};
        };
      },
      command);
  for (std::size_t i = 0; i < campaign.calibration.loops.size(); ++i)
    campaign.calibration.loops[i].scores.push_back(verdicts.calibration_scores[i]);
}

Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments) {
  const std::vector<std::string> names = method_names(campaign);
  std::vector<std::size_t> places;
  for (const std::string& method : methods)
    places.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin()));
  campaign.methods = chosen(campaign.methods, places);
  RecordChange choose = [places, experiments, forms = forms_of(campaign)](ExperimentRecord& record) {
    record.assessments = experiments && record.draw.index >= *experiments
                             ? unassessed(forms)
                             : chosen(record.assessments, places);
  };
  change_records(campaign, [choose] { return choose; });
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores = chosen(loop.scores, places);
  return campaign;
}

}  // namespace mpm
