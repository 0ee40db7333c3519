#include "bench/execution/stop_request.hpp"

#include <fmt/format.h>

namespace mpm {

Interrupted::Interrupted(std::int64_t done, std::int64_t count)
    : std::runtime_error(fmt::format("stopped when {} of {} experiments were done", done, count)) {}

}  // namespace mpm
