#include "bench/campaign/streamed_records.hpp"

#include <cstdint>
#include <memory>
#include <optional>

#include "bench/campaign/outcome_collection.hpp"
#include "bench/shards/shard_index.hpp"

namespace mpm {
namespace {

RecordRange records_in(const std::shared_ptr<const ShardIndex>& index, const StopRequest& stop) {
  return {index->size(), [index, stop]() -> RecordRange::Next {
            const auto outcome = std::make_shared<std::optional<ExperimentOutcome>>();
            return [index, stop, next = index->one_by_one(), outcome]() -> const ExperimentRecord* {
              const auto count = static_cast<std::int64_t>(index->size());
              if (requested(stop))
                throw Interrupted(count, count);
              *outcome = next();
              return *outcome ? &(*outcome)->record : nullptr;
            };
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
