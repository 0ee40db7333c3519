#include "bench/campaign/experiment_series.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "bench/campaign/streamed_records.hpp"

namespace mpm {
namespace {

/// Those that are in both; all in ascending order.
std::vector<std::int64_t> common(const std::vector<std::int64_t>& one,
                                 const std::vector<std::int64_t>& other) {
  std::vector<std::int64_t> both;
  std::set_intersection(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(both));
  return both;
}

}  // namespace

ExperimentSeries::ExperimentSeries(const Study& study, RunOptions options, const WantedLoops& wanted,
                                   const std::optional<std::filesystem::path>& shards,
                                   const ShardStore::Warn& warn,
                                   const std::vector<std::filesystem::path>& others)
    : study_(study), options_(std::move(options)), count_(std::ssize(wanted.indices)), all_(wanted.count) {
  if (!shards) {
    missing_ = wanted.indices;
    outcomes_.emplace(all_);
    return;
  }
  shards_.emplace(*shards, options_, study_, all_, warn);
  shards_->take_others(others, warn);
  missing_ = common(shards_->missing(), wanted.indices);
  earlier_seconds_ = shards_->seconds();
}

void ExperimentSeries::run(const Study& basis_study, const BasisCase& basis, const Execution& execute,
                           const CampaignHooks& hooks, ExperimentTally& tally) {
  std::int64_t left = std::ssize(missing_);
  const auto take = [&](ExperimentOutcome outcome) {
    ++tally.done;
    --left;
    if (hooks.on_done)
      hooks.on_done(outcome.record);
    if (!shards_)
      return outcomes_->add(std::move(outcome));
    shards_->add(outcome);
    if (requested(hooks.stop))
      shards_->flush();  // what else runs may not end in the time that there is
  };
  if (!missing_.empty())
    execute({study_, basis_study, basis, options_, missing_, hooks.on_warning}, hooks.stop, take);
  if (shards_)
    shards_->flush();
  if (left > 0)
    throw Interrupted(tally.done, tally.count);
}

OutcomeCollection ExperimentSeries::collect() {
  if (!shards_)
    return std::move(*outcomes_);
  OutcomeCollection outcomes(all_);
  shards_->read([&](ExperimentOutcome outcome) { outcomes.add(std::move(outcome)); });
  return outcomes;
}

RecordRange ExperimentSeries::records(const StopRequest& stop) {
  if (shards_)
    return records_in(shards(), stop);
  const auto outcomes = std::make_shared<Campaign>();
  collect().move_into(*outcomes);
  return {outcomes->records.size(), [outcomes]() -> RecordRange::Next {
            return [outcomes, next = RecordRange(outcomes->records).one_by_one()] { return next(); };
          }};
}

void ExperimentSeries::compact() {
  if (shards_)
    shards_->compact();
}

}  // namespace mpm
