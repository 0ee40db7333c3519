#include "bench/campaign/outcome_collection.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/archive/columns.hpp"

namespace mpm {
namespace {

bool earlier(const AuditedStep& one, const AuditedStep& other) {
  return std::tie(one.experiment, one.step) < std::tie(other.experiment, other.step);
}

/// Where two audits of one step stand side by side, one is left.
void require_one_finding(const AuditedStep& one, const AuditedStep& other) {
  for (const Column<AuditedStep>& column : audit_columns())
    std::visit(
        [&](const auto& access) {
          const auto found = access.get(one), again = access.get(other);
          const bool same = found == again || (found != found && again != again);  // NaN: no answer
          if (!same)
            throw InputError(fmt::format("experiment {}: audit of step {}: {}", one.experiment, one.step,
                                         column.text.name),
                             "two results in two shards", "the same, bit for bit");
        },
        column.access);
}

}  // namespace

void AuditCollection::add(const ExperimentOutcome& outcome) {
  add_repeated(outcome);
  seconds_ += outcome.audit_seconds;
}

void AuditCollection::add_repeated(const ExperimentOutcome& outcome) {
  audit_.insert(audit_.end(), outcome.audited.begin(), outcome.audited.end());
}

void AuditCollection::move_into(Campaign& campaign) {
  std::stable_sort(audit_.begin(), audit_.end(), earlier);
  const auto repeated = [](const AuditedStep& one, const AuditedStep& other) {
    if (earlier(one, other))
      return false;
    require_one_finding(one, other);
    return true;
  };
  audit_.erase(std::unique(audit_.begin(), audit_.end(), repeated), audit_.end());
  campaign.audit = std::move(audit_);
  campaign.info.audit_seconds = seconds_;
}

OutcomeCollection::OutcomeCollection(std::int64_t count) : records_(static_cast<std::size_t>(count)) {}

void OutcomeCollection::add(ExperimentOutcome outcome) {
  audit_.add(outcome);
  records_[static_cast<std::size_t>(outcome.record.draw.index)] = std::move(outcome.record);
}

void OutcomeCollection::move_into(Campaign& campaign) {
  audit_.move_into(campaign);
  campaign.records = std::move(records_);
}

}  // namespace mpm
