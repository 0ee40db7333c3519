#include "bench/execution/stop_request.hpp"

#include <fmt/format.h>

namespace mpm {

Interrupted::Interrupted(std::int64_t done, std::int64_t count, std::string_view what)
    : std::runtime_error(fmt::format("stopped when {} of {} {} were done", done, count, what)) {}

}  // namespace mpm
