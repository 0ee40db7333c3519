#include <numeric>

#include "results/archive/archive_groups.hpp"
#include "results/archive/loop_rows.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

constexpr const char* kAuditGroup = "audit";
constexpr const char* kDimension = "audited";

}  // namespace

void write_audit(Hdf5Group& root, const std::vector<AuditedStep>& audit) {
  if (audit.empty())
    return;
  Hdf5Group group = root.create_group(kAuditGroup);
  group.write_attribute("title", "Steps whose problems Ipopt solved once more, and how its solutions differ");
  std::vector<std::int64_t> numbers(audit.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension(kDimension, numbers, attributes<std::int64_t>({kDimension, "audited step"}));
  store_rows(group, {kDimension}, audit_rows(), audit);
}

std::vector<AuditedStep> read_audit(const Hdf5Group& root, const std::string& file) {
  if (!root.has_group(kAuditGroup))
    return {};
  const Hdf5Group group = root.group(kAuditGroup);
  std::vector<AuditedStep> audit(group.read_list<std::int64_t>(kDimension).size());
  load_rows(group, audit_rows(), audit, file);
  return audit;
}

}  // namespace mpm
