#pragma once

#include <cstddef>
#include <functional>

namespace mpm {

// The only loops of the program that run in threads: OpenMP's, with a dynamic schedule. Both throw
// std::runtime_error, and call nothing, when so many threads cannot be made. No thread is left when they
// return.

/// Calls body(thread) at once in `threads` threads, of which this is one; it must not throw.
void in_threads(int threads, const std::function<void(std::size_t thread)>& body);

/// Calls body(index, thread) for each index below `count` in `threads` threads, in any order; `thread`
/// is below `threads`. Throws the exception of the first index whose call throws, as a loop in one thread
/// would, and then makes no more calls behind it.
void for_each_in_threads(std::size_t count, int threads,
                         const std::function<void(std::size_t index, std::size_t thread)>& body);

}  // namespace mpm
