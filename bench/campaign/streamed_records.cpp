#include "bench/campaign/streamed_records.hpp"

#include <cstdint>
#include <memory>

#include "bench/campaign/outcome_collection.hpp"
#include "bench/shards/shard_index.hpp"

namespace mpm {
namespace {

RecordRange records_in(const std::shared_ptr<const ShardIndex>& index, const StopRequest& stop) {
  return {index->size(), [index, stop](const RecordRange::Visit& visit) {
            const auto count = static_cast<std::int64_t>(index->size());
            index->each([&](const ExperimentOutcome& outcome) {
              if (requested(stop))
                throw Interrupted(count, count);
              visit(outcome.record);
            });
          }};
}

}  // namespace

RecordRange records_in(const ShardSet& shards, const StopRequest& stop) {
  return records_in(std::make_shared<const ShardIndex>(shards), stop);
}

void take_records(Campaign& campaign, const ShardSet& shards, const StopRequest& stop) {
  const auto index = std::make_shared<const ShardIndex>(shards);
  const RecordRange records = records_in(index, stop);
  if (campaign.study.names_scenarios())
    records.each([&](const ExperimentRecord& record) { campaign.records.push_back(record); });
  else
    campaign.streamed = records;
  if (campaign.info.audit_share == 0.0)
    return;
  AuditCollection audit;
  index->each([&](const ExperimentOutcome& outcome) { audit.add(outcome); });
  index->each_repeated([&](const ExperimentOutcome& outcome) { audit.add_repeated(outcome); });
  audit.move_into(campaign);
}

}  // namespace mpm
