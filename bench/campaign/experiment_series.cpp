#include "bench/campaign/experiment_series.hpp"

#include <numeric>
#include <utility>

namespace mpm {
namespace {

std::vector<std::int64_t> all_of(std::int64_t count) {
  std::vector<std::int64_t> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace

ExperimentSeries::ExperimentSeries(const Study& study, RunOptions options, std::int64_t count,
                                   const std::optional<std::filesystem::path>& shards,
                                   const ShardStore::Warn& warn)
    : study_(study), options_(std::move(options)), count_(count) {
  if (shards)
    shards_.emplace(*shards, options_, study_, count_, warn);
  missing_ = shards_ ? shards_->missing() : all_of(count_);
}

ExperimentTally ExperimentSeries::tally() const {
  return {count_ - std::ssize(missing_), count_};
}

OutcomeCollection ExperimentSeries::run(const BasisCase& basis, Execution execute, const CampaignHooks& hooks,
                                        ExperimentTally& tally) {
  std::int64_t left = std::ssize(missing_);
  OutcomeCollection outcomes(count_);
  const auto take = [&](ExperimentOutcome outcome) {
    ++tally.done;
    --left;
    if (hooks.on_done)
      hooks.on_done(outcome.record);
    if (shards_)
      shards_->add(outcome);
    else
      outcomes.add(std::move(outcome));
  };
  if (!missing_.empty())
    execute({study_, basis, options_, missing_, hooks.on_warning}, hooks.stop, take);
  if (shards_)
    shards_->flush();
  if (left > 0)
    throw Interrupted(tally.done, tally.count);
  if (shards_)
    shards_->read([&](ExperimentOutcome outcome) { outcomes.add(std::move(outcome)); });
  return outcomes;
}

}  // namespace mpm
