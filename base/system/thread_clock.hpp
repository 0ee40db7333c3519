#pragma once

namespace mpm {

/// Processor time of this thread in seconds. On an idle machine it runs as a steady clock does; on a busy one
/// it does not count the time of others. The work of programs for this thread counts as its own.
double thread_seconds();

/// Adds processor time that others have spent for this thread: a process for which it waited, or whoever made
/// before what this thread uses (DerivedValues).
void count_for_thread(double seconds);

}  // namespace mpm
