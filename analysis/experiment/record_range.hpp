#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/experiment/experiment.hpp"

namespace mpm {

/// The records of experiments in the order of their index, to be looked at one after the other: records in
/// memory, or ones that are read anew each time, so that there is one of them at a time.
class RecordRange {
 public:
  using Visit = std::function<void(const ExperimentRecord&)>;
  using At = std::function<ExperimentRecord(std::size_t)>;

  /// No records.
  RecordRange() : RecordRange(std::span<const ExperimentRecord>()) {}
  /// These, which must outlive it.
  RecordRange(std::span<const ExperimentRecord> records)
      : size_(records.size()),
        each_([records](const Visit& visit) {
          for (const ExperimentRecord& record : records)
            visit(record);
        }),
        at_([records](std::size_t place) { return records[place]; }) {}
  RecordRange(const std::vector<ExperimentRecord>& records)
      : RecordRange(std::span<const ExperimentRecord>(records)) {}
  /// `size` of them, which `each` reads and passes on, as often as it is called, and `at`, where it can be
  /// done without the others, reads alone.
  RecordRange(std::size_t size, std::function<void(const Visit&)> each, At at = nullptr)
      : size_(size), each_(std::move(each)), at_(std::move(at)) {}

  std::size_t size() const { return size_; }
  void each(const Visit& visit) const { each_(visit); }
  /// The one at a place below size().
  ExperimentRecord at(std::size_t place) const {
    if (at_)
      return at_(place);
    ExperimentRecord wanted;
    each_([&wanted, place, next = std::size_t{0}](const ExperimentRecord& record) mutable {
      if (next++ == place)
        wanted = record;
    });
    return wanted;
  }

 private:
  std::size_t size_;
  std::function<void(const Visit&)> each_;
  At at_;
};

}  // namespace mpm
