#include "analysis/experiment/record_range.hpp"

#include <cstdint>
#include <memory>

namespace mpm {

RecordRange::RecordRange(std::span<const ExperimentRecord> records)
    : RecordRange(
          records.size(),
          [records]() -> Next {
            const auto place = std::make_shared<std::size_t>(0);
            return [records, place] { return *place == records.size() ? nullptr : &records[(*place)++]; };
          },
          [records](std::size_t place) { return records[place]; }) {}

void RecordRange::each(const Visit& visit) const {
  const Next next = one_by_one();
  while (const ExperimentRecord* const record = next())
    visit(*record);
}

ExperimentRecord RecordRange::at(std::size_t place) const {
  if (at_)
    return at_(place);
  const Next next = one_by_one();
  for (; place > 0; --place)
    next();
  return *next();
}

RecordRange changed(const RecordRange& records, const std::function<RecordChange()>& begin) {
  return {records.size(), [records, begin]() -> RecordRange::Next {
            const auto record = std::make_shared<ExperimentRecord>();
            return [next = records.one_by_one(), change = begin(), record]() -> const ExperimentRecord* {
              const ExperimentRecord* const read = next();
              if (read == nullptr)
                return nullptr;
              *record = *read;
              change(*record);
              return record.get();
            };
          }};
}

void each_in_both(const RecordRange& one, const RecordRange& other,
                  const std::function<void(const ExperimentRecord&, const ExperimentRecord&)>& visit) {
  const RecordRange::Next next_one = one.one_by_one(), next_other = other.one_by_one();
  const ExperimentRecord *a = next_one(), *b = next_other();
  while (a != nullptr && b != nullptr) {
    const std::int64_t first = a->draw.index, second = b->draw.index;
    if (first == second)
      visit(*a, *b);
    if (first <= second)
      a = next_one();
    if (second <= first)
      b = next_other();
  }
}

}  // namespace mpm
