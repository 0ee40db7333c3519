#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "analysis/experiment/record_range.hpp"

namespace mpm {

/// Collects findings from records that come one after the other, so that many findings need one pass.
template <class Result>
struct Collector {
  std::function<void(const ExperimentRecord&)> add;
  std::function<Result()> result;  ///< of all records; call it once, it may move out what was collected

  Result of(const RecordRange& records) const {
    records.each(add);
    return result();
  }
};

/// Returns a collector that is built on `counts`, which has the members add(record) and result().
template <class Counts>
auto collector_of(Counts counts) -> Collector<decltype(counts.result())> {
  const auto shared = std::make_shared<Counts>(std::move(counts));
  return {[shared](const ExperimentRecord& record) { shared->add(record); },
          [shared] { return shared->result(); }};
}

}  // namespace mpm
