#include "bench/campaign/campaign_loops.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/same_members.hpp"
#include "base/system/surroundings.hpp"
#include "bench/cache/loop_memory.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/thread_worker.hpp"
#include "results/archive/loop_rows.hpp"
#include "scenarios/loop/calibration.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

void require_options(const RunOptions& options) {
  if (options.jobs < 1)
    throw InputError("jobs", fmt::format("{}", options.jobs), "a whole number >= 1");
  if (!(options.audit_share >= 0.0 && options.audit_share <= 1.0))
    throw InputError("audit share", fmt::format("{}", options.audit_share), "a number from 0 to 1");
  qp_solver_factory(options.solver);  // refuses an unknown solver
}

/// The options with which experiments run. If a cache keeps their loops, each record has its loop.
RunOptions with_loops(RunOptions options, bool kept) {
  options.store = kept ? StorePolicy::all : options.store;
  return options;
}

/// What one thread or process works with.
struct CampaignWorker {
  CampaignWorker(const CampaignLoops& loops, const BasisCase& basis, const QpSolverFactory& factory,
                 bool keeps)
      : experiment_run(with_loops(loops.options(), keeps)),
        calibration_run(with_loops(calibration_options(loops.options()), keeps)),
        experiments(loops.study(), loops.study(), basis, experiment_run, factory) {
    if (loops.count() > loops.experiments())
      calibration.emplace(loops.calibration(), loops.study(), basis, calibration_run, factory);
  }

  ExperimentWork& work(std::int64_t key) { return key < kCalibrationKeys ? experiments : *calibration; }
  ExperimentOutcome run(std::int64_t key) { return work(key).run(key % kCalibrationKeys); }

  RunOptions experiment_run, calibration_run;
  ExperimentWork experiments;
  std::optional<ExperimentWork> calibration;
};

std::optional<KnownLoop> known_in(const LoopMemory* memory, std::int64_t key) {
  return memory == nullptr ? std::nullopt : memory->find(key);
}

bool earlier(const AuditedStep& one, const AuditedStep& other) {
  return std::tie(one.experiment, one.step) < std::tie(other.experiment, other.step);
}

/// The names of the audit results that differ, over the steps that both outcomes have audited.
std::vector<std::string> audit_differences(const ExperimentOutcome& one, const ExperimentOutcome& other) {
  std::vector<std::string> names;
  for (const AuditedStep& here : one.audited)
    for (const AuditedStep& there : other.audited)
      if (!earlier(here, there) && !earlier(there, here))
        for (const Row<AuditedStep>& row : audit_rows())
          if (!same(numbers_of(row, here).front(), numbers_of(row, there).front()))  // NaN: no answer
            names.push_back(fmt::format("audit of step {}: {}", here.step, row.text.name));
  return names;
}

}  // namespace

std::int64_t experiment_count(const Study& study, const RunOptions& options) {
  const std::int64_t count = options.experiments.value_or(study.experiment_count());
  if (study.names_scenarios() && count > study.experiment_count())
    throw InputError("experiments", fmt::format("{}", count),
                     fmt::format("at most {}, the named scenarios of the study", study.experiment_count()));
  if (count < 1)
    throw InputError("experiments", fmt::format("{}", count), "a whole number >= 1");
  return count;
}

std::int64_t calibration_loops(const Study& study) {
  return study.calibration ? study.calibration->healthy + study.calibration->ud : 0;
}

RunOptions calibration_options(RunOptions options) {
  options.experiments.reset();
  options.audit_share = 0.0;
  options.store = StorePolicy::none;
  return options;
}

CampaignLoops::CampaignLoops(Study study, RunOptions options)
    : study_(std::move(study)),
      options_(std::move(options)),
      experiments_(experiment_count(study_, options_)),
      bytes_(study_) {
  require_options(options_);
  runs_in_threads(study_, options_);  // refuses threads if the solver must not run in them
  if (!study_.calibration)
    return;
  calibration_ = calibration_study(study_);
  calibration_bytes_.emplace(*calibration_);
}

std::vector<std::int64_t> CampaignLoops::keys(const LoopRanges& loops) const {
  std::vector<std::int64_t> keys = indices_in(loops);
  for (std::int64_t& key : keys)
    key = key < experiments_ ? key : kCalibrationKeys + key - experiments_;
  return keys;
}

LoopRanges CampaignLoops::loops(const std::vector<std::int64_t>& keys) const {
  std::vector<std::int64_t> indices = keys;
  for (std::int64_t& index : indices)
    index = index < kCalibrationKeys ? index : experiments_ + index - kCalibrationKeys;
  return ranges_of(indices);
}

ShardStore CampaignLoops::open(const std::filesystem::path& folder, const ShardStore::Warn& warn) const {
  ShardStore store(folder, shard_identity(study_, options_),
                   {options_.leftovers, options_.shard_interval, warn});
  const ShardStore::Next beyond = store.in_order(experiments_, kCalibrationKeys);
  std::string found;
  std::int64_t most = 0;
  while (const ShardStore::Entry* const entry = beyond()) {
    most = entry->key;
    found = entry->shard->string();
  }
  if (!found.empty() && options_.leftovers == Leftovers::renew)
    store.clear();
  else if (!found.empty())
    throw InputError("--experiments", fmt::format("{}", experiments_),
                     fmt::format("{} or more, since {} holds experiment {}; or --discard to start again",
                                 most + 1, found, most));
  return store;
}

LoopResult CampaignLoops::kept_result(std::int64_t key, ExperimentOutcome outcome, const LoopMemory* memory,
                                      bool by_process) const {
  std::string aside;
  if (memory != nullptr) {
    const KnownLoop loop{.record = outcome.record,
                         .by_process = by_process,
                         .audit_share = key < kCalibrationKeys ? audited_share(study_, options_) : 0.0,
                         .audited = outcome.audited};
    aside = memory->to_keep(key, loop);
    outcome.record.loop.reset();
  }
  LoopResult result = this->result(key, outcome);
  result.aside = std::move(aside);
  return result;
}

LoopResult CampaignLoops::heard_result(std::int64_t key, KnownLoop known, const LoopMemory& memory,
                                       ExperimentWork& work) const {
  if (!known.unheard.empty())
    work.assess(known.record, known.unheard);
  known.require_expected();
  std::string aside = memory.to_keep(known);
  known.record.loop.reset();
  LoopResult result = this->result(
      key, {.record = std::move(known.record), .samples = {}, .audited = std::move(known.audited)});
  result.aside = std::move(aside);
  return result;
}

LoopWork CampaignLoops::work(const BasisCase& basis, const ShardStore::Warn& warn, LoopMemory* memory) const {
  LoopWork work{.jobs = options_.jobs, .on_warning = warn};
  if (memory != nullptr)
    work.on_aside = [memory](std::int64_t key, std::string aside) { memory->take(key, std::move(aside)); };
  const bool in_threads = runs_in_threads(study_, options_);
  const bool fall_back = options_.solver == "auto" && !study_.controller_program;
  if (in_threads)
    work.thread = [this, &basis, fall_back, memory] {
      const auto make = [this, &basis, memory](const QpSolverFactory& factory) {
        return std::make_unique<CampaignWorker>(*this, basis, factory, memory != nullptr);
      };
      return
          [this, fall_back, memory, worker = std::make_shared<ThreadWorker<CampaignWorker>>(make, fall_back)](
              std::int64_t key) -> LoopResult {
            LoopResult for_process{.bytes = "", .unfinished = true};
            const std::optional<LoopResult> done = worker->run([&](CampaignWorker& each) {
              if (std::optional<KnownLoop> known = known_in(memory, key))
                return known->by_process && !known->unheard.empty()
                           ? for_process
                           : heard_result(key, *std::move(known), *memory, each.work(key));
              ExperimentOutcome outcome = each.run(key);
              if (fall_back && outcome.record.status == ExperimentStatus::failed)
                return for_process;
              if (outcome.samples.empty())
                return kept_result(key, std::move(outcome), memory, false);
              LoopResult result = this->result(key, outcome);
              result.unfinished = true;
              return result;
            });
            return done.value_or(for_process);
          };
    };
  if (!in_threads || fall_back || audited_share(study_, options_) > 0.0)
    work.process = [this, memory,
                    worker = std::make_shared<CampaignWorker>(
                        *this, basis, qp_solver_factory(options_.solver), memory != nullptr)](
                       std::int64_t key, const std::string& begun) {
      if (std::optional<KnownLoop> known = known_in(memory, key)) {
        known->by_process = true;  // a process gives the new answers
        return heard_result(key, *std::move(known), *memory, worker->work(key));
      }
      ExperimentOutcome outcome = begun.empty() ? worker->run(key) : bytes(key).from_bytes(begun);
      worker->experiments.audit(outcome);
      return kept_result(key, std::move(outcome), memory, begun.empty());
    };
  work.lost = [this, warn, keeps = memory != nullptr](std::int64_t key, const std::string& begun,
                                                      const std::string& why,
                                                      bool again) -> std::optional<LoopResult> {
    ExperimentOutcome outcome;
    if (begun.empty()) {
      const bool calibrates = key >= kCalibrationKeys;
      outcome.record =
          lost_record(calibrates ? calibration() : study_, calibrates ? key - kCalibrationKeys : key, why);
      return result(key, outcome);
    }
    outcome = bytes(key).from_bytes(begun);
    if (keeps)
      outcome.record.loop.reset();
    if (warn)
      warn(fmt::format("the audit of {} steps of experiment {} was lost: {}; the steps are {}",
                       outcome.samples.size(), key, why, again ? "left out of the audit" : "audited again"));
    if (!again)
      return std::nullopt;
    outcome.samples.clear();  // they count neither as agreement nor as disagreement
    return result(key, outcome);
  };
  return work;
}

const OutcomeBytes& CampaignLoops::bytes(std::int64_t key) const {
  if (key >= kCalibrationKeys && !calibration_bytes_)
    throw std::runtime_error("a calibration loop of a campaign that has none");
  return key < kCalibrationKeys ? bytes_ : *calibration_bytes_;
}

LoopResult CampaignLoops::result(std::int64_t key, const ExperimentOutcome& outcome) const {
  return {.bytes = bytes(key).to_bytes(outcome), .failed = outcome.record.status == ExperimentStatus::failed};
}

ExperimentOutcome CampaignLoops::outcome(const ShardStore::Entry& entry) const {
  if (entry.shard == nullptr)
    return bytes(entry.key).from_bytes(entry.bytes);
  try {
    ExperimentOutcome outcome = bytes(entry.key).from_bytes(entry.bytes);
    if (outcome.record.draw.index != entry.key % kCalibrationKeys)
      throw std::runtime_error(fmt::format("loop {}", outcome.record.draw.index));
    return outcome;
  } catch (const std::exception& error) {  // also an InputError that refuses numbers in the bytes
    if (is_of_surroundings(error))
      throw;
    throw UnreadableShard(*entry.shard, fmt::format("entry {}: {}", entry.key, error.what()));
  }
}

RecordRange CampaignLoops::records(const ShardStore& store, const StopRequest& stop, std::int64_t first,
                                   std::int64_t count) const {
  return {static_cast<std::size_t>(count), [=, this, &store]() -> RecordRange::Next {
            return [=, this, next = store.in_order(first, first + count), last = std::int64_t{-1},
                    outcome = std::make_shared<ExperimentOutcome>()]() mutable -> const ExperimentRecord* {
              if (requested(stop))
                throw Interrupted(count, count);
              const ShardStore::Entry* entry = next();
              while (entry != nullptr && entry->key == last)
                entry = next();
              if (entry == nullptr)
                return nullptr;
              last = entry->key;
              *outcome = this->outcome(*entry);
              return &outcome->record;
            };
          }};
}

RecordRange CampaignLoops::experiment_records(const ShardStore& store, const StopRequest& stop) const {
  return records(store, stop, 0, experiments_);
}

RecordRange CampaignLoops::calibration_records(const ShardStore& store, const StopRequest& stop) const {
  return records(store, stop, kCalibrationKeys, count() - experiments_);
}

void CampaignLoops::require_one_result(const ShardStore& store) const {
  if (!store.has_repeated())
    return;
  const ShardStore::Next next = store.in_order(0, kCalibrationKeys + count());
  ShardStore::Entry first{.key = -1, .bytes = ""};
  while (const ShardStore::Entry* const entry = next()) {
    if (entry->key != first.key) {
      first = *entry;
      continue;
    }
    const ExperimentOutcome one = outcome(first), other = outcome(*entry);
    std::vector<std::string> names = bytes(entry->key).differences(one, other);
    if (names.empty())
      names = audit_differences(one, other);
    if (!names.empty())
      throw InputError(
          fmt::format("{}: experiment {}", entry->shard->string(), entry->key),
          fmt::format("{} that differ from those in {}", fmt::join(names, ", "), first.shard->string()),
          "bit-identical values: one build must run all shards on processors of one kind");
  }
}

void CampaignLoops::take_audit(Campaign& campaign, const ShardStore& store) const {
  const ShardStore::Next next = store.in_order(0, experiments_);
  std::int64_t last = -1;
  while (const ShardStore::Entry* const entry = next()) {
    const ExperimentOutcome outcome = this->outcome(*entry);
    campaign.audit.insert(campaign.audit.end(), outcome.audited.begin(), outcome.audited.end());
    if (std::exchange(last, entry->key) != entry->key)
      campaign.info.audit_seconds += outcome.audit_seconds;
  }
  std::stable_sort(campaign.audit.begin(), campaign.audit.end(), earlier);
  const auto same = [](const AuditedStep& one, const AuditedStep& other) { return !earlier(one, other); };
  campaign.audit.erase(std::unique(campaign.audit.begin(), campaign.audit.end(), same), campaign.audit.end());
}

void CampaignLoops::take(Campaign& campaign, const ShardStore& store, const StopRequest& stop,
                         bool in_memory) const {
  require_one_result(store);
  campaign.streamed = experiment_records(store, stop);
  if (in_memory || study_.names_scenarios()) {
    campaign.streamed->each([&](const ExperimentRecord& record) { campaign.records.push_back(record); });
    campaign.streamed.reset();
  }
  if (campaign.info.audit_share > 0.0)
    take_audit(campaign, store);
  if (calibration_ && store.missing(keys({{experiments_, count()}})).empty())
    campaign.calibration = calibration_of(*calibration_, calibration_records(store, stop));
}

}  // namespace mpm
