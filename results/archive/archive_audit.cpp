#include <numeric>

#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {
namespace {

constexpr const char* kAuditGroup = "audit";
constexpr const char* kDimension = "audited";

}  // namespace

void write_audit(Hdf5Group& root, const std::vector<AuditedStep>& audit) {
  if (audit.empty())
    return;
  Hdf5Group group = root.create_group(kAuditGroup);
  group.write_attribute("title", "Steps whose problems Ipopt solved once more, and how its answers differ");
  std::vector<std::int64_t> numbers(audit.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension(kDimension, numbers, attributes<std::int64_t>({kDimension, "audited step"}));
  std::vector<const AuditedStep*> steps;
  steps.reserve(audit.size());
  for (const AuditedStep& step : audit)
    steps.push_back(&step);
  write_columns(group, {kDimension}, audit_columns(), steps);
}

std::vector<AuditedStep> read_audit(const Hdf5Group& root, const std::string& file) {
  if (!root.has_group(kAuditGroup))
    return {};
  const Hdf5Group group = root.group(kAuditGroup);
  std::vector<AuditedStep> audit(group.read_list<std::int64_t>(kDimension).size());
  std::vector<AuditedStep*> steps;
  steps.reserve(audit.size());
  for (AuditedStep& step : audit)
    steps.push_back(&step);
  read_columns(group, {audit.size()}, audit_columns(), steps, file);
  return audit;
}

}  // namespace mpm
