#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <typeindex>
#include <typeinfo>

namespace mpm {

/// Who pays for a derived value in processor time (thread_seconds()): the first caller that asks for it, or
/// each caller, as if each made it.
enum class PaidBy : std::int8_t { first, each };

/// Values that are derived from one object: a record, a benchmark, a world. Each is computed at the first
/// request and kept for later requests. Its type and its key name it among the values of this thing.
///
/// Nothing is kept before keep(), and nothing in a copy, which may be changed: there each caller makes its
/// own. The owner must not change what the values are derived from after keep(). Threads may ask at once: one
/// of them makes the value, and the others wait for it.
class DerivedValues {
 public:
  DerivedValues();
  DerivedValues(const DerivedValues& other);
  DerivedValues& operator=(const DerivedValues& other);
  DerivedValues(DerivedValues&&) noexcept;
  DerivedValues& operator=(DerivedValues&&) noexcept;
  ~DerivedValues();

  /// Keeps values that are computed from now on, but none that were computed before.
  void keep(PaidBy paid);

  /// The value of this key, to which `make` returns a std::shared_ptr. It must not ask for this value
  /// itself. An exception of `make` goes to whoever asks, and the next one to ask tries again.
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
