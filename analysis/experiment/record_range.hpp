#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"

namespace mpm {

/// The records of experiments in the order of their index, one after the other: either records in memory, or
/// records that are read anew each time, with only one of them in memory.
class RecordRange {
 public:
  using Visit = std::function<void(const ExperimentRecord&)>;
  /// The next record at each call, valid until the next call; null after the last one.
  using Next = std::function<const ExperimentRecord*()>;
  using At = std::function<ExperimentRecord(std::size_t)>;

  /// No records.
  RecordRange() : RecordRange(std::span<const ExperimentRecord>()) {}
  /// These records, which must outlive the range.
  RecordRange(std::span<const ExperimentRecord> records);
  RecordRange(const std::vector<ExperimentRecord>& records)
      : RecordRange(std::span<const ExperimentRecord>(records)) {}
  /// `size` records. Each call of `begin` starts a new pass through them; `at`, if one record can be read
  /// without the others, reads one alone.
  RecordRange(std::size_t size, std::function<Next()> begin, At at = nullptr)
      : size_(size), begin_(std::move(begin)), at_(std::move(at)) {}

  std::size_t size() const { return size_; }
  /// Starts a pass through the records at the pace of the caller, who may stop before the end.
  Next one_by_one() const { return begin_(); }
  void each(const Visit& visit) const;
  /// The record at this place, which is below size().
  ExperimentRecord at(std::size_t place) const;

 private:
  std::size_t size_;
  std::function<Next()> begin_;
  At at_;
};

/// Changes a record; called for one record after the other, in the order of their index.
using RecordChange = std::function<void(ExperimentRecord&)>;

/// These records, each changed when it is read: `begin` makes the change for one pass through them.
RecordRange changed(const RecordRange& records, const std::function<RecordChange()>& begin);

/// Calls visit(one, other) for the experiments that are in both, in the order of their index.
void each_in_both(const RecordRange& one, const RecordRange& other,
                  const std::function<void(const ExperimentRecord&, const ExperimentRecord&)>& visit);

}  // namespace mpm
