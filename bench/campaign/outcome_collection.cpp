#include "bench/campaign/outcome_collection.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace mpm {
namespace {

bool earlier(const AuditedStep& one, const AuditedStep& other) {
  return std::tie(one.experiment, one.step) < std::tie(other.experiment, other.step);
}

}  // namespace

OutcomeCollection::OutcomeCollection(std::int64_t count) : records_(static_cast<std::size_t>(count)) {}

void OutcomeCollection::add(ExperimentOutcome outcome) {
  audit_.insert(audit_.end(), outcome.audited.begin(), outcome.audited.end());
  audit_seconds_ += outcome.audit_seconds;
  records_[static_cast<std::size_t>(outcome.record.draw.index)] = std::move(outcome.record);
}

void OutcomeCollection::move_into(Campaign& campaign) {
  std::sort(audit_.begin(), audit_.end(), earlier);
  campaign.records = std::move(records_);
  campaign.audit = std::move(audit_);
  campaign.info.audit_seconds = audit_seconds_;
}

}  // namespace mpm
