#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace mpm {

/// Says whether work is to stop; several threads may ask at once. If it is empty, work never stops.
using StopRequest = std::function<bool()>;

inline bool requested(const StopRequest& stop) {
  return stop && stop();
}

/// Work was stopped before its end.
class Interrupted : public std::runtime_error {
 public:
  /// "stopped when `done` of `count` experiments were done: `why`"
  Interrupted(std::int64_t done, std::int64_t count, std::string_view what = "experiments",
              std::string_view why = "")
      : std::runtime_error(fmt::format("stopped when {} of {} {} were done{}{}", done, count, what,
                                       why.empty() ? "" : ": ", why)) {}
};

}  // namespace mpm
