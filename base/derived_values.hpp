#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <typeindex>
#include <typeinfo>

namespace mpm {

/// To whom the processor time (thread_seconds()) of a derived value is charged: the first caller that asks
/// for the value, or each caller, as if each had computed it.
enum class PaidBy : std::int8_t { first, each };

/// Values that are derived from one object: a record, a benchmark, a world. Each is computed at the first
/// request and kept for later requests. Its type and its key identify it among the values of this object.
///
/// Nothing is kept before keep() is called. A copy keeps nothing either, since it may be changed: its callers
/// compute each value anew. After keep() the owner must not change what the values are derived from. Threads
/// may ask at the same time: one of them computes the value, and the others wait for it.
class DerivedValues {
 public:
  DerivedValues();
  DerivedValues(const DerivedValues& other);
  DerivedValues& operator=(const DerivedValues& other);
  DerivedValues(DerivedValues&&) noexcept;
  DerivedValues& operator=(DerivedValues&&) noexcept;
  ~DerivedValues();

  /// Keeps the values that are computed from now on, and drops those that were kept before.
  void keep(PaidBy paid);

  /// Returns the value of this key. If it is not kept yet, `make` computes it and returns a std::shared_ptr
  /// to it; `make` must not ask for the same value. If `make` throws, the caller gets the exception, and the
  /// next caller tries again.
  template <class Value, class Make>
  std::shared_ptr<Value> of(const std::string& key, const Make& make) const {
    return std::static_pointer_cast<Value>(found(typeid(Value), key, [&make]() -> std::shared_ptr<void> {
      return std::const_pointer_cast<std::remove_const_t<Value>>(std::shared_ptr<Value>(make()));
    }));
  }

 private:
  struct Kept;

  std::shared_ptr<void> found(std::type_index type, const std::string& key,
                              const std::function<std::shared_ptr<void>()>& make) const;

  std::unique_ptr<Kept> kept_;
};

}  // namespace mpm
