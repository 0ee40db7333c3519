#include "base/derived_values.hpp"

#include <map>
#include <mutex>
#include <utility>

#include "base/system/thread_clock.hpp"

namespace mpm {

struct DerivedValues::Kept {
  struct Entry {
    std::mutex making;
    std::shared_ptr<void> value;
    double seconds = 0.0;  ///< processor time that the value took
  };

  PaidBy paid;
  std::mutex listing;
  std::map<std::pair<std::type_index, std::string>, Entry> entries = {};

  Entry& entry(std::type_index type, const std::string& key) {
    const std::lock_guard lock(listing);
    return entries[{type, key}];
  }
};

DerivedValues::DerivedValues() = default;
DerivedValues::DerivedValues(const DerivedValues& /*other*/) {}
DerivedValues::DerivedValues(DerivedValues&&) noexcept = default;
DerivedValues& DerivedValues::operator=(DerivedValues&&) noexcept = default;
DerivedValues::~DerivedValues() = default;

DerivedValues& DerivedValues::operator=(const DerivedValues& other) {
  if (this != &other)
    kept_.reset();
  return *this;
}

void DerivedValues::keep(PaidBy paid) {
  kept_ = std::make_unique<Kept>();
  kept_->paid = paid;
}

std::shared_ptr<void> DerivedValues::found(std::type_index type, const std::string& key,
                                           const std::function<std::shared_ptr<void>()>& make) const {
  if (!kept_)
    return make();
  Kept::Entry& entry = kept_->entry(type, key);
  const std::lock_guard lock(entry.making);
  if (!entry.value) {
    const double start = thread_seconds();
    entry.value = make();
    entry.seconds = thread_seconds() - start;
  } else if (kept_->paid == PaidBy::each) {
    count_for_thread(entry.seconds);
  }
  return entry.value;
}

}  // namespace mpm
