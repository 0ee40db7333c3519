#pragma once

namespace mpm {

/// Processor time of this thread in seconds. On an idle machine it runs as a steady clock does; on a busy one
/// it does not count the others' turns.
double thread_seconds();

}  // namespace mpm
