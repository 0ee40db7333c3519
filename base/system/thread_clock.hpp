#pragma once

namespace mpm {

/// Returns the processor time of this thread in seconds. On an idle machine it runs as a steady clock does;
/// on a busy one it does not count the time of others. Work that programs do for this thread counts as its
/// own.
double thread_seconds();

/// Adds processor time that others have spent for this thread: a process for which it waited, or the thread
/// that computed earlier what this thread uses (DerivedValues).
void count_for_thread(double seconds);

}  // namespace mpm
